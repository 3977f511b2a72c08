//! A scene stands along its own axes, however its file turns it.

use certilux::scene::generate::generate;
use certilux::scene::{Axes, LoadConfig, Scene, load_text};
use glam::{DMat3, DQuat, DVec3, Vec3};
use std::fmt::Write;

const MTL: &str = "newmtl m\nKd 0.5 0.5 0.5\nKe 1 1 1\n";

fn load(obj: &str, mtl: &str, axes: Axes) -> Scene {
    let mut config = LoadConfig::default();
    config.axes = axes;
    // Whatever name the file gives its library.
    let library = (obj.lines())
        .find_map(|line| line.strip_prefix("mtllib "))
        .expect("a library");
    load_text(
        "test",
        obj.as_bytes(),
        &[(library, mtl.as_bytes())],
        &config,
    )
    .expect("loads")
}

/// The file with every vertex mapped, all digits written.
fn mapped(obj: &str, map: impl Fn(DVec3) -> DVec3) -> String {
    let mut out = String::new();
    for line in obj.lines() {
        match line.strip_prefix("v ") {
            Some(rest) => {
                let c: Vec<f64> = (rest.split_whitespace().map(|w| w.parse().unwrap())).collect();
                let p = map(DVec3::from_slice(&c));
                writeln!(out, "v {:?} {:?} {:?}", p.x, p.y, p.z).unwrap();
            }
            None => writeln!(out, "{line}").unwrap(),
        }
    }
    out
}

/// A file of quadrilaterals given by a corner and two edges.
fn sheets(list: &[[DVec3; 3]]) -> String {
    let mut obj = String::from("mtllib m.mtl\nusemtl m\n");
    for &[p, u, v] in list {
        for q in [p, p + u, p + u + v, p + v] {
            writeln!(obj, "v {:?} {:?} {:?}", q.x, q.y, q.z).unwrap();
        }
        obj.push_str("f -4 -3 -2 -1\n");
    }
    obj
}

/// The faces of a box.
fn block(centre: DVec3, half: DVec3, turn: DQuat) -> Vec<[DVec3; 3]> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    (0..3)
        .flat_map(|k| [(k, -1.0), (k, 1.0)])
        .map(|(k, side)| {
            let [out, u, v] = [0, 1, 2].map(|j| axes[(k + j) % 3] * half);
            [side * out - u - v, 2.0 * u, 2.0 * v]
        })
        .map(|[p, u, v]| [centre + turn * p, turn * u, turn * v])
        .collect()
}

/// Furthest that vertices lie apart, in normalised units.
fn apart(a: &Scene, b: &Scene) -> f32 {
    assert_eq!(a.positions.len(), b.positions.len());
    (a.positions.iter().zip(&b.positions))
        .map(|(a, b)| (*a - *b).abs().max_element())
        .fold(0.0, f32::max)
}

/// One step of f32 at the border of the unit cube.
const STEP: f32 = 1.0 / (1u32 << 25) as f32;

#[test]
fn a_building_lies_the_same_way_however_it_is_turned() {
    for name in ["d", "two-rooms", "corridor"] {
        let text = generate(name).expect("a built-in scene");
        let as_is = load(&text.obj, &text.mtl, Axes::Scene);
        let size = 1.0 / as_is.normalisation.scale;
        for (k, (axis, degrees, step)) in [
            (DVec3::Y, 30.0f64, DVec3::ZERO),
            (DVec3::Y, 90.0, DVec3::ZERO),
            (DVec3::X, 90.0, DVec3::new(5.0, -3.0, 8.0)),
            (DVec3::new(0.48, 0.6, 0.64), 0.02, DVec3::ZERO),
            (DVec3::new(0.48, 0.6, 0.64), 137.0, DVec3::splat(1.0e3)),
            (DVec3::new(-0.48, 0.6, 0.64), 201.0, DVec3::ZERO),
            (
                DVec3::new(-0.6, 0.0, 0.8),
                45.0,
                DVec3::new(1.0e5, 0.0, -1.0e5),
            ),
        ]
        .into_iter()
        .enumerate()
        {
            let turn = DQuat::from_axis_angle(axis, degrees.to_radians());
            let obj = mapped(&text.obj, |p| turn * (p + step * size));
            let there = load(&obj, &text.mtl, Axes::Scene);
            assert_eq!(as_is.polygons, there.polygons, "{name}, {k}");
            // Rotations by right angles only exchange the axes; the others keep their angle, up to those.
            if axis.max_element() == 1.0 || degrees < 45.0 {
                let askew = there.normalisation.degrees_askew();
                assert!(
                    (askew - degrees % 90.0).abs() < 1.0e-4,
                    "{name}, {k}: {askew}"
                );
            }
            let apart = apart(&as_is, &there);
            assert!(apart <= STEP, "{name}, {k}: {apart:e}");
        }
    }
}

#[test]
fn walls_along_the_axes_keep_every_digit() {
    for name in ["a", "cornell", "two-rooms"] {
        let text = generate(name).expect("a built-in scene");
        let [own, file] = [Axes::Scene, Axes::File].map(|axes| load(&text.obj, &text.mtl, axes));
        let turn = own.normalisation.turn;
        assert_eq!(turn.determinant(), 1.0, "{name}");
        for entry in turn.to_cols_array() {
            assert!([0.0, 1.0].contains(&entry.abs()), "{name}: {turn}");
        }
        assert_eq!(file.normalisation.turn, DMat3::IDENTITY);
        for (a, b) in own.positions.iter().zip(&file.positions) {
            assert_eq!(a.as_dvec3(), turn * b.as_dvec3(), "{name}");
        }
    }
}

