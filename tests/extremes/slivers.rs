//! Slivers: triangles up to 1e7 times as long as they are wide.

use crate::agreement::{coarse, faces, hold, prepare, solve_by};
use crate::mesh::{Facing, Mesh};
use certilux::scene::Side;
use certilux::solve::{Stop, Technique};
use glam::DVec3;

/// Relative difference of the light on everything else when a floor is cut into slivers instead of two triangles.
const TOLERANCE: f64 = 0.01;

/// The room without its floor, under a floor cut along x into a strip of `width` between two halves.
fn room_over(floor: Mesh) -> Mesh {
    let shell = [
        // Ceiling, then walls.
        [[-1., 1., -1.], [2., 0., 0.], [0., 0., 2.]],
        [[-1., -1., -1.], [2., 0., 0.], [0., 2., 0.]],
        [[-1., -1., 1.], [0., 2., 0.], [2., 0., 0.]],
        [[-1., -1., -1.], [0., 2., 0.], [0., 0., 2.]],
        [[1., -1., -1.], [0., 0., 2.], [0., 2., 0.]],
    ];
    let mut mesh = Mesh::default();
    for corners in shell {
        mesh = mesh.sheet("wall", corners.map(DVec3::from_array), [1, 1]);
    }
    mesh.lamp(DVec3::new(0.0, 0.875, 0.0), 0.25).with(floor)
}

/// The floor in two halves with strips of every given width between them.
fn floor_with(widths: &[f64]) -> Mesh {
    let at = |z: f64, depth: f64| {
        [
            DVec3::new(-1.0, -1.0, z),
            DVec3::new(0.0, 0.0, depth),
            DVec3::new(2.0, 0.0, 0.0),
        ]
    };
    let mut z = 0.0;
    let mut floor = Mesh::default().sheet("wall", at(-1.0, 1.0), [1, 1]);
    for &width in widths {
        floor = floor.sheet("wall", at(z, width), [1, 1]);
        z += width;
    }
    floor.sheet("wall", at(z, 1.0 - z), [1, 1])
}

const ASPECTS: [f64; 7] = [1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7];

#[test]
fn a_floor_of_slivers_is_a_floor() {
    let widths = ASPECTS.map(|aspect| 2.0 / aspect);
    let mut config = coarse();
    config.stop = Stop::Passes(3);
    let plain = prepare(&room_over(floor_with(&[])));
    let slivers = prepare(&room_over(floor_with(&widths)));
    assert!(slivers.scene.polygons.len() > plain.scene.polygons.len());
    let light = |prepared| {
        let solved = solve_by(prepared, Technique::Occlusion, &config);
        assert!(
            solved.power.escaped < 1.0e-3 * solved.power.emitted,
            "{:?}",
            solved.power
        );
        let faces = faces(prepared, &solved);
        // Ceiling and walls: the first five faces.
        (0..5)
            .map(|f| faces[&(f, Side::Front)].irradiance[0] / faces[&(f, Side::Front)].area)
            .collect::<Vec<_>>()
    };
    for (a, b) in light(&plain).into_iter().zip(light(&slivers)) {
        println!("irradiance {a:.5} over a plain floor, {b:.5} over one with slivers");
        assert!((b / a - 1.0).abs() < TOLERANCE);
    }
    hold("a floor with slivers", &slivers, &coarse());
}

#[test]
fn fans_and_splinters() {
    // A wall across the room as a fan of slivers from one corner, and splinters that lie about.
    let mut fan = Mesh::room();
    let apex = DVec3::new(-1.0, -1.0, 0.1);
    for i in 0..40 {
        let at = |k: i32| DVec3::new(1.0, -1.0 + f64::from(k) * 0.02, 0.1);
        fan = fan.face("wall", &[apex, at(i), at(i + 1)]);
    }
    for (i, aspect) in ASPECTS.into_iter().enumerate() {
        let y = 0.1 * i as f64 - 0.5;
        let corners = [
            DVec3::new(-0.7, y, -0.6),
            DVec3::new(0.5, y + 0.2, -0.3),
            DVec3::new(0.0, y + 0.1 + 1.2 / aspect, -0.45),
        ];
        fan = fan.face("red", &corners);
    }
    hold("a fan and splinters", &prepare(&fan), &coarse());
}

#[test]
fn a_box_as_thin_as_a_sheet() {
    for thickness in [1e-2, 1e-4, 1e-6, 1e-7] {
        let min = DVec3::new(-1.0, -1.0, -0.5 * thickness);
        let wall = Mesh::room().cuboid(
            "wall",
            min,
            DVec3::new(1.0, 0.3, 0.5 * thickness),
            Facing::Outwards,
        );
        let claims = hold(
            &format!("a wall {thickness:e} thick"),
            &prepare(&wall),
            &coarse(),
        );
        assert!(claims.visible > 0);
    }
}
