//! Proofs by test that nothing reaches into an empty box, that boxes are found where air is, and as large as can be.

use super::nasty_pairs::Draw;
use super::nasty_scenes::{
    Triangles, bowl, grid, room, sheet, sphere, spiral_stair, torus, turned,
};
use super::near_segments::SegmentOctet;
use super::proof_stage::Stage;
use super::{ElementBounds, EmptyBoxes};
use crate::math::Aabb;
use glam::{Quat, Vec3};

/// Pairs of points on the triangles, whether they see each other or not.
fn sights(stage: &Stage, count: usize, seed: u64) -> Vec<[Vec3; 2]> {
    let mut draw = Draw::new(seed);
    let mut point = || {
        let [a, b, c] = stage.triangles[draw.below(stage.triangles.len() as u32) as usize];
        let mut part = || draw.below(1000) as f32 / 1000.0;
        let root = part().sqrt();
        let v = part();
        a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v)
    };
    (0..count).map(|_| [point(), point()]).collect()
}

/// A part of a box: two draws a coordinate, either often on the border.
fn part_of(bounds: Aabb, draw: &mut Draw) -> Aabb {
    let mut point = || {
        let share = Vec3::from_array(std::array::from_fn(|_| match draw.below(4) {
            0 => 0.0,
            1 => 1.0,
            _ => draw.below(1000) as f32 / 1000.0,
        }));
        // The farther end as it is, not rounded.
        Vec3::select(
            share.cmpeq(Vec3::ONE),
            bounds.max,
            bounds.min + (bounds.max - bounds.min) * share,
        )
        .clamp(bounds.min, bounds.max)
    };
    Aabb::from_points([point(), point()])
}

/// Boxes of a scene, after exact arithmetic has let every one of them and many pairs inside them stand.
fn proved_boxes(triangles: Triangles, seed: u64) -> EmptyBoxes {
    let stage = Stage::new(triangles);
    let found = EmptyBoxes::build(&stage.tree, &sights(&stage, 1500, seed));
    let mut draw = Draw::new(seed ^ 1);
    for bounds in found.boxes() {
        let whole = ElementBounds::from_box(bounds);
        let (blockers, _) = stage.judge(&whole, &whole);
        assert!(blockers.is_empty(), "{blockers:?} reach into {bounds:?}");
        for _ in 0..4 {
            let [a, b] = [(); 2].map(|()| part_of(bounds, &mut draw));
            assert!(found.near(a).hold(a, b) || found.boxes().len() > 8);
            let [a, b] = [a, b].map(ElementBounds::from_box);
            let (blockers, _) = stage.judge(&a, &b);
            assert!(blockers.is_empty(), "{blockers:?} part two in {bounds:?}");
        }
    }
    found
}

/// Of segments between points in and around boxes, those that one of them holds whole are said to lie in air.
#[test]
fn segments_lie_in_air_where_one_box_holds_both_ends() {
    let mut draw = Draw::new(3);
    let mut held = 0;
    for _ in 0..2_000 {
        // On a grid, so that points lie on borders.
        let mut point = || (draw.point() * 8.0).round() / 8.0;
        let boxes: Vec<Aabb> = (0..5)
            .map(|_| Aabb::from_points([point(), point()]))
            .collect();
        let segments: [[Vec3; 2]; 8] = std::array::from_fn(|_| [point(), point()]);
        let ends = |end: usize| Aabb::from_points(segments.map(|segment| segment[end]));
        let near = EmptyBoxes::planted(boxes.clone()).near(ends(0));
        let octet = SegmentOctet {
            from: std::array::from_fn(|axis| segments.map(|segment| segment[0][axis])),
            to: std::array::from_fn(|axis| segments.map(|segment| segment[1][axis])),
        };
        let air = near.between(ends(0), ends(1));
        let said = air.map_or(0, |air| air.hold8(&octet));
        for (lane, [p, q]) in segments.into_iter().enumerate() {
            let is_held = boxes.iter().any(|b| b.contains(p) && b.contains(q));
            assert_eq!(said & (1 << lane) != 0, is_held, "{p} to {q} in {boxes:?}");
            held += u32::from(is_held);
        }
    }
    assert!((1_000..15_000).contains(&held), "{held} of 16000");
}

/// A room with boxes of furniture and a leaning board.
fn furnished() -> Triangles {
    let mut triangles = room(Vec3::splat(0.5), 2, Quat::IDENTITY);
    for (centre, half) in [
        (Vec3::new(-0.2, -0.1, -0.35), Vec3::new(0.1, 0.2, 0.15)),
        (Vec3::new(0.25, 0.2, -0.3), Vec3::new(0.05, 0.05, 0.2)),
        (Vec3::new(0.1, -0.3, 0.2), Vec3::new(0.2, 0.05, 0.01)),
    ] {
        let block = room(half, 1, Quat::IDENTITY);
        triangles.extend(block.into_iter().map(|t| t.map(|p| p + centre)));
    }
    let board = sheet(
        Vec3::new(0.3, -0.4, -0.5),
        Vec3::new(0.15, 0.0, 0.4),
        Vec3::Y * 0.2,
        1,
        1,
    );
    triangles.extend(board);
    triangles
}