#[test]
fn points_and_directions_find_back_to_the_file() {
    let text = generate("d").expect("a built-in scene");
    let turn = DQuat::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), 0.7);
    let scene = load(&mapped(&text.obj, |p| turn * p), &text.mtl, Axes::Scene);
    let map = &scene.normalisation;
    for (&normalised, &file) in scene.positions.iter().zip(&scene.source_positions) {
        let size = 1.0 / map.scale;
        assert!(map.to_file(normalised.as_dvec3()).distance(file) <= 1.0e-7 * size);
        assert!(map.place(file).distance(normalised.as_dvec3()) <= 1.0e-7);
    }
    let [a, b] = [0, 1].map(|k| scene.positions[k]);
    let [there_a, there_b] = [0, 1].map(|k| scene.source_positions[k].as_vec3());
    let along = map.direction_to_file((b - a).normalize());
    assert!(along.distance((there_b - there_a).normalize()) <= 1.0e-5);
}

#[test]
fn the_wing_with_more_area_decides() {
    let turn = DQuat::from_rotation_y(0.5);
    let wings = |turned: f64| {
        let mut all = block(DVec3::ZERO, DVec3::new(4.0, 1.0, 2.0), DQuat::IDENTITY);
        all.extend(block(
            DVec3::new(9.0, 0.0, 0.0),
            DVec3::new(4.0, 1.0, 2.0) * turned,
            turn,
        ));
        load(&sheets(&all), MTL, Axes::Scene)
    };
    let as_read = wings(0.9).normalisation.turn;
    assert!(
        as_read
            .to_cols_array()
            .iter()
            .all(|x| [0.0, 1.0].contains(&x.abs()))
    );
    // A wall of the second wing runs along an axis.
    let along = wings(1.1).normalisation.turn * (turn * DVec3::X);
    assert!((along.abs().max_element() - 1.0).abs() < 1.0e-12, "{along}");
}

#[test]
fn what_has_no_walls_is_left_as_it_is() {
    let text = generate("concentric-spheres").expect("a built-in scene");
    let turn = DQuat::from_rotation_y(0.3);
    let scene = load(&mapped(&text.obj, |p| turn * p), &text.mtl, Axes::Scene);
    assert_eq!(scene.normalisation.turn, DMat3::IDENTITY);
    let one = load(
        &sheets(&[[DVec3::ZERO, DVec3::new(1.0, 0.2, 0.0), DVec3::Z]]),
        MTL,
        Axes::Scene,
    );
    assert_eq!(one.normalisation.turn, DMat3::IDENTITY);
}

#[test]
fn a_tilted_table_does_not_tilt_the_room() {
    let turn = DQuat::from_rotation_y(0.5);
    // Within the angle at which candidates are collected, but more than rounding.
    let tilt = turn * DQuat::from_rotation_z(4.0e-4);
    let mut all = block(DVec3::ZERO, DVec3::new(4.0, 1.5, 3.0), turn);
    all.extend(block(
        DVec3::new(0.5, -1.0, 0.5),
        DVec3::new(1.0, 0.05, 0.6),
        tilt,
    ));
    let scene = load(&sheets(&all), MTL, Axes::Scene);
    let walls: Vec<Vec3> = scene.positions[..24].to_vec();
    let least = walls.iter().fold(Vec3::INFINITY, |a, &b| a.min(b));
    let greatest = walls.iter().fold(Vec3::NEG_INFINITY, |a, &b| a.max(b));
    for p in walls {
        let off = (p - least).abs().min((p - greatest).abs()).max_element();
        assert!(off <= STEP, "{p} is {off:e} off a wall");
    }
}

/// A hall whose floor is level and whose long walls lean apart: what is exact decides, not what roughly agrees.
#[test]
fn leaning_walls_do_not_tilt_a_level_floor() {
    for lean in [2.0e-5, 3.0e-4, 9.0e-4] {
        let mut all = block(DVec3::ZERO, DVec3::new(6.0, 2.0, 4.0), DQuat::IDENTITY);
        // All but the two long walls.
        all.truncate(4);
        for (z, sense) in [(-4.0, 1.0), (4.0, -0.6)] {
            let up = DVec3::new(0.0, 4.0, 4.0 * lean * sense);
            all.push([DVec3::new(-6.0, -2.0, z), DVec3::new(12.0, 0.0, 0.0), up]);
        }
        let turn = load(&sheets(&all), MTL, Axes::Scene).normalisation.turn;
        let entries = turn.to_cols_array();
        assert!(
            entries.iter().all(|x| [0.0, 1.0].contains(&x.abs())),
            "{lean}: {turn}"
        );
    }
}

#[test]
fn what_is_hardly_askew_is_turned_too() {
    let text = generate("two-rooms").expect("a built-in scene");
    let as_is = load(&text.obj, &text.mtl, Axes::Scene);
    for angle in [1.0e-7, 9.0e-7, 1.0e-5, 5.0e-4] {
        let turn = DQuat::from_axis_angle(DVec3::new(0.48, 0.6, 0.64), angle);
        let there = load(&mapped(&text.obj, |p| turn * p), &text.mtl, Axes::Scene);
        let apart = apart(&as_is, &there);
        assert!(apart <= STEP, "{angle:e}: {apart:e}");
    }
}
