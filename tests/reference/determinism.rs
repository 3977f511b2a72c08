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

fn coarse() -> ReferenceConfig {
    with(|_| {})
}

fn with(change: impl FnOnce(&mut ReferenceConfig)) -> ReferenceConfig {
    let mut config = ReferenceConfig::default();
    config.error = 0.1;
    change(&mut config);
    config
}

#[test]
fn threads_do_not_matter_and_seeds_do() {
    let scene = cornell();
    let one = run(&scene, 1, &coarse());
    let three = run(&scene, 3, &coarse());
    assert!(one.rounds > 2, "adaptive rounds are part of what is tested");
    assert_eq!(bits(&one.faces), bits(&three.faces));
    assert_eq!((one.rays, one.rounds), (three.rays, three.rounds));
    let other = run(&scene, 1, &with(|c| c.seed = 2));
    assert_ne!(bits(&one.faces), bits(&other.faces));
}

#[test]
fn a_sample_of_faces_is_a_part_of_the_whole() {
    let scene = cornell();
    let sample = |count| {
        let config = with(|c| c.faces = Some(count));
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
    let all = run(&scene, 2, &coarse()).faces;
    assert_eq!(places(&sample(10_000)), places(&all));
}

#[test]
fn time_ends_it_after_a_round() {
    let scene = cornell();
    let config = with(|c| {
        c.error = 1e-6;
        c.max_seconds = Some(1e-3);
    });
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
    let outcome = measure(&cornell(), &coarse(), &Impatient);
    assert_eq!(outcome.err(), Some(ReferenceError::Interrupted));
}

#[test]
fn settings_out_of_range_are_named() {
    let scene = cornell();
    for (config, flag) in [
        (with(|c| c.error = 0.0), "--error"),
        (with(|c| c.error = -1.0), "--error"),
        (with(|c| c.error = f64::NAN), "--error"),
        (with(|c| c.max_seconds = Some(0.0)), "--max-seconds"),
        (with(|c| c.faces = Some(0)), "--faces"),
    ] {
        let error = measure(&scene, &config, &SilentReference).unwrap_err();
        assert!(error.to_string().starts_with(flag), "{error}");
    }
}
