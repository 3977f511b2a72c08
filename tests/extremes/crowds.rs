//! One polygon, a great many, and many that touch nothing.

use crate::agreement::{coarse, hold, prepare, prepare_text, solve_by};
use crate::mesh::{MTL, Mesh};
use certilux::math::hash_u64;
use certilux::solve::{PreparedScene, Stop, Technique};
use glam::DVec3;
use std::fmt::Write;
use std::time::Instant;

#[test]
fn one_polygon() {
    let lamp = Mesh::default().face("lamp", &[DVec3::ZERO, DVec3::X, DVec3::Y]);
    let prepared = prepare(&lamp);
    hold("one polygon", &prepared, &coarse());
    let power = solve_by(&prepared, Technique::Blockers, &coarse()).power;
    assert_eq!(
        (power.absorbed, power.unshot, power.escaped_stderr),
        (0.0, 0.0, 0.0)
    );
    assert!(
        (power.escaped / power.emitted - 1.0).abs() < 1.0e-9,
        "{power:?}"
    );
}

/// Specks of 1e-4 to 1e-3 of the room float in it, each alone.
#[test]
fn specks_that_touch_nothing() {
    let mut room = Mesh::room();
    let mut state = 1;
    let mut unit = move || {
        state = hash_u64(state);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut point = |size: f64| size * (2.0 * DVec3::new(unit(), unit(), unit()) - 1.0);
    for _ in 0..300 {
        let (at, a, b) = (point(0.8), point(2.0e-3), point(2.0e-3));
        room = room.face("red", &[at, at + a, at + b]);
    }
    let prepared = prepare(&room);
    let claims = hold("specks", &prepared, &coarse());
    assert!(claims.visible > 0);
    let power = solve_by(&prepared, Technique::Occlusion, &coarse()).power;
    println!("specks: {power:?}");
    assert!(power.imbalance.abs() < 0.01);
}

/// A plane of a million triangles under a lamp, as one row of squares after the other.
fn plane(side: usize) -> String {
    let mut obj = String::from("mtllib m.mtl\n");
    for y in 0..=side {
        for x in 0..=side {
            writeln!(obj, "v {x} 0 {y}").unwrap();
        }
    }
    let half = side as f64 / 2.0;
    for (x, z) in [(-1., -1.), (1., -1.), (1., 1.), (-1., 1.)] {
        writeln!(
            obj,
            "v {} {half} {}",
            half + x * half / 5.0,
            half + z * half / 5.0
        )
        .unwrap();
    }
    obj.push_str("usemtl lamp\nf -4 -3 -2 -1\nusemtl wall\n");
    for y in 0..side {
        for x in 0..side {
            let a = y * (side + 1) + x + 1;
            let b = a + side + 1;
            writeln!(obj, "f {a} {b} {} {}", b + 1, a + 1).unwrap();
        }
    }
    obj
}

fn check_plane(side: usize) -> PreparedScene {
    let obj = plane(side);
    let start = Instant::now();
    let prepared = prepare_text(&obj, "m.mtl", MTL);
    assert_eq!(prepared.scene.polygons.len(), 2 * side * side + 2);
    println!(
        "{} polygons: ready after {:.1} s",
        prepared.scene.polygons.len(),
        start.elapsed().as_secs_f64()
    );
    let mut config = coarse();
    config.stop = Stop::Passes(1);
    let start = Instant::now();
    let solved = solve_by(&prepared, Technique::Occlusion, &config);
    println!(
        "solved in {:.1} s: {:?}, {:?}",
        start.elapsed().as_secs_f64(),
        solved.passes[0],
        solved.power
    );
    assert!(solved.power.imbalance.abs() < 0.01, "{:?}", solved.power);
    prepared
}

#[test]
fn ten_thousand_coplanar_polygons() {
    // No part of the plane is in another's way.
    let claims = hold("a plane", &check_plane(71), &coarse());
    assert!(claims.visible > 0);
}

#[test]
#[ignore = "takes a minute and a gigabyte"]
fn a_million_coplanar_polygons() {
    check_plane(708);
}
