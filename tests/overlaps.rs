//! Polygons that lie on each other: who owns the area, and what finding out costs.

use certilux::math::PolygonId;
use certilux::scene::{Axes, Facet, LoadConfig, Overlaps, Scene, Side, find_overlaps, load_text};
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use std::fmt::Write;

const MATERIALS: &[u8] = b"newmtl wall\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n";

/// Rectangles `[x0, y0, x1, y1]` at a height, front up (or down if `x1 < x0`), with their material.
fn scene(rectangles: &[([f64; 4], f64, &str)], turn: DQuat) -> Scene {
    // A lamp far below, and far enough aside to lie on nothing.
    let mut obj =
        String::from("mtllib m.mtl\nusemtl lamp\nv 0 0 -9\nv 1 0 -9\nv 0 1 -9\nf 1 2 3\n");
    for (k, ([x0, y0, x1, y1], z, material)) in rectangles.iter().enumerate() {
        for (x, y) in [(x0, y0), (x1, y0), (x1, y1), (x0, y1)] {
            let p = turn * DVec3::new(*x, *y, *z);
            writeln!(obj, "v {} {} {}", p.x, p.y, p.z).unwrap();
        }
        let first = 4 + 4 * k;
        writeln!(
            obj,
            "usemtl {material}\nf {first} {} {} {}",
            first + 1,
            first + 2,
            first + 3
        )
        .unwrap();
    }
    // Along the file's axes, so that what is turned stays askew.
    let mut load = LoadConfig::default();
    load.axes = Axes::File;
    load_text("t.obj", obj.as_bytes(), &[("m.mtl", MATERIALS)], &load).unwrap()
}

/// For each face after the lamp whether its front and its back are covered in all its polygons;
/// panics if its polygons differ.
fn covered(scene: &Scene, overlaps: &Overlaps) -> Vec<[bool; 2]> {
    (1..scene.source_faces)
        .map(|face| {
            [Side::Front, Side::Back].map(|side| {
                let mut of_polygons = (0..scene.polygons.len())
                    .filter(|&i| scene.polygons[i].source_face == face)
                    .map(|i| {
                        overlaps.is_covered(Facet {
                            polygon: PolygonId::new(i),
                            side,
                        })
                    });
                let first = of_polygons.next().unwrap();
                assert!(of_polygons.all(|c| c == first));
                first
            })
        })
        .collect()
}

fn judge(rectangles: &[([f64; 4], f64, &str)]) -> Vec<[bool; 2]> {
    let mut answer = None;
    for turn in [
        DQuat::IDENTITY,
        DQuat::from_rotation_y(1.0),
        DQuat::from_axis_angle(DVec3::new(0.6, 0.64, 0.48), 2.3),
    ] {
        let scene = scene(rectangles, turn);
        let found = covered(&scene, &find_overlaps(&scene));
        assert_eq!(
            *answer.get_or_insert_with(|| found.clone()),
            found,
            "turned by {turn}"
        );
    }
    answer.unwrap()
}

