//! Sofas and armchairs.

use super::super::blocks::Blocks;
use super::super::material::Material;
use super::super::mesh::Mesh;

/// Width of an arm in metres.
const ARM: f64 = 0.16;
/// Tag of the feet.
const FEET: u16 = 1;

/// A sofa for `seats` people, 0.65 m a seat; `seats = 1` is an armchair. 0.9 m deep.
pub fn sofa(seats: usize, cell: f64, cloth: Material, wood: Material) -> Mesh {
    let width = 0.65 * seats as f64 + 2.0 * ARM;
    let x = width / 2.0;
    let mut blocks = Blocks::empty().with_cell_size(cell);
    blocks.add([-x, -0.45, 0.0], [-x + ARM, 0.45, 0.10], FEET);
    blocks.add([x - ARM, -0.45, 0.0], [x, 0.45, 0.10], FEET);
    blocks.add([-x, -0.45, 0.10], [x, 0.45, 0.30], 0);
    blocks.add([-x, -0.45, 0.30], [-x + ARM, 0.45, 0.62], 0);
    blocks.add([x - ARM, -0.45, 0.30], [x, 0.45, 0.62], 0);
    blocks.add([-x, 0.20, 0.30], [x, 0.45, 0.85], 0);
    for seat in 0..seats {
        let left = -x + ARM + 0.65 * seat as f64;
        // A finger's breadth between one cushion and the next.
        let right = left + if seat + 1 < seats { 0.63 } else { 0.65 };
        blocks.add([left, -0.43, 0.30], [right, 0.20, 0.45], 0);
    }
    blocks.mesh(|face| if face.solid == FEET { wood } else { cloth })
}
