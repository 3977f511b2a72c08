//! A proof fixes only what the same samples would have returned: with the same seed, pass 1 of every
//! technique gives each face the irradiance that `normal` gives it.

use certilux::embree::DeviceConfig;
use certilux::math::FacetId;
use certilux::occluder::OccluderConfig;
use certilux::scene::generate::{catalogue, generate};
use certilux::scene::{LoadConfig, SidesMode, load_text};
use certilux::solve::{PassStatistics, PreparedScene, Silent, SolveConfig, Stop, Technique, solve};

/// Greatest difference of a face's irradiance, over the greater of the face's own and the
/// area-weighted mean of the scene, each in its greatest channel.
const TOLERANCE: f64 = 1.0e-5;

fn prepare(name: &str) -> PreparedScene {
    let text = generate(name).expect("a built-in scene");
    let library = format!("{name}.mtl");
    let scene = load_text(
        name,
        text.obj.as_bytes(),
        &[(&library, text.mtl.as_bytes())],
        &LoadConfig::default(),
    )
    .expect("the scene loads");
    PreparedScene::new(scene, SidesMode::Auto, 1, &DeviceConfig::default())
        .expect("Embree opens")
        .with_guarantees(Technique::Blockers, &OccluderConfig::default())
}

/// Area and irradiance of every face and side after pass 1.
struct Faces {
    areas: Vec<f64>,
    irradiance: Vec<[f64; 3]>,
    pass: PassStatistics,
}

fn first_pass(prepared: &PreparedScene, technique: Technique, rays: u32) -> Faces {
    let config = SolveConfig {
        technique,
        rays,
        stop: Stop::Passes(1),
        ..SolveConfig::default()
    };
    let solved = solve(prepared, &config, &Silent).expect("solves");
    let solution = &solved.solution;
    let mut faces = Faces {
        areas: Vec::new(),
        irradiance: Vec::new(),
        pass: solved.passes[0],
    };
    for (f, facet) in solution.facets.iter().enumerate() {
        let mut mean = [0.0; 3];
        for patch in solution.facet_patches(FacetId::new(f)) {
            let share = 0.25f64.powi(patch.path.level() as i32);
            for (sum, &e) in mean.iter_mut().zip(&patch.irradiance) {
                *sum += share * f64::from(e);
            }
        }
        faces.areas.push(prepared.scene.polygon_area(facet.polygon));
        faces.irradiance.push(mean);
    }
    faces
}

/// The greatest difference in the sense of [`TOLERANCE`], and how many faces differ by more.
fn compare(normal: &Faces, other: &Faces) -> (f64, usize) {
    let area: f64 = normal.areas.iter().sum();
    let mean = (0..3)
        .map(|c| {
            let sums = normal.irradiance.iter().zip(&normal.areas);
            sums.map(|(e, a)| e[c] * a).sum::<f64>() / area
        })
        .fold(0.0, f64::max);
    assert!(mean > 0.0, "nothing is lit");
    let (mut greatest, mut beyond) = (0.0f64, 0);
    for (x, y) in normal.irradiance.iter().zip(&other.irradiance) {
        let own = x.iter().copied().fold(mean, f64::max);
        let difference = (0..3).map(|c| (x[c] - y[c]).abs()).fold(0.0, f64::max) / own;
        greatest = greatest.max(difference);
        beyond += usize::from(difference > TOLERANCE);
    }
    (greatest, beyond)
}

/// Compares every technique with `normal`; a line for each that differs.
fn differences(name: &str, rays: &[u32]) -> Vec<String> {
    let prepared = prepare(name);
    let mut found = Vec::new();
    for &rays in rays {
        let normal = first_pass(&prepared, Technique::Normal, rays);
        for technique in [
            Technique::Visibility,
            Technique::Occlusion,
            Technique::Blockers,
        ] {
            let other = first_pass(&prepared, technique, rays);
            assert!(
                other.pass.visible_claims + other.pass.occluded_claims > 0,
                "{name}: {technique:?} claims nothing"
            );
            assert!(other.pass.rays < normal.pass.rays, "{name}: {technique:?}");
            let (greatest, beyond) = compare(&normal, &other);
            println!(
                "{name} rays {rays} {}: greatest difference {greatest:.2e}, {beyond} of {} faces beyond {TOLERANCE:e}",
                technique.name(),
                normal.areas.len()
            );
            if beyond > 0 {
                found.push(format!(
                    "{name} rays {rays} {}: {beyond} faces differ, by up to {greatest:e}",
                    technique.name()
                ));
            }
        }
    }
    found
}

const RAYS: [u32; 4] = [1, 3, 8, 20];

#[test]
fn proofs_change_nothing_in_small_scenes() {
    let found: Vec<String> = ["cornell", "furnace-partitions", "corridor", "sealed"]
        .iter()
        .flat_map(|name| differences(name, &RAYS))
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
#[ignore = "takes many minutes"]
fn proofs_change_nothing_in_any_built_in_scene() {
    let only = std::env::var("CERTILUX_SCENES").ok();
    let found: Vec<String> = catalogue()
        .iter()
        .filter(|e| {
            only.as_ref()
                .is_none_or(|o| o.split(',').any(|n| n == e.name))
        })
        .flat_map(|entry| differences(entry.name, &RAYS))
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}
