//! Reflectances from 0 to just below 1.

use crate::agreement::{coarse, hold, prepare_text, solve_by};
use crate::mesh::{Facing, Mesh};
use certilux::solve::{SolveConfig, Solved, Stop, Technique};
use glam::DVec3;
use std::f64::consts::PI;

/// Share of the emitted power that may be missing once passes are scaled, but for what rays are said to lose.
const LEDGER: f64 = 1.0e-6;

/// Relative error of the number of passes that a warning names: what is unshot is kept in f32.
const PASSES: f64 = 0.01;

/// Relative error of the mean radiosity.
const MEAN: f64 = 1.0e-3;

/// Relative error of a row of form factors; in radiosity it is worth this over (1 - reflectance).
const ROW: f64 = 0.002;

/// An empty closed box of which every side emits `Ke` 1 and reflects `rho`.
fn furnace(rho: f64, config: &SolveConfig) -> (Solved, String) {
    let mesh = Mesh::default().cuboid("wall", DVec3::NEG_ONE, DVec3::ONE, Facing::Inwards);
    let mtl = format!("newmtl wall\nKd {rho:?} {rho:?} {rho:?}\nKe 1 1 1\n");
    let prepared = prepare_text(&mesh.obj(), "m.mtl", &mtl);
    let what = format!("reflectance {rho}");
    hold(&what, &prepared, config);
    (solve_by(&prepared, Technique::Occlusion, config), what)
}

/// Few enough patches that 200 passes take a second.
fn very_coarse() -> SolveConfig {
    let mut config = coarse();
    config.epsilon = 1.0e-2;
    config
}

#[test]
fn a_black_box_takes_one_pass() {
    let (solved, what) = furnace(0.0, &coarse());
    assert_eq!(solved.passes.len(), 1, "{what}");
    assert_eq!(solved.power.unshot, 0.0);
    assert!(solved.warnings.is_empty() && solved.normalised.is_none());
    for patch in &solved.solution.patches {
        assert_eq!(f64::from(patch.radiosity[0]), f64::from(PI as f32));
    }
}

/// The light of pass k in a closed box is rho^k of what was emitted, so what is missing at the cap is known.
#[test]
fn a_box_that_swallows_next_to_nothing_says_how_many_passes_it_needs() {
    for rho in [0.999, 1.0 - 1.0e-6] {
        let (solved, what) = furnace(rho, &very_coarse());
        let scales = solved.normalised.as_ref().expect("rows are normalised");
        assert_eq!(scales.len(), solved.passes.len());
        assert_eq!(solved.passes.len(), SolveConfig::MAX_PASSES as usize);
        let [warning] = &solved.warnings[..] else {
            panic!("{what}: {:?}", solved.warnings)
        };
        println!("{what}: {warning}");
        // From rho^200 down to a thousandth.
        let needed = (1.0e-3f64.ln() / f64::ln(rho)).ceil() - 200.0;
        let said = warning
            .split_once("about ")
            .and_then(|(_, rest)| rest.split(' ').next());
        let said: f64 = said
            .and_then(|n| n.parse().ok())
            .expect("a number of passes");
        assert!(
            (said / needed - 1.0).abs() < PASSES,
            "{what}: {said} passes, {needed} are needed"
        );
        // Nothing is made up: what has not been shot is missing, and no more.
        let unshot = solved.power.unshot / solved.power.emitted;
        let sum = (1.0 - rho.powi(201)) / (1.0 - rho);
        println!(
            "{what}: unshot {unshot}, imbalance {:e}",
            solved.power.imbalance
        );
        assert!(
            (unshot / rho.powi(200) - 1.0).abs() < 1.0e-4,
            "{what}: {unshot}"
        );
        // One ray in a quarter of a million may slip through an edge, and is then worth all the light that it stands for.
        let escaped = solved.power.escaped / solved.power.emitted;
        assert!(
            (solved.power.imbalance + escaped).abs() <= LEDGER,
            "{what}: {:?}",
            solved.power
        );
        assert!(solved.power.escaped <= 2.0 * solved.power.escaped_stderr);
        // Radiosity of every point: the sum of 201 terms of a geometric series.
        let want = PI * sum;
        let (mut area, mut total, mut squares) = (0.0, 0.0, 0.0);
        for patch in &solved.solution.patches {
            // All polygons of a cube are equal.
            let share = 0.25f64.powi(patch.path.level() as i32);
            let radiosity = f64::from(patch.radiosity[0]) / want;
            area += share;
            total += share * radiosity;
            squares += share * (radiosity - 1.0).powi(2);
        }
        let (mean, rms) = (total / area, (squares / area).sqrt());
        println!(
            "{what}: radiosity {want:.3}, mean {mean:.6} of it, patches off by {rms:.4} (RMS)"
        );
        assert!((mean - 1.0).abs() < MEAN, "{what}: {mean}");
        assert!(rms < ROW / (1.0 - rho), "{what}: {rms}");
    }
}

#[test]
fn passes_that_are_asked_for_need_no_warning() {
    let mut config = very_coarse();
    config.stop = Stop::Passes(3);
    let (solved, what) = furnace(0.999, &config);
    assert!(solved.warnings.is_empty(), "{what}: {:?}", solved.warnings);
    assert_eq!(solved.passes.len(), 3);
}
