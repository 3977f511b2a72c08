//! What an exchange costs without its visibility, and what a second thread brings.
//!
//! Prints JSON lines: raw seconds of interleaved repeats, then medians and ratios of medians.
//!
//!     cargo bench --bench solver [-- SCENE...]

use certilux::embree::DeviceConfig;
use certilux::scene::generate::generate;
use certilux::scene::{LoadConfig, SidesMode, load_text};
use certilux::solve::{PreparedScene, Silent, SolveConfig, Stop, Technique, solve};
use std::error::Error;

/// Odd, so that a median is one of the measurements.
const REPEATS: usize = 7;

fn main() -> Result<(), Box<dyn Error>> {
    let mut names: Vec<String> = std::env::args()
        .skip(1)
        .filter(|a| !a.starts_with('-'))
        .collect();
    if names.is_empty() {
        names = ["two-rooms", "d", "f"].map(str::to_owned).to_vec();
    }
    for name in names {
        let text = generate(&name)?;
        let library = format!("{}.mtl", text.name);
        let files = [(library.as_str(), text.mtl.as_bytes())];
        let scene = load_text(&name, text.obj.as_bytes(), &files, &LoadConfig::default())?;
        let prepared = PreparedScene::new(scene, SidesMode::Auto, 1, &DeviceConfig::default())?;
        measure(&name, &prepared)?;
    }
    Ok(())
}

/// One pass on one or two threads: seconds and exchanges.
fn pass(
    prepared: &PreparedScene,
    technique: Technique,
    threads: usize,
    passes: u32,
) -> Result<(f64, u64), Box<dyn Error>> {
    let mut config = SolveConfig::default();
    config.technique = technique;
    config.stop = Stop::Passes(passes);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()?;
    let solved = pool.install(|| solve(prepared, &config, &Silent))?;
    let sum =
        |f: fn(&certilux::solve::PassStatistics) -> f64| solved.passes.iter().map(f).sum::<f64>();
    Ok((sum(|p| p.seconds), sum(|p| p.exchanges as f64) as u64))
}

fn measure(name: &str, prepared: &PreparedScene) -> Result<(), Box<dyn Error>> {
    // (label, technique, threads, passes)
    let cases = [
        ("unoccluded, 1 thread, pass 1", Technique::Unoccluded, 1, 1),
        ("normal, 1 thread, pass 1", Technique::Normal, 1, 1),
        ("normal, 1 thread, 3 passes", Technique::Normal, 1, 3),
        ("normal, 2 threads, 3 passes", Technique::Normal, 2, 3),
    ];
    let mut seconds = vec![Vec::new(); cases.len()];
    let mut exchanges = vec![0; cases.len()];
    for repeat in 0..REPEATS {
        for (i, &(label, technique, threads, passes)) in cases.iter().enumerate() {
            let (s, e) = pass(prepared, technique, threads, passes)?;
            println!(
                r#"{{"scene":"{name}","case":"{label}","repeat":{repeat},"seconds":{s:.6},"exchanges":{e}}}"#
            );
            seconds[i].push(s);
            exchanges[i] = e;
        }
    }
    let median = |i: usize| {
        let mut sorted = seconds[i].clone();
        sorted.sort_by(f64::total_cmp);
        sorted[REPEATS / 2]
    };
    println!(
        r#"{{"scene":"{name}","microseconds_an_exchange_unoccluded":{:.4},"microseconds_an_exchange_normal":{:.4},"two_threads_speedup":{:.3}}}"#,
        1.0e6 * median(0) / exchanges[0] as f64,
        1.0e6 * median(1) / exchanges[1] as f64,
        median(2) / median(3)
    );
    Ok(())
}
