//! Every rectangle lies inside the footprint: checked apart from the extraction, triangle by
//! triangle, by clipping (the areas of disjoint pieces must add up).

use super::builders::{Placement, Random, Wall, extract_with};
use crate::occluder::OccluderConfig;
use glam::DVec2;
use proptest::prelude::*;

/// Area of `triangle` (counter-clockwise) inside the convex polygon `clip` (counter-clockwise), by
/// cutting with its sides one by one.
fn clipped_area(triangle: [DVec2; 3], clip: &[DVec2]) -> f64 {
    let mut polygon = triangle.to_vec();
    for i in 0..clip.len() {
        let (a, b) = (clip[i], clip[(i + 1) % clip.len()]);
        let side = |p: DVec2| (b - a).perp_dot(p - a);
        let mut cut = Vec::new();
        for j in 0..polygon.len() {
            let (p, q) = (polygon[j], polygon[(j + 1) % polygon.len()]);
            if side(p) >= 0.0 {
                cut.push(p);
            }
            if (side(p) > 0.0) != (side(q) > 0.0) && side(p) != side(q) {
                cut.push(p + (q - p) * (side(p) / (side(p) - side(q))));
            }
        }
        polygon = cut;
    }
    signed_area(&polygon)
}

fn signed_area(polygon: &[DVec2]) -> f64 {
    let sides = (0..polygon.len()).map(|i| (polygon[i], polygon[(i + 1) % polygon.len()]));
    0.5 * sides.map(|(p, q)| p.perp_dot(q)).sum::<f64>()
}

/// The pieces of the mesh inside each occluder fill it: the mesh tiles its footprint without
/// overlap, so the areas of the pieces add up to the occluder's exactly if none of it sticks out.
fn assert_filled(mesh: &[[DVec2; 3]], placement: Placement, config: &OccluderConfig) -> usize {
    let (_, set) = extract_with(&placement.place(mesh), config);
    for occluder in &set.occluders {
        let corners = occluder
            .slab
            .corners
            .map(|c| placement.back(c.as_dvec3()).truncate());
        let mut clip = corners.to_vec();
        if signed_area(&clip) < 0.0 {
            clip.reverse();
        }
        // Corners are rounded: no parallelogram, by more than what is allowed.
        let full = signed_area(&clip);
        let filled: f64 = mesh.iter().map(|&t| clipped_area(t, &clip)).sum();
        // Sides sticking out by 1e-8 (a thirtieth of the margin kept) over a tenth of the scene
        // would be missed; by more, found.
        let perimeter = 2.0 * ((clip[1] - clip[0]).length() + (clip[3] - clip[0]).length());
        assert!(
            (filled - full).abs() < 1.0e-8 * perimeter,
            "{} of {full} at {corners:?}",
            filled - full
        );
    }
    set.occluders.len()
}

fn wall() -> impl Strategy<Value = Wall> {
    let hole = (0.0..0.9f64, 0.0..0.9f64, 0.02..0.4f64, 0.02..0.4f64);
    (0.1..0.6f64, 0.1..0.6f64, prop::collection::vec(hole, 0..6)).prop_map(|(w, h, holes)| {
        let size = DVec2::new(w, h);
        Wall {
            size,
            holes: holes
                .into_iter()
                .map(|(x, y, w, h)| {
                    let low = DVec2::new(x, y);
                    [low * size, (low + DVec2::new(w, h)).min(DVec2::ONE) * size]
                })
                .collect(),
        }
    })
}

fn small() -> OccluderConfig {
    OccluderConfig {
        per_cluster: 12,
        min_area: 1.0e-5,
        flush: false,
        ..OccluderConfig::default()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn rectangles_lie_inside_walls_with_holes(wall in wall(), seed in 0u64..1_000, plain: bool) {
        prop_assume!(wall.area() > 1.0e-3);
        let placement = if plain { Placement::plain() } else { Placement::turned(seed) };
        let found = assert_filled(&wall.cut_at_random(300, seed), placement, &small());
        prop_assert!(found > 0);
    }

    #[test]
    fn rectangles_lie_inside_meshes_with_random_holes(seed in 0u64..10_000, missing in 0usize..60) {
        let whole = Wall { size: DVec2::new(0.5, 0.4), holes: Vec::new() };
        let mut mesh = whole.cut_at_random(400, seed);
        let mut random = Random::new(seed);
        for _ in 0..missing {
            mesh.swap_remove(random.below(mesh.len()));
        }
        let found = assert_filled(&mesh, Placement::turned(seed), &small());
        prop_assert!(found > 0);
    }
}

#[test]
fn the_check_finds_a_rectangle_that_sticks_out() {
    let mesh = Wall::with_door_and_windows().regular(100);
    let placement = Placement::plain();
    let (_, set) = extract_with(&placement.place(&mesh), &small());
    let corners = set.occluders[0]
        .slab
        .corners
        .map(|c| placement.back(c.as_dvec3()).truncate());
    let centre = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    let grown = corners.map(|c| centre + (c - centre) * 1.001);
    let area = (grown[1] - grown[0]).perp_dot(grown[3] - grown[0]);
    assert!(area > 0.0);
    let filled: f64 = mesh.iter().map(|&t| clipped_area(t, &grown)).sum();
    assert!(area - filled > 1.0e-5);
}
