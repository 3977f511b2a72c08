//! Polygons that lie on one another: the light is that of the scene in which the owner stands alone.

use crate::measured::{Measured, z_test};
use certilux::reference::parallel_rectangles;

const MTL: &str = "newmtl lamp\nKd 0 0 0\nKe 0.3183098861837907 0.3183098861837907 0.3183098861837907\n\
                   newmtl wall\nKd 0.5 0.5 0.5\nnewmtl dark\nKd 0.25 0.25 0.25\n";

/// A unit square at height `y`, facing up or down.
fn square(y: f64, up: bool, material: &str) -> String {
    let order = if up { "-1 -2 -3 -4" } else { "-4 -3 -2 -1" };
    format!("usemtl {material}\nv 0 {y} 0\nv 1 {y} 0\nv 1 {y} 1\nv 0 {y} 1\nf {order}\n")
}

fn measured(faces: &[String]) -> Measured {
    let obj = format!("mtllib m.mtl\n{}", faces.concat());
    Measured::from_text(&obj, "m.mtl", MTL, 0.004)
}

#[test]
fn back_to_back_sheets_are_both_lit() {
    // Two sheets in one place, each with a lamp before it: half of the nearest hits are of the wrong one.
    let scene = measured(&[
        square(0.0, true, "lamp"),
        square(1.0, false, "wall"),
        square(1.0, true, "dark"),
        square(2.0, false, "lamp"),
    ]);
    let factor = parallel_rectangles(1.0, 1.0, 1.0);
    z_test("sheet below", scene.mean("wall"), 0.5 * factor, 0.005);
    z_test("sheet above", scene.mean("dark"), 0.25 * factor, 0.005);
    let faces: Vec<u32> = scene.reference.faces.iter().map(|f| f.face).collect();
    assert_eq!(faces, [0, 1, 2, 3]);
}

#[test]
fn a_covered_face_is_not_in_the_file() {
    // A lamp set into a ceiling that it covers in two halves, and the floor twice, the second time as one with
    // another material: the lamp shines, the first owns the floor.
    let half = |x: f64| {
        format!(
            "usemtl lamp\nv {x} 1 0\nv {0} 1 0\nv {0} 1 1\nv {x} 1 1\nf -4 -3 -2 -1\n",
            x + 0.5
        )
    };
    let floor_half = |x: f64| {
        format!(
            "usemtl wall\nv {x} 0 0\nv {0} 0 0\nv {0} 0 1\nv {x} 0 1\nf -1 -2 -3 -4\n",
            x + 0.5
        )
    };
    let scene = measured(&[
        square(1.0, false, "dark"),
        half(0.0),
        half(0.5),
        floor_half(0.0),
        floor_half(0.5),
        square(0.0, true, "dark"),
    ]);
    let faces: Vec<u32> = scene.reference.faces.iter().map(|f| f.face).collect();
    assert_eq!(faces, [1, 2, 3, 4]);
    let factor = parallel_rectangles(1.0, 1.0, 1.0);
    z_test("floor", scene.mean("wall"), 0.5 * factor, 0.005);
}
