//! Light falls on the parts of a receiver that it reaches, though the whole receives it in one exchange.

use super::config::{SolveConfig, Stop, Technique};
use super::fixture::{add_plate, grey, prepare, scene};
use super::observer::Silent;
use super::solution::split_triangle;
use super::solve::solve;
use crate::math::FacetId;
use crate::scene::Side;
use glam::{DVec3, Vec3};

/// Height of the lamp over the floor, a little over two radii of the floor.
const HEIGHT: f32 = 0.3;

/// Irradiance of the eight triangles of a floor from -0.1 to 0.1, with their corners, from a lamp over its left half,
/// all in one exchange a pair of clusters; `wall` stands in the plane x = 0.
fn floor_irradiance(wall: bool) -> Vec<([Vec3; 3], f64)> {
    let mut s = scene(vec![grey(0.0, 0.0), grey(0.0, 1.0)]);
    let (x, y) = (Vec3::X * 0.2, Vec3::Y * 0.2);
    add_plate(&mut s, Vec3::new(-0.1, -0.1, 0.0), x, y, 2, 0);
    // Its front looks down.
    let corner = Vec3::new(-0.1, -0.05, HEIGHT);
    add_plate(&mut s, corner, y * 0.5, x * 0.5, 1, 1);
    if wall {
        let corner = Vec3::new(0.0, -0.5, 1.0e-4);
        add_plate(&mut s, corner, Vec3::Y, Vec3::Z * 0.6, 1, 0);
    }
    let config = SolveConfig {
        technique: Technique::Normal,
        epsilon: 1.0e3,
        gradient: 1.0e3,
        rays: 256,
        stop: Stop::Passes(1),
        ..SolveConfig::default()
    };
    let prepared = prepare(&s);
    let solved = solve(&prepared, &config, &Silent).expect("solves");
    let lit = 8 * solved.solution.facets.len() as u64;
    assert!(
        solved.passes[0].exchanges < lit,
        "pairs of clusters are exchanged"
    );
    (solved.solution.facets.iter().enumerate())
        .filter(|(_, facet)| facet.polygon.index() < 8 && facet.side == Side::Front)
        .map(|(f, facet)| {
            let patches = solved.solution.facet_patches(FacetId::new(f));
            assert_eq!(patches.len(), 1, "the floor's triangles stay whole");
            (
                s.corners(facet.polygon),
                f64::from(patches[0].irradiance[0]),
            )
        })
        .collect()
}

/// What the lamp, of radiosity pi, sheds on a point of the floor: Lambert's sum over its outline, in f64.
fn closed_form(at: Vec3) -> f64 {
    let height = f64::from(HEIGHT);
    let corners = [(-0.1, -0.05), (0.0, -0.05), (0.0, 0.05), (-0.1, 0.05)];
    let towards = corners.map(|(x, y)| DVec3::new(x, y, height) - at.as_dvec3());
    let sum: f64 = (0..4)
        .map(|k| {
            let (from, to) = (towards[k], towards[(k + 1) % 4]);
            from.angle_between(to) * from.cross(to).normalize().z
        })
        .sum();
    0.5 * sum
}

/// The mean of that over a triangle, by the centroids of 64 parts of it.
fn mean_over(triangle: [Vec3; 3], levels: u32) -> f64 {
    let [a, b, c] = triangle;
    if levels == 0 {
        return closed_form((a + b + c) / 3.0);
    }
    let parts = (0..4).map(|k| mean_over(split_triangle(triangle, k), levels - 1));
    0.25 * parts.sum::<f64>()
}

#[test]
fn a_cluster_is_lit_more_where_the_lamp_is() {
    let floor = floor_irradiance(false);
    assert_eq!(floor.len(), 8);
    let mean = floor.iter().map(|(_, e)| e).sum::<f64>() / 8.0;
    let (mut worst, mut spread) = (0.0f64, 0.0f64);
    for (triangle, irradiance) in floor {
        worst = worst.max((irradiance / mean_over(triangle, 3) - 1.0).abs());
        spread = spread.max((irradiance / mean - 1.0).abs());
    }
    // What three points of a triangle miss: the fourth power of its radius over the distance, 0.075 / 0.3.
    assert!(worst < 4.0e-3, "{worst}");
    assert!(spread > 0.1, "one vector for all would pass: {spread}");
}

#[test]
fn the_shadow_of_a_wall_falls_on_its_side() {
    for (triangle, irradiance) in floor_irradiance(true) {
        let unoccluded = mean_over(triangle, 3);
        if triangle.iter().all(|corner| corner.x >= 0.0) {
            // What slips under the wall's edge, a ten-thousandth of its height.
            let share = irradiance / unoccluded;
            assert!(share < 1.0e-2, "{triangle:?}: {share}");
        } else {
            let error = (irradiance / unoccluded - 1.0).abs();
            assert!(error < 4.0e-3, "{triangle:?}: {error}");
        }
    }
}
