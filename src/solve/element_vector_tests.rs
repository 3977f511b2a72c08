//! The vectors of clusters and triangles against Lambert's integral in f64, facet by facet.

use super::element::Element;
use super::element_vector::{Space, element_vector};
use super::facet_frame::FacetFrame;
use super::fixture::{add_plate, grey, prepare, scene};
use super::flux_tree::FluxTree;
use super::prepared::PreparedScene;
use super::triangle_vector::triangle_vector;
use crate::math::NodeId;
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use std::f64::consts::PI;

/// The vector of a triangle of unit radiosity, counter-clockwise seen from the point: of its part above the horizon.
fn lambert(corners: [Vec3; 3], point: Vec3, normal: Option<Vec3>) -> DVec3 {
    let mut polygon = corners.map(|c| c.as_dvec3() - point.as_dvec3()).to_vec();
    if (polygon[1] - polygon[0])
        .cross(polygon[2] - polygon[0])
        .dot(polygon[0])
        >= 0.0
    {
        return DVec3::ZERO;
    }
    if let Some(n) = normal.map(Vec3::as_dvec3) {
        let mut above = Vec::new();
        for (i, &a) in polygon.iter().enumerate() {
            let b = polygon[(i + 1) % polygon.len()];
            let (ha, hb) = (n.dot(a), n.dot(b));
            if ha >= 0.0 {
                above.push(a);
            }
            if (ha >= 0.0) != (hb >= 0.0) {
                above.push(a + (b - a) * (ha / (ha - hb)));
            }
        }
        polygon = above;
    }
    let edges = (0..polygon.len()).map(|i| [polygon[i], polygon[(i + 1) % polygon.len()]]);
    edges
        .map(|[a, b]| {
            let cross = b.cross(a);
            let sine = cross.length();
            match sine > 0.0 {
                true => cross * (sine.atan2(a.dot(b)) / sine),
                false => DVec3::ZERO,
            }
        })
        .sum::<DVec3>()
        / (2.0 * PI)
}

/// Asks `judge` with the space of a scene whose facets all shine evenly.
fn in_space(prepared: &PreparedScene, judge: impl Fn(&Space)) {
    let (scene, hierarchy) = (&prepared.scene, &prepared.hierarchy);
    let normals: Vec<Vec3> = hierarchy
        .facets
        .iter()
        .map(|&f| {
            let [a, b, c] = scene.facet_corners(f);
            (b - a).cross(c - a).normalize()
        })
        .collect();
    judge(&Space {
        scene,
        hierarchy,
        flux_tree: &FluxTree::new(scene, hierarchy),
        frames: &FacetFrame::of_all(scene, hierarchy, &normals),
        tau: 1.0e-6,
    });
}

/// Directions spread over the sphere.
fn directions(count: u32) -> impl Iterator<Item = Vec3> {
    (0..count).map(move |i| {
        let z = 1.0 - 2.0 * (i as f32 + 0.5) / count as f32;
        let turn = 2.4 * i as f32;
        let across = (1.0 - z * z).sqrt();
        Vec3::new(across * turn.cos(), across * turn.sin(), z)
    })
}

#[test]
fn a_flat_cluster_sends_what_its_facets_send_from_contact_to_far_away() {
    let mut s = scene(vec![grey(0.5, 1.0)]);
    let (u, v) = (Vec3::new(0.1, 0.01, 0.0), Vec3::new(0.0, 0.07, 0.02));
    add_plate(&mut s, Vec3::new(-0.05, 0.0, 0.1), u, v, 6, 0);
    let prepared = prepare(&s);
    in_space(&prepared, |space| {
        let root = Element::of_node(space.scene, space.hierarchy, NodeId(0));
        let facing = root.normal;
        let (mut judged, mut cut, mut errors) = (0, 0, Vec::new());
        for radii in [0.05f32, 0.3, 1.0, 1.7, 2.5, 4.0, 5.5, 8.0, 15.0, 40.0] {
            for away in directions(60).filter(|d| d.dot(facing) > 0.05) {
                let point = root.centroid + away * (radii * root.radius);
                for normal in directions(12).map(Some).chain([None]) {
                    let got = element_vector(space, &root, point, normal).as_dvec3();
                    let facets = root.facet_range().map(|f| space.hierarchy.facets[f]);
                    let want: DVec3 = facets
                        .map(|f| lambert(space.scene.facet_corners(f), point, normal))
                        .sum();
                    let whole = match normal {
                        None => want.length(),
                        Some(_) => element_vector(space, &root, point, None)
                            .as_dvec3()
                            .length(),
                    };
                    // A part that stands as one is above the horizon as a whole, or not at all.
                    let straddles = normal.is_some_and(|n| n.dot(-away).abs() * radii < 1.5);
                    let tolerance = if straddles { 0.1 } else { 1.5e-2 };
                    // With a normal, it is the irradiance that counts.
                    let error = match normal {
                        None => (got - want).length(),
                        Some(n) => n.as_dvec3().dot(got - want).abs(),
                    };
                    assert!(
                        error < tolerance * whole + 1.0e-7,
                        "{radii} radii, {away} {normal:?}: {got} for {want}"
                    );
                    if normal.is_none() {
                        errors.push(error / whole);
                    }
                    judged += u32::from(want.length() > 0.0);
                    cut += u32::from(straddles);
                }
            }
        }
        assert!(judged > 1000 && cut > 100, "{judged} {cut}");
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        println!(
            "{mean} in the mean, {} at most",
            errors.iter().fold(0.0f64, |m, &e| m.max(e))
        );
        assert!(mean < 2.5e-3, "{mean}");
    });
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, max_global_rejects: 20_000, ..ProptestConfig::default() })]
    /// Triangles of any shape from the contour to the centroid: the quadratures keep their bounds.
    #[test]
    fn a_triangle_sends_what_lambert_says(
        corners in prop::array::uniform3(prop::array::uniform3(-1.0f32..1.0)),
        away in prop::array::uniform3(-1.0f32..1.0),
        radii in 0.5f32..30.0,
    ) {
        let corners = corners.map(Vec3::from);
        let cross = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        let centroid = (corners[0] + corners[1] + corners[2]) / 3.0;
        let radius = corners.map(|c| c.distance(centroid)).into_iter().fold(0.0, f32::max);
        let away = Vec3::from(away).normalize_or_zero();
        let away = if away.dot(cross) > 0.0 { away } else { -away };
        prop_assume!(cross.length() > 1.0e-2 && away.dot(cross.normalize()) > 0.05);
        let point = centroid + away * (radii * radius);
        let got = triangle_vector(corners, cross.normalize(), 0.5 * cross.length(), point, None, 0.0);
        let want = lambert(corners, point, None);
        let error = (got.as_dvec3() - want).length() / want.length();
        let bound = if radii > 20.0 { 2.5e-3 } else { 1.0e-3 };
        prop_assert!(error < bound, "{radii} radii: {got} for {want}, {error}");
    }
}
