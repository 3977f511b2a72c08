//! White furnaces: the radiosity of every point is E0 / (1 - rho), whatever stands inside.

use crate::measured::{Measured, z_test};
use std::f64::consts::PI;

fn check_furnace(name: &str, rho: f64, error: f64) {
    let scene = format!("{name}-{rho}");
    let measured = Measured::builtin(&scene, error);
    z_test(&scene, measured.mean("furnace"), PI / (1.0 - rho), 0.005);
}

#[test]
fn empty_boxes() {
    for (rho, error) in [(0.2, 0.02), (0.5, 0.02), (0.8, 0.03), (0.95, 0.06)] {
        check_furnace("furnace", rho, error);
    }
}

#[test]
fn with_something_inside() {
    for name in ["blocks", "partitions", "tjunctions", "sphere"] {
        check_furnace(&format!("furnace-{name}"), 0.5, 0.04);
    }
}

#[test]
fn nearly_white() {
    check_furnace("furnace", 0.99, 0.06);
}
