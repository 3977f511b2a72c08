//! Plates, discs and spheres with known form factors.

use crate::case::{Case, check};
use certilux::reference::{
    coaxial_discs, concentric_spheres, parallel_rectangles, perpendicular_rectangles,
    two_infinite_plates,
};

#[test]
fn parallel_plates() {
    let got = Case::builtin("parallel-plates").form_factor("source", "receiver");
    check(
        "parallel plates",
        got,
        parallel_rectangles(1.0, 1.0, 1.0),
        0.005,
    );
}

#[test]
fn perpendicular_plates() {
    let got = Case::builtin("perpendicular-plates").form_factor("source", "receiver");
    let want = perpendicular_rectangles(1.0, 1.0, 1.0);
    check("perpendicular plates", got, want, 0.005);
}

#[test]
fn discs() {
    let got = Case::builtin("coaxial-discs").form_factor("source", "receiver");
    check("coaxial discs", got, coaxial_discs(1.0, 1.0, 1.0), 0.005);
}

#[test]
fn spheres() {
    let [there, back, own] = concentric_spheres(0.5, 1.0);
    let lit = |material| Case::builtin_lit_by("concentric-spheres", material);
    check(
        "spheres F_12",
        lit("inner").form_factor("inner", "outer"),
        there,
        0.005,
    );
    let outer = lit("outer");
    check(
        "spheres F_21",
        outer.form_factor("outer", "inner"),
        back,
        0.005,
    );
    check(
        "spheres F_22",
        outer.form_factor("outer", "outer"),
        own,
        0.005,
    );
}

#[test]
fn infinite_plates() {
    let case = Case::builtin("infinite-plates");
    let want = two_infinite_plates(1.0, 0.25, 0.5, 0.7);
    check(
        "infinite plates, lower",
        case.radiosity("lower_middle"),
        want,
        0.01,
    );
    let want = two_infinite_plates(0.25, 1.0, 0.7, 0.5);
    check(
        "infinite plates, upper",
        case.radiosity("upper_middle"),
        want,
        0.01,
    );
}
