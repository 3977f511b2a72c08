//! Native tests of segments against definitions in exact arithmetic.

use super::exact::{surely_blocked, surely_clear_of};
use super::nasty_pairs::Draw;
use super::near_segments::NearSegments;
use super::{BlockerList, SceneTree, SegmentOctet, SurvivorList, Tolerance};
use crate::math::Aabb;
use glam::{DVec3, Vec3};

fn octet(segments: &[(Vec3, Vec3); 8]) -> SegmentOctet {
    SegmentOctet {
        from: std::array::from_fn(|axis| segments.map(|s| s.0[axis])),
        to: std::array::from_fn(|axis| segments.map(|s| s.1[axis])),
    }
}

/// A segment through or near a border of a random triangle, its ends near the plane at times.
fn segment(draw: &mut Draw, triangle: [Vec3; 3]) -> (Vec3, Vec3) {
    let [a, b, c] = triangle;
    let normal = (b - a).cross(c - a).normalize_or(Vec3::Z);
    let (s, t) = (draw.unit(), draw.unit());
    let inside = a + (b - a) * s + (c - a) * (t * (1.0 - s));
    let on_edge = a + (b - a) * s;
    let near = if draw.below(2) == 0 { inside } else { on_edge };
    let off = draw.point() * draw.scale(1.0e-7, 1.0e-2);
    let way = (normal * draw.scale(0.01, 1.0) + draw.point()).normalize();
    let (before, behind) = (draw.scale(3.0e-7, 0.4), draw.scale(3.0e-7, 0.4));
    (near + off - way * before, near + off + way * behind)
}

#[test]
fn what_the_filter_drops_the_exact_lines_miss() {
    let (mut dropped, mut kept) = (0, 0);
    for seed in 0..20_000 {
        let mut draw = Draw::new(seed);
        let (centre, size) = (draw.point() * 0.5, draw.scale(1.0e-4, 0.5));
        let triangle = [0; 3].map(|_| centre + draw.point() * size);
        let tolerance = Tolerance::of_scene(Aabb::from_points(triangle));
        let tree = SceneTree::over_triangles(&[triangle], tolerance);
        let mut list = BlockerList::new(&tree);
        if !list.fill(&tree, &SurvivorList::whole_scene(&tree), 1) || list.is_empty() {
            continue;
        }
        // Eight times the same segment, so that it alone decides.
        let (p, q) = segment(&mut draw, triangle);
        if NearSegments::new(&octet(&[(p, q); 8])).may_meet(&list.outlines[0]) {
            kept += 1;
            continue;
        }
        dropped += 1;
        // In f64, with no margin: on one side of the plane, or outside an edge.
        let (blocker, p, q) = (&list.blockers[0], p.as_dvec3(), q.as_dvec3());
        let height = |x: DVec3| blocker.normal.dot(x) - blocker.offset;
        let (along, moment) = (q - p, p.cross(q));
        let upwards = height(q) > height(p);
        let outside = blocker.edges.iter().any(|(e, m)| {
            let g = e.dot(moment) + m.dot(along);
            if upwards { g < 0.0 } else { g > 0.0 }
        });
        assert!(
            height(p) * height(q) > 0.0 || outside,
            "seed {seed}: the filter drops a segment that crosses"
        );
    }
    assert!(
        dropped > 1_000 && kept > 1_000,
        "{dropped} dropped, {kept} kept"
    );
}

#[test]
fn agrees_with_exact_arithmetic_on_every_sure_segment() {
    let tolerance = Tolerance::of_scene(Aabb {
        min: Vec3::splat(-0.5),
        max: Vec3::splat(0.5),
    });
    let (mut blocked, mut clear, mut between) = (0, 0, 0);
    for seed in 0..300 {
        let mut draw = Draw::new(seed);
        let triangles: Vec<[Vec3; 3]> = (0..12)
            .map(|_| {
                let (centre, size) = (draw.point() * 0.5, draw.scale(1.0e-3, 0.5));
                [0; 3].map(|_| centre + draw.point() * size)
            })
            .collect();
        let tree = SceneTree::over_triangles(&triangles, tolerance);
        let mut list = BlockerList::new(&tree);
        let whole = SurvivorList::whole_scene(&tree);
        assert!(!list.fill(&tree, &whole, 11));
        if !list.fill(&tree, &whole, 12) {
            continue;
        }
        assert_eq!(list.len(), 12);
        for _ in 0..6 {
            let segments: [(Vec3, Vec3); 8] = std::array::from_fn(|_| {
                let target = triangles[draw.below(12) as usize];
                segment(&mut draw, target)
            });
            let mask = list.blocked8(&octet(&segments));
            for (lane, &(p, q)) in segments.iter().enumerate() {
                let said = mask & (1 << lane) != 0;
                let (p, q) = (p.as_dvec3(), q.as_dvec3());
                if triangles
                    .iter()
                    .any(|&t| surely_blocked(p, q, t, &tolerance))
                {
                    assert!(said, "seed {seed}: a surely blocked segment passes");
                    blocked += 1;
                } else if triangles
                    .iter()
                    .all(|&t| surely_clear_of(p, q, t, &tolerance))
                {
                    assert!(!said, "seed {seed}: a surely clear segment is blocked");
                    clear += 1;
                } else {
                    between += 1;
                }
            }
        }
    }
    println!("{blocked} blocked, {clear} clear, {between} in between");
    assert!(blocked > 1_000 && clear > 1_000 && between > 100);
}
