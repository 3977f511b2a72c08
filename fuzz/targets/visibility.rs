//! No claim of full visibility past a polygon that surely blocks a segment of the pair, whether the
//! list is the whole scene's or handed down.

#![no_main]

use certilux::math::Aabb;
use certilux::visibility::exact::visibility_counterexample;
use certilux::visibility::{
    BoundsShape, ElementBounds, SceneTree, SurvivorList, Tolerance, Verdict, VisibilityQuery,
    VisibilityScratch, WalkLimits,
};
use certilux_fuzz::{Bytes, element, triangle};
use glam::Vec3;
use libfuzzer_sys::fuzz_target;

/// A part of an element: a box halved, or a corner of a polygon cut off.
fn part(bounds: &ElementBounds, bytes: &mut Bytes) -> ElementBounds {
    if bounds.shape() == BoundsShape::Box {
        let mut half = bounds.aabb();
        let axis = bytes.below(3);
        half.max[axis] = half.centre()[axis];
        return ElementBounds::from_box(half);
    }
    let first = bytes.below(bounds.corner_count());
    let corner = bounds.corner(first);
    let corners: Vec<Vec3> = (0..bounds.corner_count().min(4))
        .map(|i| (bounds.corner(i) + corner) * 0.5)
        .collect();
    ElementBounds::from_polygon(&corners)
}

fuzz_target!(|data: &[u8]| {
    let bytes = &mut Bytes::new(data);
    let (mut a, mut b) = (element(bytes), element(bytes));
    let limits = WalkLimits {
        blocking_leaves: 1 + bytes.below(3) as u32,
        nodes: [u32::MAX, 1, 3][bytes.below(3)],
    };
    let mut triangles = Vec::new();
    while !bytes.is_empty() && triangles.len() < 40 {
        triangles.push(triangle(bytes));
    }
    let cube = Aabb {
        min: Vec3::splat(-0.5),
        max: Vec3::splat(0.5),
    };
    let tree = SceneTree::over_triangles(&triangles, Tolerance::of_scene(cube));
    let query = VisibilityQuery::new(&tree);
    let mut lists = [SurvivorList::whole_scene(&tree), SurvivorList::new()];
    let mut scratch = VisibilityScratch::default();
    for level in 0..4 {
        let [incoming, outgoing] = &mut lists;
        let answer = query.run(&a, &b, incoming, outgoing, limits, &mut scratch);
        assert_eq!(answer.verdict == Verdict::Visible, outgoing.is_empty());
        let left = outgoing.polygons(&tree);
        for (id, &triangle) in triangles.iter().enumerate() {
            let handed_down = left.iter().any(|p| p.index() == id);
            if handed_down {
                continue;
            }
            let blocked = visibility_counterexample(&a, &b, triangle, tree.tolerance());
            assert_eq!(
                blocked, None,
                "level {level}: polygon {id} is waved through"
            );
        }
        if answer.verdict == Verdict::Visible {
            break;
        }
        lists.swap(0, 1);
        if bytes.below(2) == 0 {
            a = part(&a, bytes);
        } else {
            b = part(&b, bytes);
        }
    }
});
