//! The same wall gives nearly the same rectangles however it is meshed.

use super::builders::{Placement, Wall, extract};
use crate::occluder::OccluderSet;
use glam::DVec2;

/// Low and high corner of the largest occluder in the wall's own plane.
fn largest(set: &OccluderSet, placement: &Placement) -> [DVec2; 2] {
    let occluder = set
        .occluders
        .iter()
        .max_by(|a, b| a.slab.area().total_cmp(&b.slab.area()))
        .expect("a wall has an occluder");
    let corners = occluder
        .slab
        .corners
        .map(|c| placement.back(c.as_dvec3()).truncate());
    [
        corners.iter().copied().fold(DVec2::INFINITY, DVec2::min),
        corners
            .iter()
            .copied()
            .fold(DVec2::NEG_INFINITY, DVec2::max),
    ]
}

#[test]
fn rectangles_do_not_depend_on_the_mesh() {
    let wall = Wall::with_door_and_windows();
    for placement in [
        Placement::plain(),
        Placement::turned(3),
        Placement::turned(4),
    ] {
        let meshes = [
            wall.regular(2),
            wall.regular(200),
            wall.regular(20_000),
            wall.cut_at_random(200, 1),
            wall.cut_at_random(20_000, 2),
        ];
        assert!(meshes[2].len() > 15_000 && meshes[4].len() >= 20_000);
        let mut first: Option<(f64, [DVec2; 2], usize)> = None;
        for mesh in &meshes {
            let (_, set) = extract(&placement.place(mesh));
            let covered = set.statistics.covered_area;
            assert!((set.statistics.flat_area - wall.area()).abs() < 1.0e-5 * wall.area());
            assert!(
                covered > 0.85 * wall.area(),
                "covered {}",
                covered / wall.area()
            );
            let rectangle = largest(&set, &placement);
            match first {
                None => first = Some((covered, rectangle, set.occluders.len())),
                Some((area, other, count)) => {
                    assert!((covered - area).abs() < 0.001 * area, "{covered} {area}");
                    assert_eq!(set.occluders.len(), count);
                    // Hausdorff distance of two parallel rectangles, within 1e-5 of the scene.
                    let apart = (rectangle[0] - other[0])
                        .abs()
                        .max((rectangle[1] - other[1]).abs())
                        .length();
                    assert!(apart < 1.0e-5, "{apart}: {rectangle:?} {other:?}");
                }
            }
        }
    }
}

#[test]
fn a_rectangle_is_its_own_occluder() {
    let wall = Wall {
        size: DVec2::new(0.5, 0.25),
        holes: Vec::new(),
    };
    for placement in [Placement::plain(), Placement::turned(9)] {
        for count in [2, 5_000] {
            let (_, set) = extract(&placement.place(&wall.cut_at_random(count, 7)));
            assert_eq!(set.occluders.len(), 1);
            assert!(
                set.statistics.covered_share() > 0.99999,
                "{}",
                set.statistics.covered_share()
            );
        }
    }
}
