//! CIE 171:2006, with a lumen as a watt.

use crate::measured::{Measured, z_test};
use certilux::math::PolygonId;
use certilux::reference::{
    interreflection_illuminance, point_to_parallel_rectangle, point_to_perpendicular_rectangle,
};
use certilux::solve::split_triangle;
use glam::{DVec3, dvec3};

/// Mean of `value` over a triangle, by the centroids of 4^`depth` parts.
fn mean(corners: [DVec3; 3], depth: u32, value: &dyn Fn(DVec3) -> f64) -> f64 {
    if depth == 0 {
        return value((corners[0] + corners[1] + corners[2]) / 3.0);
    }
    (0..4)
        .map(|i| mean(split_triangle(corners, i), depth - 1, value))
        .sum::<f64>()
        / 4.0
}

/// Total of a surface that alone reflects, so that no light comes from anywhere but the floor.
fn check_5_6(material: &str, value: &dyn Fn(DVec3) -> f64) {
    const RHO: f64 = 0.5;
    let case = Measured::with_materials("cie171-5.6", &[(material, RHO, 0.0)], 0.01);
    let scene = &case.traced.scene;
    let (mut area, mut want) = (0.0, 0.0);
    for id in (0..scene.polygons.len()).map(PolygonId::new) {
        if scene.surface(id).material == material {
            let corners = scene.source_corners(id);
            let part = 0.5
                * (corners[1] - corners[0])
                    .cross(corners[2] - corners[0])
                    .length();
            // The file is y up; the formulas have z up.
            want += part * mean(corners.map(|p| dvec3(p.x, -p.z, p.y)), 5, value);
            area += part;
        }
    }
    z_test(
        &format!("CIE 5.6 {material}"),
        case.mean(material),
        RHO * want / area,
        2e-3,
    );
}

#[test]
fn case_5_6_wall() {
    check_5_6("wall_black", &|p| {
        let sides = [p.y, 4.0 - p.y];
        let factor: f64 = sides
            .map(|a| point_to_perpendicular_rectangle(a, 4.0, p.z))
            .iter()
            .sum();
        500.0 * factor
    });
}

#[test]
fn case_5_6_ceiling() {
    check_5_6("ceiling_black", &|p| {
        let mut factor = 0.0;
        for a in [p.x, 4.0 - p.x] {
            for b in [p.y, 4.0 - p.y] {
                factor += point_to_parallel_rectangle(a, b, p.z);
            }
        }
        500.0 * factor
    });
}

#[test]
fn case_5_8_interreflects() {
    let direct = 10_000.0 / 96.0;
    for (rho, error) in [(0.5, 0.02), (0.9, 0.05)] {
        let case = Measured::builtin(&format!("cie171-5.8-{rho}"), error);
        let (radiosity, stderr) = case.mean("wall");
        // All light that a wall gives off without emitting it came from walls, `direct` of it for the
        // first time; the published figure leaves that out.
        let arriving = (radiosity - direct) / rho;
        let want = interreflection_illuminance(rho, 10_000.0, 96.0);
        z_test(
            &format!("CIE 5.8 rho {rho}"),
            (arriving - direct, stderr / rho),
            want,
            0.01,
        );
    }
}
