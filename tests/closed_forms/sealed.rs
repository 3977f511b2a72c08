//! Rooms shut off from all light stay exactly black.

use crate::case::Case;

fn check_sealed(name: &str) {
    let case = Case::builtin(name);
    let patches = case.patches();
    let sealed = patches.iter().filter(|p| p.material.starts_with("sealed_"));
    let lit = patches
        .iter()
        .filter(|p| p.material.starts_with("lit_") && p.irradiance > 0.0);
    let leaks = sealed.clone().filter(|p| p.irradiance != 0.0).count();
    let worst = sealed.clone().map(|p| p.irradiance).fold(0.0, f64::max);
    let total = sealed.count();
    eprintln!(
        "{name:<28} sealed patches {total}, not black {leaks}, greatest {worst:e} W/m2; lit patches {}",
        lit.clone().count()
    );
    assert!(total > 50 && lit.count() > 50, "{name}: too few patches");
    assert_eq!(leaks, 0, "{name}");
}

#[test]
fn sealed_rooms_are_black() {
    check_sealed("sealed");
}

#[test]
fn a_room_behind_a_slab_is_black() {
    check_sealed("sealed-slab");
}
