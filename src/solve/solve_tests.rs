//! Whole solves with known answers on scenes built by hand.

use super::config::{SolveConfig, Stop, Technique};
use super::fixture::{add_box, add_plate, grey, prepare, scene};
use super::observer::Silent;
use super::solve::{Solved, solve};
use crate::scene::Scene;
use glam::Vec3;
use std::f64::consts::PI;

fn run(scene: &Scene, config: &SolveConfig) -> Solved {
    let (hierarchy, embree) = prepare(scene);
    solve(scene, &hierarchy, &embree, config, &Silent).expect("solves")
}

fn furnace(cells: u32, reflectance: f64, with_block: bool) -> Scene {
    let mut s = scene(vec![grey(reflectance, 1.0)]);
    add_box(
        &mut s,
        Vec3::splat(-0.5),
        Vec3::splat(0.5),
        cells,
        [0; 6],
        true,
    );
    if with_block {
        add_box(
            &mut s,
            Vec3::new(-0.2, -0.3, -0.4),
            Vec3::new(0.1, 0.2, 0.1),
            cells,
            [0; 6],
            false,
        );
    }
    s
}

#[test]
fn furnace_has_the_same_radiosity_everywhere() {
    for (epsilon, gradient) in [
        (1e-5, 1e9),
        (1e-6, 1e9),
        (1e-6, 5e-3),
        (1e-6, 1e-3),
        (1e-6, 1e-4),
    ] {
        for (cells, reflectance, block) in [(1, 0.5, false)] {
            let s = furnace(cells, reflectance, block);
            let start = std::time::Instant::now();
            let solved = run(
                &s,
                &SolveConfig {
                    stop: Stop::Converged(1e-5),
                    epsilon,
                    gradient,
                    ..SolveConfig::default()
                },
            );
            let want = PI / (1.0 - reflectance);
            let worst = solved
                .solution
                .patches
                .iter()
                .map(|p| (f64::from(p.radiosity[0]) / want - 1.0).abs())
                .fold(0.0, f64::max);
            let mean = solved.power.imbalance;
            let (mut rms, mut area) = (0.0, 0.0);
            for f in 0..solved.solution.facets.len() {
                for p in solved.solution.facet_patches(crate::math::FacetId::new(f)) {
                    let a = s.polygon_area(solved.solution.facets[f].polygon)
                        * 0.25f64.powi(p.path.level() as i32);
                    rms += a * (f64::from(p.radiosity[0]) / want - 1.0).powi(2);
                    area += a;
                }
            }
            let rms = (rms / area).sqrt();
            eprintln!(
                "eps {epsilon} grad {gradient} cells {cells} rho {reflectance} block {block}: worst {worst:.5} rms {rms:.5} imbalance {mean:.5} leaves {} passes {} exchanges {} rays {} {:.2}s",
                solved.leaves,
                solved.passes.len(),
                solved.passes[0].exchanges,
                solved.passes[0].rays,
                start.elapsed().as_secs_f64()
            );
        }
    }
}
