//! A proof fixes only what the same samples would have returned: with the same seed, every technique gives each face
//! the irradiance that `normal` gives it.

use certilux::embree::DeviceConfig;
use certilux::math::FacetId;
use certilux::occluder::OccluderConfig;
use certilux::scene::generate::{catalogue, generate};
use certilux::scene::{LoadConfig, SidesMode, load_text};
use certilux::solve::{
    PassStatistics, PreparedScene, Silent, SolveConfig, Stop, Stride, Technique, solve,
};

/// Greatest difference of a face's irradiance, over the greater of the face's own and the
/// area-weighted mean of the scene, each in its greatest channel.
const TOLERANCE: f64 = 1.0e-5;

/// `blockers` tests some segments natively, and the two agree on every segment that is surely blocked or
/// surely clear; of those that graze a border (under 1e-5 of all) each is worth one ray of one exchange.
/// So not each face is held to it but the area-weighted root mean square of the differences, over the
/// mean irradiance.
const BLOCKERS_TOLERANCE: f64 = 1.0e-4;

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

/// Area and irradiance of every face and side.
struct Faces {
    areas: Vec<f64>,
    irradiance: Vec<[f64; 3]>,
    pass: PassStatistics,
}

fn first_pass(
    prepared: &PreparedScene,
    asked: (Technique, Stride),
    rays: u32,
    epsilon: f64,
) -> Faces {
    passes(prepared, asked, rays, epsilon, 1)
}

fn passes(
    prepared: &PreparedScene,
    (technique, stride): (Technique, Stride),
    rays: u32,
    epsilon: f64,
    count: u32,
) -> Faces {
    let mut config = SolveConfig::default();
    config.technique = technique;
    config.stride = stride;
    config.rays = rays;
    config.epsilon = epsilon;
    config.stop = Stop::Passes(count);
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

/// How far two solves are apart.
struct Difference {
    /// The greatest of a face, in the sense of [`TOLERANCE`].
    greatest: f64,
    /// Faces that differ by more than that.
    beyond: usize,
    /// In the sense of [`BLOCKERS_TOLERANCE`].
    rms: f64,
}

fn compare(normal: &Faces, other: &Faces) -> Difference {
    let area: f64 = normal.areas.iter().sum();
    let mean = (0..3)
        .map(|c| {
            let sums = normal.irradiance.iter().zip(&normal.areas);
            sums.map(|(e, a)| e[c] * a).sum::<f64>() / area
        })
        .fold(0.0, f64::max);
    assert!(mean > 0.0, "nothing is lit");
    let mut found = Difference {
        greatest: 0.0,
        beyond: 0,
        rms: 0.0,
    };
    let faces = normal.irradiance.iter().zip(&other.irradiance);
    for ((x, y), a) in faces.zip(&normal.areas) {
        let own = x.iter().copied().fold(mean, f64::max);
        let difference = (0..3).map(|c| (x[c] - y[c]).abs()).fold(0.0, f64::max);
        found.greatest = found.greatest.max(difference / own);
        found.beyond += usize::from(difference / own > TOLERANCE);
        found.rms += a / area * (difference / mean).powi(2);
    }
    found.rms = found.rms.sqrt();
    found
}

/// Compares every technique with `normal`; a line for each that differs by too much. Scenes in which nothing can be
/// claimed are compared all the same.
fn differences(name: &str, epsilon: f64) -> Vec<String> {
    let prepared = prepare(name);
    let mut found = Vec::new();
    for rays in RAYS {
        let normal = first_pass(&prepared, NORMAL, rays, epsilon);
        for (technique, stride) in [
            (Technique::Visibility, PAPER),
            (Technique::Occlusion, PAPER),
            (Technique::Occlusion, Stride::Auto),
            (Technique::Blockers, Stride::Auto),
        ] {
            let other = first_pass(&prepared, (technique, stride), rays, epsilon);
            let Difference {
                greatest,
                beyond,
                rms,
            } = compare(&normal, &other);
            let line = format!(
                "{name}, {rays} rays, {} ({stride:?}): {} claims, greatest difference {greatest:.2e}, {beyond} of {} faces beyond {TOLERANCE:e}, rms {rms:.2e}",
                technique.name(),
                other.pass.visible_claims + other.pass.occluded_claims,
                normal.areas.len()
            );
            println!("{line}");
            let equal = match technique {
                Technique::Blockers => rms <= BLOCKERS_TOLERANCE,
                _ => beyond == 0,
            };
            if !equal {
                found.push(line);
            }
        }
    }
    found
}

/// The paper's stride, at which most is claimed.
const PAPER: Stride = Stride::Every(SolveConfig::PAPER_STRIDE);

const NORMAL: (Technique, Stride) = (Technique::Normal, PAPER);

const RAYS: [u32; 4] = [1, 3, 8, 20];

#[test]
fn proofs_change_nothing_in_small_scenes() {
    let found: Vec<String> = ["cornell", "furnace-partitions", "sealed"]
        .iter()
        .flat_map(|name| differences(name, 1.0e-4))
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Things stand on its floors, so that some samples of pairs that are proved visible lie below them.
#[test]
fn proofs_change_nothing_in_a_corridor() {
    let found = differences("corridor", SolveConfig::default().epsilon);
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Where pairs carry much, most of what lies below them is played for, in one technique as in the other; and what a pass
/// leaves is what the next one shoots.
#[test]
fn proofs_change_nothing_in_coarse_solves_of_several_passes() {
    for (name, epsilon, count) in [
        ("offices", 1.0e-2, 2),
        ("e", 1.0e-2, 2),
        ("two-rooms", 1.0e-3, 3),
    ] {
        let prepared = prepare(name);
        let normal = passes(&prepared, NORMAL, 8, epsilon, count);
        for (technique, stride) in [
            (Technique::Visibility, PAPER),
            (Technique::Occlusion, PAPER),
            (Technique::Occlusion, Stride::Auto),
        ] {
            let other = passes(&prepared, (technique, stride), 8, epsilon, count);
            let found = compare(&normal, &other);
            let what = format!("{name}, {} ({stride:?})", technique.name());
            assert_eq!(found.beyond, 0, "{what}: {:.2e}", found.greatest);
        }
    }
}

/// What the comparison above rests on: claims are made, and they save rays.
#[test]
fn claims_save_rays() {
    let prepared = prepare("furnace-partitions");
    let [normal, visibility, occlusion] = [
        NORMAL,
        (Technique::Visibility, PAPER),
        (Technique::Occlusion, PAPER),
    ]
    .map(|asked| first_pass(&prepared, asked, 8, 1.0e-4).pass);
    assert!(visibility.visible_claims > 1_000 && occlusion.occluded_claims > 1_000);
    assert!(visibility.rays < normal.rays && occlusion.rays < visibility.rays);
}

#[test]
#[ignore = "takes many minutes"]
fn proofs_change_nothing_in_any_built_in_scene() {
    let found: Vec<String> = catalogue()
        .iter()
        .flat_map(|entry| differences(entry.name, SolveConfig::default().epsilon))
        .collect();
    assert!(found.is_empty(), "{}", found.join("\n"));
}
