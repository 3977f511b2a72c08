//! Unequal plates solved each way: A_i F_ij = A_j F_ji, and what stands between never adds light.

use crate::case::{Case, check};
use certilux::reference::perpendicular_rectangles;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// An OBJ of quads, each with its material.
fn quads(faces: &[(&str, [[f64; 3]; 4])]) -> String {
    let mut obj = String::from("mtllib plates.mtl\n");
    for (material, corners) in faces {
        for [x, y, z] in corners {
            obj += &format!("v {x} {y} {z}\n");
        }
        obj += &format!("usemtl {material}\nf -4 -3 -2 -1\n");
    }
    obj
}

fn solve_lit_by(faces: &[(&str, [[f64; 3]; 4])], lit: &str) -> Case {
    let mut mtl = String::new();
    for name in ["first", "second", "block"] {
        let emission = if name == lit { 1.0 / PI } else { 0.0 };
        mtl += &format!("newmtl {name}\nKd 0 0 0\nKe {emission} {emission} {emission}\n");
    }
    Case::from_text(&quads(faces), &mtl, "plates.mtl")
}

/// A level plate facing up, 2 x 1.
const FLOOR: [[f64; 3]; 4] = [[0., 0., 0.], [2., 0., 0.], [2., 1., 0.], [0., 1., 0.]];
/// A wall along its far edge at y = 1, 2 x 0.5, facing -y.
const WALL: [[f64; 3]; 4] = [[0., 1., 0.], [2., 1., 0.], [2., 1., 0.5], [0., 1., 0.5]];
/// A smaller plate above, 0.8 x 0.5, facing down.
const LID: [[f64; 3]; 4] = [
    [0.3, 0.2, 0.6],
    [0.3, 0.7, 0.6],
    [1.1, 0.7, 0.6],
    [1.1, 0.2, 0.6],
];
/// A plate between floor and lid, seen from both.
const BLOCK: [[f64; 3]; 4] = [
    [0.5, 0.1, 0.3],
    [0.9, 0.1, 0.3],
    [0.9, 0.6, 0.3],
    [0.5, 0.6, 0.3],
];

/// Areas times form factors, from the first plate to the second and back.
fn both_ways(second: [[f64; 3]; 4]) -> [f64; 2] {
    let faces = [("first", FLOOR), ("second", second)];
    [("first", "second"), ("second", "first")].map(|(from, to)| {
        let received = solve_lit_by(&faces, from).received(to);
        assert!(received > 0.0);
        received
    })
}

#[test]
fn perpendicular_plates_are_reciprocal() {
    let [there, back] = both_ways(WALL);
    let exact = 2.0 * perpendicular_rectangles(2.0, 1.0, 0.5);
    check("perpendicular 2x1 to 2x0.5, A1 F12", there, exact, 0.005);
    check("perpendicular 2x0.5 to 2x1, A2 F21", back, exact, 0.005);
    check("perpendicular A1 F12 / A2 F21", there / back, 1.0, 0.005);
}

#[test]
fn parallel_plates_are_reciprocal() {
    let [there, back] = both_ways(LID);
    check("parallel unequal A1 F12 / A2 F21", there / back, 1.0, 0.005);
}

#[test]
fn an_obstacle_never_adds_light() {
    let clear = [("first", FLOOR), ("second", LID), ("second", WALL)];
    let blocked = [clear[0], clear[1], clear[2], ("block", BLOCK)];
    let by_face = |faces: &[(&str, [[f64; 3]; 4])]| {
        let mut sums: BTreeMap<u32, f64> = BTreeMap::new();
        let case = solve_lit_by(faces, "first");
        for patch in case.patches().iter().filter(|p| p.material == "second") {
            *sums.entry(patch.face).or_default() += patch.area * patch.irradiance;
        }
        sums
    };
    let (open, shaded) = (by_face(&clear), by_face(&blocked));
    assert_eq!(open.len(), 2);
    for (face, unobstructed) in &open {
        let ratio = shaded[face] / unobstructed;
        eprintln!("face {face}: obstructed / unobstructed = {ratio:.5}");
        // The two solves have different patches: the tolerance of a form factor.
        assert!(ratio <= 1.005, "face {face}: {ratio}");
    }
    assert!(shaded[&1] < 0.8 * open[&1], "the lid is in shadow");
}
