//! Beds.

use super::super::blocks::Blocks;
use super::super::material::Material;
use super::super::mesh::Mesh;

const FRAME: u16 = 0;
const BLANKET: u16 = 1;
const LINEN: u16 = 2;

/// A bed `width` wide and 2.1 m long, its head towards +y.
pub fn bed(width: f64, cell: f64, wood: Material, blanket: Material, linen: Material) -> Mesh {
    let x = width / 2.0;
    let inset = x - 0.04;
    let mut blocks = Blocks::empty().with_cell_size(cell);
    for left in [-x, x - 0.08] {
        blocks.add([left, -1.05, 0.0], [left + 0.08, -0.97, 0.18], FRAME);
    }
    blocks.add([-x, 0.97, 0.0], [x, 1.05, 0.95], FRAME);
    blocks.add([-x, -1.05, 0.18], [x, 0.97, 0.30], FRAME);
    blocks.add([-inset, -0.97, 0.30], [inset, 0.45, 0.50], BLANKET);
    blocks.add([-inset, 0.45, 0.30], [inset, 0.97, 0.48], LINEN);
    let pillows = if width > 1.2 { 2 } else { 1 };
    for pillow in 0..pillows {
        let share = 2.0 * inset / f64::from(pillows);
        let left = -inset + share * f64::from(pillow) + 0.06;
        blocks.add([left, 0.53, 0.48], [left + share - 0.12, 0.91, 0.58], LINEN);
    }
    blocks.mesh(|face| match face.solid {
        BLANKET => blanket,
        LINEN => linen,
        _ => wood,
    })
}
