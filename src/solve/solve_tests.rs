//! Whole solves with known answers on scenes built by hand. The built-in scenes with closed forms are
//! solved in `tests/closed_forms`.

use super::config::{SolveConfig, Stop, Technique};
use super::fixture::{add_box, add_plate, grey, prepare, scene};
use super::observer::{Observer, Silent};
use super::solve::{Solved, solve};
use super::{PatchPath, SolveError};
use crate::math::FacetId;
use crate::scene::Scene;
use glam::Vec3;
use std::f64::consts::PI;

fn run(scene: &Scene, config: &SolveConfig) -> Solved {
    solve(&prepare(scene), config, &Silent).expect("solves")
}

fn furnace(cells: u32, reflectance: f64, with_block: bool) -> Scene {
    let mut s = scene(vec![grey(reflectance, 1.0)]);
    let half = Vec3::splat(0.5);
    add_box(&mut s, -half, half, cells, [0; 6], true);
    if with_block {
        let (lo, hi) = (Vec3::new(-0.2, -0.3, -0.4), Vec3::new(0.1, 0.2, 0.1));
        add_box(&mut s, lo, hi, cells, [0; 6], false);
    }
    s
}

/// Area-weighted relative RMS of radiosity about `want`.
fn rms(scene: &Scene, solved: &Solved, want: f64) -> f64 {
    let (mut sum, mut area) = (0.0, 0.0);
    for (f, facet) in solved.solution.facets.iter().enumerate() {
        for patch in solved.solution.facet_patches(FacetId::new(f)) {
            let part = scene.polygon_area(facet.polygon) * 0.25f64.powi(patch.path.level() as i32);
            sum += part * (f64::from(patch.radiosity[0]) / want - 1.0).powi(2);
            area += part;
        }
    }
    (sum / area).sqrt()
}

#[test]
fn a_furnace_has_the_same_radiosity_everywhere() {
    for (cells, reflectance, block) in [(1, 0.5, false), (3, 0.5, true), (1, 0.8, false)] {
        let s = furnace(cells, reflectance, block);
        let solved = run(&s, &SolveConfig::default());
        let error = rms(&s, &solved, PI / (1.0 - reflectance));
        assert!(error < 0.015, "cells {cells} rho {reflectance}: {error}");
        let imbalance = solved.power.imbalance.abs();
        assert!(
            imbalance < 2.0e-3,
            "cells {cells} rho {reflectance}: {imbalance}"
        );
    }
}

#[test]
fn a_room_that_is_darker_in_its_corners_loses_no_light_from_bounce_to_bounce() {
    let mut s = scene(vec![grey(0.6, 0.0), grey(0.0, 1.0)]);
    let (lo, hi) = (Vec3::new(-0.5, -0.3, -0.5), Vec3::new(0.5, 0.3, 0.5));
    add_box(&mut s, lo, hi, 1, [0, 0, 0, 1, 0, 0], true);
    let after = |passes| {
        let config = SolveConfig {
            stop: Stop::Passes(passes),
            ..SolveConfig::default()
        };
        let solved = run(&s, &config);
        let power = &solved.power;
        (power.imbalance, power.unshot / power.emitted)
    };
    let (direct, shot) = after(1);
    let (reflected, _) = after(2);
    // Of what the second pass shot.
    let lost = (reflected - direct) / shot;
    assert!(lost.abs() < 5.0e-4, "{lost}");
}

#[test]
fn the_passes_that_are_not_made_are_summed() {
    // A few percent of the power are left when the solve stops, and in a furnace every pass is like the one before.
    for reflectance in [0.5, 0.8] {
        let s = furnace(2, reflectance, false);
        let config = SolveConfig {
            stop: Stop::Converged(0.05),
            ..SolveConfig::default()
        };
        let solved = run(&s, &config);
        let left = solved.passes.last().expect("a pass").unshot / solved.power.emitted;
        assert!(left > 0.02, "{left}");
        let error = rms(&s, &solved, PI / (1.0 - reflectance));
        assert!(error < 0.015, "rho {reflectance}: {error}");
        // What arrives later: rho / (1 - rho) of what the last pass leaves to be shot, over rho.
        let want = left / (1.0 - reflectance);
        let extrapolated = solved.power.extrapolated / solved.power.emitted;
        assert!(
            (extrapolated / want - 1.0).abs() < 0.02,
            "{extrapolated} {want}"
        );
        assert_eq!(solved.power.unshot, 0.0);
        assert!(solved.power.imbalance.abs() < 5.0e-3, "{:?}", solved.power);
    }
}

#[test]
fn black_surfaces_get_their_share_of_the_passes_that_are_not_made() {
    let mut s = furnace(2, 0.7, false);
    s.surfaces.push(grey(0.0, 0.0));
    for polygon in s.polygons.iter_mut().take(8) {
        polygon.surface = 1;
    }
    let at = |x| {
        let stop = Stop::Converged(x);
        run(
            &s,
            &SolveConfig {
                stop,
                ..SolveConfig::default()
            },
        )
    };
    let (early, late) = (at(0.1), at(1.0e-5));
    assert!(early.passes.len() + 5 < late.passes.len());
    for (f, facet) in late.solution.facets.iter().enumerate() {
        let mean = |solved: &Solved| {
            (solved.solution.facet_patches(FacetId::new(f)).iter())
                .map(|patch| {
                    f64::from(patch.irradiance[0]) * 0.25f64.powi(patch.path.level() as i32)
                })
                .sum::<f64>()
        };
        let error = (mean(&early) / mean(&late) - 1.0).abs();
        assert!(error < 0.01, "{}: {error}", facet.polygon.index());
    }
}