#[test]
fn nothing_reaches_into_a_box() {
    let mut boxes = 0;
    for (seed, turn) in [
        Quat::IDENTITY,
        Quat::from_rotation_z(1.0e-7),
        Quat::from_rotation_z(3.0e-4),
        Quat::from_rotation_y(0.6),
    ]
    .into_iter()
    .enumerate()
    {
        boxes += proved_boxes(turned(furnished(), turn), seed as u64)
            .boxes()
            .len();
    }
    assert!(boxes > 40, "{boxes}");
}

#[test]
fn nothing_curved_or_loose_reaches_into_a_box() {
    let mut draw = Draw::new(7);
    let mut point = |size: f32| {
        let mut share = || draw.below(1000) as f32 / 1000.0 - 0.5;
        size * Vec3::from_array([share(), share(), share()])
    };
    let mut loose = room(Vec3::splat(0.5), 2, Quat::IDENTITY);
    loose.extend((0..12).map(|_| {
        let corner = point(0.8);
        [corner, corner + point(0.2), corner + point(0.2)]
    }));
    let scenes = [
        bowl(6),
        sphere(8),
        torus(8),
        spiral_stair(12),
        grid(12, 12, |s, t| {
            Vec3::new(s, t, 0.02 * (9.0 * s).sin() * (7.0 * t).cos())
        }),
        loose,
    ];
    let boxes: Vec<usize> = scenes
        .into_iter()
        .zip(20..)
        .map(|(triangles, seed)| proved_boxes(triangles, seed).boxes().len())
        .collect();
    assert!(boxes[3].min(boxes[5]) > 5, "{boxes:?}");
}

#[test]
fn the_air_of_an_empty_room_is_one_box() {
    let half = Vec3::new(0.5, 0.3, 0.2);
    let stage = Stage::new(room(half, 4, Quat::IDENTITY));
    let found = EmptyBoxes::build(&stage.tree, &sights(&stage, 500, 3));
    let boxes = found.boxes();
    let [only] = boxes.as_slice() else {
        panic!("{boxes:?}");
    };
    let tau = stage.tree.tolerance().tau;
    assert!((only.max - half).abs().max_element() <= tau);
    assert!((only.min + half).abs().max_element() <= tau);
    let walls = found.near(stage.tree.bounds());
    let mut draw = Draw::new(4);
    for _ in 0..200 {
        let [a, b] = [(); 2].map(|()| stage.patch(&mut draw).aabb());
        assert!(walls.hold(a, b));
    }
}

#[test]
fn boxes_end_at_a_table() {
    let mut triangles = room(Vec3::splat(0.5), 1, Quat::IDENTITY);
    let top = sheet(
        Vec3::new(-0.2, -0.3, -0.1),
        Vec3::X * 0.4,
        Vec3::Y * 0.5,
        1,
        1,
    );
    triangles.extend(top);
    let stage = Stage::new(triangles);
    let seen = |from: Vec3, to: Vec3| {
        let found = EmptyBoxes::build(&stage.tree, &[[from, to]; 8]);
        assert_eq!(found.boxes().len(), 1);
        found.boxes()[0]
    };
    let tau = stage.tree.tolerance().tau;
    let near = |a: Aabb, min: Vec3, max: Vec3| {
        (a.min - min).abs().max_element() <= tau && (a.max - max).abs().max_element() <= tau
    };
    let (low, high) = (Vec3::splat(-0.5), Vec3::splat(0.5));
    let over = seen(Vec3::new(0.0, 0.0, -0.1), Vec3::new(0.1, 0.1, 0.5));
    assert!(near(over, low.with_z(-0.1), high), "{over:?}");
    let under = seen(Vec3::new(0.0, 0.0, -0.5), Vec3::new(0.1, 0.1, -0.1));
    assert!(near(under, low, high.with_z(-0.1)), "{under:?}");
    // Beside the table the box has the whole height of the room.
    let beside = seen(Vec3::new(0.3, 0.0, -0.5), Vec3::new(0.4, 0.1, 0.5));
    assert!(near(beside, low.with_x(0.2), high), "{beside:?}");
    // Through the table nothing is seen.
    let through = [[Vec3::new(0.0, 0.0, -0.5), Vec3::new(0.1, 0.1, 0.5)]; 8];
    assert!(EmptyBoxes::build(&stage.tree, &through).boxes().is_empty());
}

#[test]
fn nearby_boxes_hold_what_one_of_them_contains() {
    let stage = Stage::new(furnished());
    let mut boxes = EmptyBoxes::build(&stage.tree, &sights(&stage, 1500, 9)).boxes();
    boxes.truncate(8);
    assert!(boxes.len() > 4);
    let found = EmptyBoxes::planted(boxes.clone());
    let mut draw = Draw::new(10);
    let mut held = 0;
    for _ in 0..2000 {
        let [a, b] = [(); 2].map(|()| part_of(stage.tree.bounds(), &mut draw));
        let expected = boxes.iter().any(|x| x.contains_box(a) && x.contains_box(b));
        assert_eq!(found.near(a).hold(a, b), expected);
        held += u32::from(expected);
    }
    assert!(held > 10, "{held}");
}

#[test]
fn the_boxes_do_not_depend_on_threads() {
    let stage = Stage::new(furnished());
    let sights = sights(&stage, 1500, 11);
    let with = |threads: usize| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads start")
            .install(|| EmptyBoxes::build(&stage.tree, &sights).boxes())
    };
    let boxes = with(1);
    assert!(boxes.len() > 4);
    assert_eq!(boxes, with(3));
}
