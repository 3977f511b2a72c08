//! Plates, discs and spheres with known form factors. The receivers reflect half of what they get, and see no
//! light of their own where nothing else is said.

use crate::measured::{Measured, z_test};
use certilux::reference::{
    coaxial_discs, concentric_spheres, parallel_rectangles, perpendicular_rectangles,
    two_infinite_plates,
};

const RHO: f64 = 0.5;

/// Radiosity of the receiver over its reflectance: the form factor from the equally large source.
fn form_factor(name: &str, error: f64) -> (f64, f64) {
    let scene = Measured::with_materials(name, &[("receiver", RHO, 0.0)], error);
    let (radiosity, stderr) = scene.mean("receiver");
    (radiosity / RHO, stderr / RHO)
}

#[test]
fn parallel_plates() {
    let want = parallel_rectangles(1.0, 1.0, 1.0);
    z_test(
        "parallel plates",
        form_factor("parallel-plates", 0.002),
        want,
        1e-3,
    );
}

#[test]
fn perpendicular_plates() {
    let want = perpendicular_rectangles(1.0, 1.0, 1.0);
    let got = form_factor("perpendicular-plates", 0.004);
    z_test("perpendicular plates", got, want, 1e-3);
}

#[test]
fn discs() {
    // The discs are 96-gons of the same area: what that changes is far below the error bar.
    let want = coaxial_discs(1.0, 1.0, 1.0);
    z_test(
        "coaxial discs",
        form_factor("coaxial-discs", 0.02),
        want,
        2e-3,
    );
}

#[test]
fn spheres() {
    let [there, back, own] = concentric_spheres(0.5, 1.0);
    let name = "concentric-spheres";
    let lit = [("inner", RHO, 0.0), ("outer", 0.0, 1.0)];
    let (radiosity, stderr) = Measured::with_materials(name, &lit, 0.05).mean("inner");
    z_test("spheres F_12", (radiosity / RHO, stderr / RHO), there, 2e-3);
    // What the outer reflects comes back to it in part.
    let lit = [("inner", 0.0, 1.0), ("outer", RHO, 0.0)];
    let (radiosity, stderr) = Measured::with_materials(name, &lit, 0.05).mean("outer");
    let want = back / (1.0 - RHO * own);
    z_test(
        "spheres F_21, F_22",
        (radiosity / RHO, stderr / RHO),
        want,
        2e-3,
    );
}

#[test]
fn infinite_plates() {
    let scene = Measured::builtin("infinite-plates", 0.005);
    let want = two_infinite_plates(1.0, 0.25, 0.5, 0.7);
    z_test(
        "infinite plates, lower",
        scene.mean("lower_middle"),
        want,
        0.005,
    );
    let want = two_infinite_plates(0.25, 1.0, 0.7, 0.5);
    z_test(
        "infinite plates, upper",
        scene.mean("upper_middle"),
        want,
        0.005,
    );
}
