//! CIE 171:2006, with a lumen as a watt. The usual tolerance for published tools is 5 %; ours is 1 %.

use crate::case::{Case, check};
use certilux::reference::{
    interreflection_illuminance, point_to_parallel_rectangle, point_to_perpendicular_rectangle,
};
use certilux::solve::split_triangle;
use glam::{DVec3, dvec3};
use std::collections::BTreeMap;

#[test]
fn case_5_4_conserves_flux() {
    let case = Case::builtin("cie171-5.4");
    let received = case.received("black") + case.received("source");
    check("CIE 5.4 flux received", received, 1000.0, 0.01);
}

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

#[test]
fn case_5_6_lights_wall_and_ceiling() {
    // A floor of 4 x 4 m of radiosity 500, a wall at x = 4 and a ceiling at z = 3.
    let wall = |p: DVec3| -> f64 {
        let sides = [p.y, 4.0 - p.y];
        500.0
            * sides
                .map(|a| point_to_perpendicular_rectangle(a, 4.0, p.z))
                .iter()
                .sum::<f64>()
    };
    let ceiling = |p: DVec3| -> f64 {
        let mut sum = 0.0;
        for a in [p.x, 4.0 - p.x] {
            for b in [p.y, 4.0 - p.y] {
                sum += point_to_parallel_rectangle(a, b, p.z);
            }
        }
        500.0 * sum
    };
    let case = Case::builtin("cie171-5.6");
    let patches = case.patches();
    for (material, value) in [
        ("wall_black", &wall as &dyn Fn(DVec3) -> f64),
        ("ceiling_black", &ceiling),
    ] {
        let mut faces: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
        for patch in patches.iter().filter(|p| p.material == material) {
            let [got, want] = faces.entry(patch.face).or_default();
            *got += patch.area * patch.irradiance;
            // The file is y up; the formulas above have z up.
            let corners = patch.corners.map(|p| dvec3(p.x, -p.z, p.y));
            *want += patch.area * mean(corners, 3, value);
        }
        assert!(faces.len() > 90, "{material}: {} faces", faces.len());
        let worst = faces
            .values()
            .map(|[got, want]| got / want)
            .fold(1.0, |w: f64, r| {
                if (r - 1.0).abs() > (w - 1.0).abs() {
                    r
                } else {
                    w
                }
            });
        check(&format!("CIE 5.6 {material}, worst face"), worst, 1.0, 0.01);
    }
}

#[test]
fn case_5_8_interreflects() {
    for rho in [0.5, 0.9] {
        let case = Case::builtin(&format!("cie171-5.8-{rho}"));
        let direct = 10_000.0 / 96.0;
        // Each wall emits `direct`; what arrives beyond that first flux is reflected light.
        let arriving = case.received("wall") / case.area("wall");
        let want = interreflection_illuminance(rho, 10_000.0, 96.0);
        check(&format!("CIE 5.8 rho {rho}"), arriving - direct, want, 0.01);
    }
}
