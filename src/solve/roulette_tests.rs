//! Weak pairs that are played for: the mean is right, the work follows the power.

use super::config::{SolveConfig, Stop, Technique};
use super::fixture::{add_box, add_plate, grey, prepare, scene};
use super::observer::Silent;
use super::prepared::PreparedScene;
use super::solve::{Solved, solve};
use crate::math::FacetId;
use glam::Vec3;

const LAMP: u32 = 1;

/// Boxes on a square, `along` a side, of `size` times their distance, each below a lamp of its own or all below one.
fn boxes(along: u32, size: f32, lamp_each: bool) -> PreparedScene {
    let mut s = scene(vec![grey(0.5, 0.0), grey(0.0, 1.0)]);
    let cell = 0.9 / along as f32;
    for i in 0..along {
        for j in 0..along {
            let at = Vec3::new(i as f32 * cell - 0.45, -0.45, j as f32 * cell - 0.45);
            add_box(&mut s, at, at + Vec3::splat(size * cell), 1, [0; 6], false);
            if lamp_each {
                let corner = at + Vec3::new(0.5, 1.0, 0.5) * cell;
                let (u, v) = (Vec3::X * (0.2 * cell), Vec3::Z * (0.2 * cell));
                add_plate(&mut s, corner, u, v, 1, LAMP);
            }
        }
    }
    if !lamp_each {
        let corner = Vec3::new(-0.1, 0.4, -0.1);
        add_plate(&mut s, corner, Vec3::X * 0.2, Vec3::Z * 0.2, 1, LAMP);
    }
    prepare(&s)
}

fn direct_light(prepared: &PreparedScene, epsilon: f64, seed: u64, technique: Technique) -> Solved {
    let config = SolveConfig {
        technique,
        epsilon,
        // So much may fall on a receiver at once that only the power decides.
        gradient: 100.0,
        seed,
        stop: Stop::Passes(1),
        ..SolveConfig::default()
    };
    solve(prepared, &config, &Silent).expect("solves")
}

/// Power that all sides receive.
fn received(prepared: &PreparedScene, solved: &Solved) -> f64 {
    let mut sum = 0.0;
    for (f, facet) in solved.solution.facets.iter().enumerate() {
        for patch in solved.solution.facet_patches(FacetId::new(f)) {
            let whole = prepared.scene.polygon_area(facet.polygon);
            let area = whole * 0.25f64.powi(patch.path.level() as i32);
            sum += area * f64::from(patch.irradiance[0]);
        }
    }
    sum
}

#[test]
fn the_mean_over_many_seeds_is_the_light_of_a_fine_solve() {
    const SEEDS: u64 = 24;
    let prepared = boxes(20, 0.2, false);
    let fine = direct_light(&prepared, 1.0e-8, 1, Technique::Normal);
    let want = received(&prepared, &fine);
    let (mut sum, mut squares, mut exchanges) = (0.0, 0.0, 0);
    for seed in 0..SEEDS {
        let coarse = direct_light(&prepared, 1.0e-2, seed, Technique::Normal);
        let ratio = received(&prepared, &coarse) / want;
        sum += ratio;
        squares += ratio * ratio;
        exchanges += coarse.passes[0].exchanges;
    }
    let n = SEEDS as f64;
    let mean = sum / n;
    let standard_error = ((squares / n - mean * mean) / (n - 1.0)).sqrt();
    let each = exchanges as f64 / n;
    println!("{mean} +- {standard_error} of {want}, {each} exchanges each");
    // The form factors of the coarse solve are good to a per cent.
    assert!((mean - 1.0).abs() < 4.0 * standard_error + 0.01, "{mean}");
    assert!(standard_error > 0.0 && standard_error < 0.05);
    // The lamp sees the tops of four hundred boxes, and a side or two of nearly all.
    assert!(each < 600.0, "{each}");
}

#[test]
fn every_technique_draws_the_same_lots() {
    let prepared = boxes(8, 0.4, true);
    let light = |technique| direct_light(&prepared, 1.0e-4, 7, technique);
    let normal = light(Technique::Normal);
    let played = direct_light(&prepared, 1.0e-4, 8, Technique::Normal);
    assert!(
        normal.passes[0].exchanges != played.passes[0].exchanges,
        "nothing is played for"
    );
    for technique in [
        Technique::Visibility,
        Technique::Occlusion,
        Technique::Blockers,
    ] {
        assert_eq!(
            normal.solution.patches,
            light(technique).solution.patches,
            "{technique:?}"
        );
    }
}

/// Four times the lamps and boxes, and a quarter of the threshold: each box meets the same light near it, and what is
/// far off, which is all that there is more of, is weak.
#[test]
fn exchanges_grow_with_the_scene_and_not_with_its_square() {
    let [small, large] = [8u32, 16].map(|along| {
        let prepared = boxes(along, 0.4, true);
        let cells = f64::from(along * along);
        let pass = direct_light(&prepared, 0.02 / cells, 1, Technique::Normal).passes[0];
        pass.exchanges as f64 / cells
    });
    println!("{small} and {large} exchanges a box");
    assert!(small > 10.0 && large < 2.0 * small, "{small} {large}");
}
