//! The same scene in another unit, at another place, turned: the same light.

use crate::agreement::{coarse, hold, prepare_along, solve_by};
use certilux::embree::DeviceConfig;
use certilux::reference::{
    ReferenceConfig, SilentReference, SolvedLight, SolvedLights, TracedScene, TrueFace, measure,
    solution_error, solution_lights,
};
use certilux::scene::generate::generate;
use certilux::scene::{Axes, SidesMode};
use certilux::solve::{PreparedScene, SolveConfig, Stop, Technique};
use glam::{DQuat, DVec3};
use std::f64::consts::PI;
use std::fmt::Write;

/// Share by which the reflected power of the whole scene may change, where the solution's bias is small.
const POWER: f64 = 1.0e-3;

/// What the differences of faces may be of the solution's own error, both as relative RMS errors, and what the change of
/// power may be of its bias: another tree above the surfaces has another.
const SHARE_OF_ERROR: f64 = 0.5;

/// A built-in scene whose vertices are mapped, every digit written, with boxes along the given axes.
fn prepared(name: &str, axes: Axes, map: impl Fn(DVec3) -> DVec3) -> PreparedScene {
    let text = generate(name).expect("a built-in scene");
    let mut obj = String::new();
    for line in text.obj.lines() {
        match line.strip_prefix("v ") {
            Some(rest) => {
                let c: Vec<f64> = (rest.split_whitespace().map(|w| w.parse().unwrap())).collect();
                let p = map(DVec3::new(c[0], c[1], c[2]));
                writeln!(obj, "v {:?} {:?} {:?}", p.x, p.y, p.z).unwrap();
            }
            None => writeln!(obj, "{line}").unwrap(),
        }
    }
    prepare_along(axes, &obj, &format!("{name}.mtl"), &text.mtl)
}

#[test]
fn a_power_of_two_changes_no_bit() {
    let mut config = coarse();
    config.stop = Stop::Passes(2);
    let as_is = prepared("cornell-spheres", Axes::Scene, |p| p);
    for exponent in [-40, 21] {
        let scaled = prepared("cornell-spheres", Axes::Scene, |p| p * 2f64.powi(exponent));
        for technique in [Technique::Normal, Technique::Blockers] {
            let [a, b] = [&as_is, &scaled].map(|p| solve_by(p, technique, &config));
            assert_eq!(a.solution.facets, b.solution.facets);
            assert!(
                a.solution.patches == b.solution.patches,
                "2^{exponent}, {}",
                technique.name()
            );
            for (a, b) in a.passes.iter().zip(&b.passes) {
                // Watts grow with the area.
                let mut b = *b;
                b.unshot /= 4f64.powi(exponent);
                b.seconds = a.seconds;
                assert_eq!(*a, b, "2^{exponent}, {}", technique.name());
                assert!(a.exchanges > 1_000);
            }
        }
    }
}

type Map = Box<dyn Fn(DVec3) -> DVec3>;

/// The similarities that are tried, for a scene of the given diagonal.
fn similarities(diagonal: f64) -> Vec<(String, Map)> {
    let mut all: Vec<(String, Map)> = Vec::new();
    for factor in [1.0e-4, 3.0, 1.0e6] {
        let name = format!("scaled by {factor:e}");
        all.push((name, Box::new(move |p| p * factor)));
    }
    for far in [1.0, 1.0e3, 1.0e6] {
        let name = format!("moved by {far:e} diagonals");
        let step = DVec3::new(0.6, -0.64, 0.48) * diagonal * far;
        all.push((name, Box::new(move |p| p + step)));
    }
    let oblique = DVec3::new(0.48, 0.6, 0.64);
    for (axis, degrees) in [
        (DVec3::Y, 90.0f64),
        (oblique, 0.001),
        (oblique, 30.0),
        (oblique, 137.0),
    ] {
        let name = format!("turned by {degrees} degrees about {axis}");
        let turn = DQuat::from_axis_angle(axis, degrees.to_radians());
        all.push((name, Box::new(move |p| turn * p)));
    }
    all
}

