//! Lights of any strength and size.

use crate::agreement::{coarse, faces, hold, prepare, prepare_text, solve_by};
use crate::mesh::{Facing, MTL, Mesh};
use certilux::reference::point_to_parallel_rectangle;
use certilux::scene::Side;
use certilux::solve::{SolveConfig, Stop, Technique};
use glam::DVec3;
use std::f64::consts::PI;

/// Relative difference of a patch between emissions that differ by a factor: f32 keeps 24 bits.
const SAME: f64 = 1.0e-6;

/// Relative error of a form factor at default accuracy.
const FORM_FACTOR: f64 = 0.01;

#[test]
fn emission_from_1e_minus_30_to_1e30_scales_the_light_and_nothing_else() {
    let obj = Mesh::room()
        .cuboid(
            "red",
            DVec3::new(-0.5, -1.0, -0.4),
            DVec3::new(0.1, -0.2, 0.4),
            Facing::Outwards,
        )
        .obj();
    let solved = |ke: f64| {
        let mtl = MTL.replace("Ke 10 10 10", &format!("Ke {ke:e} {ke:e} {ke:e}"));
        let prepared = prepare_text(&obj, "m.mtl", &mtl);
        hold(&format!("Ke {ke:e}"), &prepared, &coarse());
        let mut config = coarse();
        config.stop = Stop::Passes(3);
        solve_by(&prepared, Technique::Blockers, &config)
    };
    let one = solved(1.0);
    for ke in [1.0e-30, 1.0e-7, 1.0e30] {
        let other = solved(ke);
        assert_eq!(
            one.solution.patches.len(),
            other.solution.patches.len(),
            "Ke {ke:e}"
        );
        for (a, b) in one.solution.patches.iter().zip(&other.solution.patches) {
            for (a, b) in a.radiosity.iter().zip(b.radiosity) {
                let (a, b) = (f64::from(*a), f64::from(b) / ke);
                assert!((a - b).abs() <= SAME * a, "Ke {ke:e}: {a} {b}");
            }
        }
        for (a, b) in one.passes.iter().zip(&other.passes) {
            assert_eq!(
                (a.exchanges, a.rays, a.shafts),
                (b.exchanges, b.rays, b.shafts)
            );
        }
        assert!((other.power.emitted / ke / one.power.emitted - 1.0).abs() < SAME);
    }
}

/// A lamp of 1 mm over the floor of a hall of 200 m x 200 m x 40 m.
#[test]
fn one_tiny_emitter_in_a_huge_hall() {
    let (half, height, lamp) = (100.0, 40.0, 0.0005);
    let hall = Mesh::default()
        .cuboid(
            "wall",
            DVec3::new(-half, 0.0, -half),
            DVec3::new(half, height, half),
            Facing::Inwards,
        )
        .lamp(DVec3::new(0.0, 30.0, 0.0), lamp);
    let prepared = prepare(&hall);
    hold("a tiny emitter", &prepared, &coarse());
    let mut config = coarse();
    config.epsilon = 1.0e-5;
    config.stop = Stop::Passes(1);
    let solved = solve_by(&prepared, Technique::Occlusion, &config);
    assert!(
        solved.power.imbalance.abs() < FORM_FACTOR,
        "{:?}",
        solved.power
    );
    // Power that the floor receives, over what the lamp emits: four rectangles with a corner below it.
    let light = faces(&prepared, &solved);
    let floor = light[&(2, Side::Front)].irradiance[0];
    let received = prepared.scene.normalisation.area_to_file(floor);
    let emitted = PI * 10.0 * 4.0 * lamp * lamp;
    let want = 4.0 * point_to_parallel_rectangle(half, half, 30.0);
    println!(
        "to the floor: {} of the light, {want} is right",
        received / emitted
    );
    assert!((received / emitted / want - 1.0).abs() < FORM_FACTOR);
}

/// A chip of 1 cm in a hall that emits everywhere receives on both sides what the hall emits.
#[test]
fn one_tiny_receiver_in_a_huge_emitter() {
    let mtl = "newmtl hall\nKd 0 0 0\nKe 1 1 1\nnewmtl chip\nKd 0.5 0.5 0.5\n";
    let hall = Mesh::default()
        .cuboid(
            "hall",
            DVec3::new(-100.0, 0.0, -100.0),
            DVec3::new(100.0, 40.0, 100.0),
            Facing::Inwards,
        )
        .sheet(
            "chip",
            [
                DVec3::new(3.0, 7.0, -11.0),
                DVec3::new(0.006, 0.008, 0.0),
                DVec3::new(0.0, 0.0, 0.01),
            ],
            [1, 1],
        );
    let prepared = prepare_text(&hall.obj(), "m.mtl", mtl);
    hold("a tiny receiver", &prepared, &coarse());
    let light = faces(
        &prepared,
        &solve_by(&prepared, Technique::Occlusion, &SolveConfig::default()),
    );
    for side in [Side::Front, Side::Back] {
        let chip = light.get(&(6, side)).expect("both sides are lit");
        let irradiance = chip.irradiance[0] / chip.area;
        println!("{side:?}: {irradiance}, {PI} is right");
        assert!((irradiance / PI - 1.0).abs() < FORM_FACTOR);
    }
}

/// What is too weak to matter to the scene may be dropped, but is counted as not shot.
#[test]
fn a_dim_lamp_beside_a_bright_one_is_in_the_ledger() {
    let mtl = "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\nnewmtl dim\nKd 0 0 0\nKe 1e-12 1e-12 1e-12\n";
    let dim = Mesh::default()
        .cuboid("wall", DVec3::NEG_ONE, DVec3::ONE, Facing::Inwards)
        .sheet(
            "dim",
            [
                DVec3::new(-0.25, 0.875, -0.25),
                DVec3::new(0.5, 0.0, 0.0),
                DVec3::new(0.0, 0.0, 0.5),
            ],
            [1, 1],
        )
        .mapped(|p| p + DVec3::new(10.0, 0.0, 0.0));
    let prepared = prepare_text(&Mesh::room().with(dim).obj(), "m.mtl", mtl);
    hold("a bright and a dim lamp", &prepared, &coarse());
    let power = solve_by(&prepared, Technique::Occlusion, &coarse()).power;
    assert!(power.unshot / power.emitted < 2.0e-3, "{power:?}");
    assert!(power.imbalance.abs() < FORM_FACTOR, "{power:?}");
}
