//! Cupboards, wardrobes and kitchen counters.

use super::super::blocks::Blocks;
use super::super::material::Material;
use super::super::mesh::Mesh;

/// Height of the recessed plinth in metres.
const PLINTH: f64 = 0.08;
/// How far doors stand out, and the gaps around and between them, in metres.
const DOOR: f64 = 0.02;

/// A cupboard of `width` by `depth` by `height` with `doors` doors side by side.
pub fn cupboard(
    [width, depth, height]: [f64; 3],
    doors: usize,
    cell: f64,
    body: Material,
    front: Material,
) -> Mesh {
    let (x, y) = (width / 2.0, depth / 2.0);
    let face = -y + DOOR;
    let mut blocks = Blocks::empty().with_cell_size(cell);
    blocks.add([-x, face, PLINTH], [x, y, height], 0);
    blocks.add([-x, face + 0.04, 0.0], [x, y, PLINTH], 0);
    for door in 0..doors {
        let share = (width - DOOR) / doors as f64;
        let left = -x + DOOR + share * door as f64;
        let right = left + share - DOOR;
        blocks.add([left, -y, PLINTH + DOOR], [right, face, height - DOOR], 1);
    }
    blocks.mesh(|f| if f.solid == 1 { front } else { body })
}

/// A kitchen counter `width` wide, 0.6 m deep, with a sunk basin and a worktop that overhangs.
pub fn counter(width: f64, cell: f64, body: Material, top: Material) -> Mesh {
    let x = width / 2.0;
    let mut blocks = Blocks::empty().with_cell_size(cell);
    blocks.add([-x, -0.22, 0.0], [x, 0.30, 0.10], 0);
    blocks.add([-x, -0.27, 0.10], [x, 0.30, 0.86], 0);
    blocks.add([-x, -0.30, 0.86], [x, 0.30, 0.90], 1);
    let basin = x - 0.70;
    blocks.carve([basin, -0.17, 0.72], [basin + 0.50, 0.20, 0.90], 1);
    blocks.mesh(|f| {
        if f.solid == 1 || f.air == 1 {
            top
        } else {
            body
        }
    })
}

/// A bath `length` long (x) and 0.75 m wide, hollow.
pub fn bath(length: f64, cell: f64, enamel: Material) -> Mesh {
    let x = length / 2.0;
    let mut blocks = Blocks::empty().with_cell_size(cell);
    blocks.add([-x, -0.375, 0.0], [x, 0.375, 0.56], 0);
    blocks.carve([-x + 0.08, -0.295, 0.14], [x - 0.08, 0.295, 0.56], 1);
    blocks.mesh(|_| enamel)
}
