//! The same bits at any number of threads; what a seed and a sample of faces do.

use crate::measured::traced;
use certilux::reference::{
    FaceRadiosity, Reference, ReferenceConfig, ReferenceError, ReferenceObserver, SilentReference,
    TracedScene, measure,
};
use certilux::scene::SidesMode;
use certilux::scene::generate::generate;

fn cornell() -> TracedScene {
    let text = generate("cornell").expect("a built-in scene");
    traced(&text.obj, "cornell.mtl", &text.mtl, SidesMode::Auto)
}

fn run(scene: &TracedScene, threads: usize, config: &ReferenceConfig) -> Reference {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("threads")
        .install(|| measure(scene, config, &SilentReference))
        .expect("measures")
}

fn bits(faces: &[FaceRadiosity]) -> Vec<[u64; 6]> {
    faces
        .iter()
        .map(|f| {
            let [a, b, c] = f.radiosity.map(f64::to_bits);
            let [d, e, g] = f.standard_error.map(f64::to_bits);
            [a, b, c, d, e, g]
        })
        .collect()
}

const COARSE: ReferenceConfig = ReferenceConfig {
    error: 0.1,
    max_seconds: None,
    faces: None,
    seed: 1,
};

#[test]
fn threads_do_not_matter_and_seeds_do() {
    let scene = cornell();
    let one = run(&scene, 1, &COARSE);
    let three = run(&scene, 3, &COARSE);
    assert!(one.rounds > 2, "adaptive rounds are part of what is tested");
    assert_eq!(bits(&one.faces), bits(&three.faces));
    assert_eq!((one.rays, one.rounds), (three.rays, three.rounds));
    let other = run(&scene, 1, &ReferenceConfig { seed: 2, ..COARSE });
    assert_ne!(bits(&one.faces), bits(&other.faces));
}

#[test]
fn a_sample_of_faces_is_a_part_of_the_whole() {
    let scene = cornell();
    let sample = |count| {
        let config = ReferenceConfig {
            faces: Some(count),
            ..COARSE
        };
        run(&scene, 2, &config).faces
    };
    let places = |faces: &[FaceRadiosity]| -> Vec<u32> {
        let mut places: Vec<u32> = faces.iter().map(|f| f.face).collect();
        places.dedup();
        places
    };
    let (five, nine) = (places(&sample(5)), places(&sample(9)));
    assert_eq!((five.len(), nine.len()), (5, 9));
    assert_eq!(five, places(&sample(5)));
    // A greater sample contains the lesser.
    assert!(five.iter().all(|f| nine.contains(f)));
    assert!(five.windows(2).all(|w| w[0] < w[1]));
    assert_ne!(five, [0, 1, 2, 3, 4]);
    let all = run(&scene, 2, &COARSE).faces;
    assert_eq!(places(&sample(10_000)), places(&all));
}

#[test]
fn time_ends_it_after_a_round() {
    let scene = cornell();
    let config = ReferenceConfig {
        error: 1e-6,
        max_seconds: Some(1e-3),
        ..COARSE
    };
    let hurried = run(&scene, 2, &config);
    assert!(!hurried.reached);
    assert_eq!(hurried.rounds, 1);
    let lit = |f: &&FaceRadiosity| f.radiosity[0] > 0.0 && f.standard_error[0] > 0.0;
    assert!(hurried.faces.iter().filter(lit).count() > 20);
}

#[test]
fn an_interruption_leaves_no_result() {
    struct Impatient;
    impl ReferenceObserver for Impatient {
        fn interrupted(&self) -> bool {
            true
        }
    }
    let outcome = measure(&cornell(), &COARSE, &Impatient);
    assert_eq!(outcome.err(), Some(ReferenceError::Interrupted));
}

#[test]
fn settings_out_of_range_are_named() {
    let scene = cornell();
    for (config, flag) in [
        (
            ReferenceConfig {
                error: 0.0,
                ..COARSE
            },
            "--error",
        ),
        (
            ReferenceConfig {
                error: -1.0,
                ..COARSE
            },
            "--error",
        ),
        (
            ReferenceConfig {
                error: f64::NAN,
                ..COARSE
            },
            "--error",
        ),
        (
            ReferenceConfig {
                max_seconds: Some(0.0),
                ..COARSE
            },
            "--max-seconds",
        ),
        (
            ReferenceConfig {
                faces: Some(0),
                ..COARSE
            },
            "--faces",
        ),
    ] {
        let error = measure(&scene, &config, &SilentReference).unwrap_err();
        assert!(error.to_string().starts_with(flag), "{error}");
    }
}