#[test]
fn a_sheet_does_not_light_its_own_back() {
    // A slanting two-sided sheet in a black room: its bright front's light must not reach its back, though
    // their boxes reach through each other's planes.
    let mut s = scene(vec![grey(0.0, 0.0), grey(0.0, 1.0)]);
    add_box(&mut s, Vec3::splat(-0.5), Vec3::splat(0.5), 1, [0; 6], true);
    let (u, v) = (Vec3::new(0.3, 0.21, 0.1), Vec3::new(-0.1, 0.3, 0.27));
    let corner = Vec3::new(-0.11, -0.23, -0.17);
    add_plate(&mut s, corner, u, v, 2, 1);
    add_plate(&mut s, corner, v, u, 2, 0);
    let solved = run(&s, &SolveConfig::default());
    assert!(solved.power.imbalance.abs() < 1.0e-3, "{:?}", solved.power);
    let mut backs = 0;
    for (f, facet) in solved.solution.facets.iter().enumerate() {
        if facet.polygon.index() >= s.polygons.len() - 8 {
            backs += 1;
            for patch in solved.solution.facet_patches(FacetId::new(f)) {
                assert_eq!(patch.irradiance, [0.0; 3]);
            }
        }
    }
    assert_eq!(backs, 8);
}

#[test]
fn the_result_has_the_same_bits_at_any_number_of_threads() {
    let mut s = furnace(2, 0.5, true);
    s.surfaces.push(crate::scene::Surface {
        material: "red".to_owned(),
        reflectance: [0.8, 0.3, 0.1],
        emission: [0.0; 3],
    });
    for polygon in s.polygons.iter_mut().skip(5).step_by(3) {
        polygon.surface = 1;
    }
    let prepared = prepare(&s);
    let config = SolveConfig {
        stop: Stop::Converged(0.02),
        epsilon: 1.0e-4,
        ..SolveConfig::default()
    };
    let at = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        pool.expect("threads start")
            .install(|| solve(&prepared, &config, &Silent).expect("solves"))
    };
    let one = at(1);
    assert!(one.passes[2].rays_blocked > 0, "something must be sampled");
    for threads in [2, 3] {
        let other = at(threads);
        assert_eq!(one.solution.patches, other.solution.patches);
        assert_eq!(one.power, other.power);
        for (a, b) in one.passes.iter().zip(&other.passes) {
            let seconds = b.seconds;
            assert_eq!(super::PassStatistics { seconds, ..*a }, *b);
        }
    }
}

#[test]
fn unoccluded_light_goes_through_walls() {
    let s = furnace(1, 0.0, true);
    let with = |technique| {
        let config = SolveConfig {
            technique,
            stop: Stop::Passes(1),
            ..SolveConfig::default()
        };
        run(&s, &config)
    };
    let (normal, unoccluded) = (with(Technique::Normal), with(Technique::Unoccluded));
    assert_eq!(unoccluded.passes[0].rays, 0);
    // Walls behind the block count twice.
    assert!(unoccluded.power.imbalance < -0.05, "{:?}", unoccluded.power);
    assert!(normal.power.imbalance.abs() < 1.0e-3);
}

#[test]
fn an_interrupted_solve_says_so() {
    struct Stopper;
    impl Observer for Stopper {
        fn interrupted(&self) -> bool {
            true
        }
    }
    let s = furnace(2, 0.5, true);
    let prepared = prepare(&s);
    let outcome = solve(&prepared, &SolveConfig::default(), &Stopper);
    assert_eq!(
        outcome.err(),
        Some(SolveError::Interrupted {
            pass: 1,
            completed: 0
        })
    );
}

#[test]
fn settings_out_of_range_are_refused_by_their_flag() {
    let refused = |config: SolveConfig| config.validate().expect_err("refused").flag;
    let good = SolveConfig::default();
    for epsilon in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(
            refused(SolveConfig {
                epsilon,
                ..good.clone()
            }),
            "--epsilon"
        );
    }
    assert_eq!(
        refused(SolveConfig {
            rays: 0,
            ..good.clone()
        }),
        "--rays"
    );
    let stop = Stop::Passes(0);
    assert_eq!(
        refused(SolveConfig {
            stop,
            ..good.clone()
        }),
        "--passes"
    );
    let stop = Stop::Converged(f64::NAN);
    assert_eq!(
        refused(SolveConfig {
            stop,
            ..good.clone()
        }),
        "--converge"
    );
    let min_area = -1.0;
    assert_eq!(
        refused(SolveConfig {
            min_area,
            ..good.clone()
        }),
        "--min-area"
    );
    assert!(good.validate().is_ok());
}

#[test]
fn patch_paths_name_their_steps() {
    let path = PatchPath::ROOT.child(3).child(0).child(2);
    assert_eq!(path.level(), 3);
    assert_eq!(path.steps().collect::<Vec<_>>(), [3, 0, 2]);
}

#[test]
fn an_empty_room_needs_no_ray() {
    let scene = furnace(4, 0.5, false);
    let solve = |technique| {
        let config = SolveConfig {
            technique,
            stop: Stop::Passes(2),
            ..SolveConfig::default()
        };
        run(&scene, &config)
    };
    let (normal, visibility) = (solve(Technique::Normal), solve(Technique::Visibility));
    for (rays, proofs) in normal.passes.iter().zip(&visibility.passes) {
        assert!(rays.rays > 1_000);
        assert_eq!(
            (proofs.rays, proofs.shafts),
            (0, 0),
            "the room is one box of air"
        );
        assert_eq!(proofs.exchanges_visible, proofs.exchanges);
    }
}