#[test]
fn the_first_of_two_owns_what_the_second_covers() {
    // Cut along the other diagonal's direction by offset corners, so that neither is a duplicate.
    let whole = ([0., 0., 4., 4.], 0., "wall");
    let part = ([1., 1., 2., 3.], 0., "wall");
    assert_eq!(judge(&[whole, part]), [[false; 2], [true; 2]]);
    // The large one comes second: it is covered in part only, and keeps its sides.
    assert_eq!(judge(&[part, whole]), [[false; 2], [false; 2]]);
    let scene = scene(&[part, whole], DQuat::IDENTITY);
    let overlaps = find_overlaps(&scene);
    // The diagonal of the large one passes through the small one, so both of its halves count.
    assert_eq!(overlaps.partly_covered_fronts, 2);
    assert!(
        (overlaps.partly_covered_share - 2.0 / 18.5).abs() < 1e-6,
        "{overlaps:?}"
    );
    assert!(
        scene
            .warnings
            .iter()
            .any(|w| w.0.contains("lie partly on others")),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn several_together_cover_what_none_covers_alone() {
    let tiles = [
        ([0., 0., 2., 4.], 0., "wall"),
        ([2., 0., 4., 2.], 0., "wall"),
        ([2., 2., 4., 4.], 0., "wall"),
        ([1., 1., 3.5, 3.], 0., "wall"),
    ];
    assert_eq!(judge(&tiles)[3], [true; 2]);
    assert_eq!(judge(&tiles[1..])[2], [false; 2]);
}

#[test]
fn a_front_covers_the_back_of_a_sheet_that_faces_the_other_way() {
    let up = ([0., 0., 4., 4.], 0., "wall");
    let down = ([4., 0., 0., 4.], 0., "wall");
    assert_eq!(judge(&[up, down]), [[false, true], [false, true]]);
}

/// Height in the file of a sheet that lies `steps` times seven tenths of tau up: neighbours lie on each other, others not.
fn layer(steps: u8) -> f64 {
    // The diagonal from the lamp at z = -9 to the far corner of the largest sheets.
    f64::from(steps) * 0.7e-6 * DVec3::new(9.0, 9.0, 9.0).length()
}

#[test]
fn what_lies_on_a_covered_sheet_alone_is_not_covered() {
    let corner = ([8., 8., 9., 9.], 0., "wall");
    let sheet = |steps| ([0., 0., 4., 4.], layer(steps), "wall");
    let lamp = |steps| ([4., 0., 0., 4.], layer(steps), "lamp");
    let (keeps, gives) = ([false; 2], [true; 2]);
    let three = [corner, sheet(0), sheet(1), sheet(2)];
    assert_eq!(judge(&three)[1..], [keeps, gives, keeps]);
    let five = [corner, sheet(4), sheet(3), sheet(2), sheet(1), sheet(0)];
    assert_eq!(judge(&five)[1..], [keeps, gives, keeps, gives, keeps]);
    // The lowest of them has no other below it that could take its light.
    let lamps = [corner, lamp(3), lamp(2), lamp(1), lamp(0)];
    assert_eq!(judge(&lamps)[1..], [keeps, gives, keeps, gives]);
    let scene = scene(&lamps, DQuat::IDENTITY);
    let warned = |text: &str| scene.warnings.iter().any(|w| w.0.contains(text));
    assert!(
        warned("4 polygons of those emit but lie on others that emit too"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn a_lamp_set_into_a_ceiling_shines() {
    let ceiling = ([4., 0., 0., 4.], 0., "wall");
    let lamp = ([2., 1., 1., 2.], 0., "lamp");
    assert_eq!(judge(&[ceiling, lamp]), [[false, false], [false, true]]);
}

#[test]
fn neighbours_and_layers_do_not_overlap() {
    let apart = [
        ([0., 0., 2., 2.], 0., "wall"),
        ([2., 0., 4., 1.], 0., "wall"),
        ([2., 1., 4., 2.], 0., "wall"),
        // A millimetre above, in a scene of ten metres.
        ([0., 0., 2., 2.], 1e-3, "wall"),
    ];
    assert_eq!(judge(&apart), [[false; 2]; 4]);
    let scene = scene(&apart, DQuat::from_rotation_x(0.7));
    let overlaps = find_overlaps(&scene);
    assert_eq!(overlaps.partly_covered_fronts, 0);
    assert_eq!(overlaps.unchecked, 0);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    /// On a grid of integers the owned area can be counted cell by cell: who comes first owns a cell for all within tau.
    #[test]
    fn covered_area_agrees_with_counting(
        rectangles in prop::collection::vec((0..6u8, 0..6u8, 1..4u8, 1..4u8, 0..4u8), 2..8),
        layered: bool,
        angle in 0.0..6.0f64,
    ) {
        let steps = |h: u8| if layered { h } else { 0 };
        let bounds: Vec<[u8; 5]> = rectangles.iter().map(|&(x, y, w, h, z)| [x, y, x + w, y + h, steps(z)]).collect();
        let mut distinct = bounds.clone();
        distinct.sort_unstable();
        distinct.dedup_by_key(|b| [b[0], b[1], b[2], b[3]]);
        // Exact copies are dropped at loading.
        prop_assume!(distinct.len() == bounds.len());
        let mut shapes = vec![([8., 8., 9., 9.], 0., "wall")];
        shapes.extend(bounds.iter().map(|b| ([b[0], b[1], b[2], b[3]].map(f64::from), layer(b[4]), "wall")));
        let scene = scene(&shapes, DQuat::from_rotation_y(angle));
        let overlaps = find_overlaps(&scene);
        let found = (2..scene.source_faces).map(|face| {
            scene.polygons.iter().enumerate().filter(|(_, p)| p.source_face == face)
                .all(|(i, _)| overlaps.is_covered(Facet { polygon: PolygonId::new(i), side: Side::Front }))
        });
        let mut double = 0;
        let mut owners: Vec<Vec<(u8, u8, u8)>> = Vec::new();
        for (k, (b, found)) in bounds.iter().zip(found).enumerate() {
            let cells: Vec<_> = (b[0]..b[2]).flat_map(|x| (b[1]..b[3]).map(move |y| (x, y, b[4]))).collect();
            let free = |&(x, y, z): &(u8, u8, u8)| {
                !owners.iter().flatten().any(|&(u, v, w)| (u, v) == (x, y) && w.abs_diff(z) < 2)
            };
            let owned: Vec<_> = cells.iter().copied().filter(free).collect();
            double += cells.len() - owned.len();
            prop_assert_eq!(owned.is_empty(), found, "rectangle {}", k);
            owners.push(owned);
        }
        // Area of wholly covered polygons, of which some may belong to faces covered in part.
        let area = |i: usize| scene.polygon_area(PolygonId::new(i));
        let all: f64 = (0..scene.polygons.len()).map(area).sum();
        let wholly: f64 = (0..scene.polygons.len())
            .filter(|&i| overlaps.is_covered(Facet { polygon: PolygonId::new(i), side: Side::Front }))
            .map(area)
            .sum();
        let units = scene.normalisation.scale.powi(2);
        let got = (wholly + overlaps.partly_covered_share * all) / units;
        prop_assert!((got - double as f64).abs() < 1e-3, "{} against {}", got, double);
    }
}

#[test]
fn a_large_plane_of_small_polygons_is_quick() {
    let n = 300;
    let mut obj = String::from("mtllib m.mtl\nusemtl lamp\n");
    for j in 0..=n {
        for i in 0..=n {
            writeln!(obj, "v {i} {j} 0").unwrap();
        }
    }
    for j in 0..n {
        for i in 0..n {
            let a = 1 + j * (n + 1) + i;
            writeln!(obj, "f {a} {} {} {}", a + 1, a + n + 2, a + n + 1).unwrap();
        }
    }
    let scene = load_text(
        "t.obj",
        obj.as_bytes(),
        &[("m.mtl", MATERIALS)],
        &LoadConfig::default(),
    )
    .unwrap();
    let start = std::time::Instant::now();
    let overlaps = find_overlaps(&scene);
    let elapsed = start.elapsed();
    println!("{} coplanar polygons: {elapsed:?}", scene.polygons.len());
    assert_eq!(
        (
            overlaps.covered_fronts,
            overlaps.partly_covered_fronts,
            overlaps.unchecked
        ),
        (0, 0, 0)
    );
    // A quadratic search would take minutes.
    assert!(elapsed.as_secs() < 20, "{elapsed:?}");
}