/// What the faces of a scene reflect, measured.
fn truth(prepared: &PreparedScene, error: f64) -> Vec<TrueFace> {
    let traced = TracedScene::new(
        prepared.scene.clone(),
        SidesMode::Auto,
        1,
        &DeviceConfig::default(),
    )
    .expect("Embree opens");
    let mut config = ReferenceConfig::default();
    config.error = error;
    let reference = measure(&traced, &config, &SilentReference).expect("measures");
    assert!(reference.reached);
    let mean = |light: [f64; 3]| light.iter().sum::<f64>() / 3.0;
    (reference.faces.iter())
        .filter(|f| f.reflectance.iter().any(|&r| r > 0.0))
        .map(|f| {
            let emitted = PI * mean(f.emission);
            TrueFace {
                face: f.face,
                side: f.side,
                area: f.area,
                reflected: mean(f.radiosity) - emitted,
                standard_error: mean(f.standard_error),
                emitted,
            }
        })
        .collect()
}

/// The light of a solution, in the areas of `truth`: units of length do not count.
fn lights(prepared: &PreparedScene, config: &SolveConfig, truth: &[TrueFace]) -> SolvedLights {
    let solved = solve_by(prepared, config.technique, config);
    let found = solution_lights(&prepared.scene, &solved.solution);
    (truth.iter())
        .filter_map(|face| {
            let light = found.get(&(face.face, face.side))?;
            let here = SolvedLight {
                area: face.area,
                power: light.power / light.area * face.area,
            };
            Some(((face.face, face.side), here))
        })
        .collect()
}

/// Solves a scene and its images under all similarities, and compares.
fn compare(
    name: &str,
    config: &SolveConfig,
    reference_error: f64,
    wanted: impl Fn(&str) -> bool,
) -> Vec<String> {
    let as_is = prepared(name, Axes::Scene, |p| p);
    let truth = truth(&as_is, reference_error);
    let here = lights(&as_is, config, &truth);
    let own = solution_error(&truth, &here).expect("something reflects");
    println!(
        "{name}: relative RMS error {:.3} % (noise {:.3} %), bias {:+.3} %",
        100.0 * own.relative_rms,
        100.0 * own.noise,
        100.0 * own.bias
    );
    assert!(own.noise < 0.7 * own.relative_rms);
    // Without the noise of the reference.
    let error = (own.relative_rms.powi(2) - own.noise.powi(2)).sqrt();
    let first: Vec<TrueFace> = (truth.iter())
        .map(|face| TrueFace {
            reflected: here[&(face.face, face.side)].power / face.area - face.emitted,
            standard_error: 0.0,
            ..*face
        })
        .collect();
    let bounds = as_is.scene.bounds();
    let diagonal = f64::from(bounds.diagonal()) / as_is.scene.normalisation.scale;
    let mut found = Vec::new();
    for (how, map) in similarities(diagonal) {
        if !wanted(&how) {
            continue;
        }
        let there = prepared(name, Axes::Scene, map);
        let apart = solution_error(&first, &lights(&there, config, &truth)).expect("reflects");
        assert!(apart.missing.is_empty());
        let line = format!(
            "{name} {how}: faces differ by {:.4} % ({:.2} of the error), power by {:+.4} %",
            100.0 * apart.relative_rms,
            apart.relative_rms / error,
            100.0 * apart.bias
        );
        println!("{line}");
        let power = POWER.max(SHARE_OF_ERROR * own.bias.abs());
        if apart.relative_rms > SHARE_OF_ERROR * error || apart.bias.abs() > power {
            found.push(line);
        }
    }
    found
}

fn at_epsilon(epsilon: f64) -> SolveConfig {
    let mut config = SolveConfig::default();
    config.epsilon = epsilon;
    config
}

#[test]
fn unit_place_and_direction_do_not_matter() {
    let found = compare("cornell", &at_epsilon(1.0e-4), 0.005, |how| {
        ["3e0", "1e6 diagonals", "0.001", "137"]
            .iter()
            .any(|w| how.contains(w))
    });
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
#[ignore = "takes minutes: furnished rooms, and their reference"]
fn unit_place_and_direction_do_not_matter_in_furnished_rooms() {
    let found: Vec<String> = ["cornell", "cornell-spheres", "d", "two-rooms"]
        .iter()
        .flat_map(|name| compare(name, &SolveConfig::default(), 0.004, |_| true))
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn techniques_agree_wherever_the_scene_is() {
    let tried = ["scaled by 3e0", "turned by 137"];
    let claims: u64 = (similarities(10.0).into_iter())
        .filter(|(how, _)| tried.iter().any(|name| how.starts_with(name)))
        .map(|(how, map)| {
            // Along the file's axes, so that what is turned stays askew.
            let prepared = prepared("furnace-partitions", Axes::File, map);
            let claims = hold(&how, &prepared, &coarse());
            claims.occluded.min(claims.visible)
        })
        .min()
        .unwrap();
    assert!(claims > 100, "{claims}");
}
