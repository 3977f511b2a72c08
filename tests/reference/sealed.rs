//! Rooms shut off from all light are exactly black.

use crate::measured::Measured;

fn check_sealed(name: &str) {
    let measured = Measured::builtin(name, 0.2);
    let sealed = measured.faces("sealed_");
    let lit = measured.faces("lit_");
    assert!(sealed.len() > 50 && lit.len() > 50, "{name}");
    for face in sealed {
        assert_eq!(face.radiosity, [0.0; 3], "{name}, face {}", face.face);
        assert!(face.batches > 0);
    }
    assert!(lit.iter().filter(|f| f.radiosity[0] > 0.0).count() > 50);
}

#[test]
fn sealed_rooms() {
    check_sealed("sealed");
}

#[test]
fn a_room_behind_a_slab() {
    check_sealed("sealed-slab");
}
