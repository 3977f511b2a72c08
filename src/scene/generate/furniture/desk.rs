//! Writing desks.

use super::super::blocks::Blocks;
use super::super::material::Material;
use super::super::mesh::Mesh;

const WOOD: u16 = 0;
const DRAWERS: u16 = 1;
const MONITOR: u16 = 2;

/// A desk `width` wide and 0.7 m deep, drawers on the right, a monitor on top; whoever sits at it
/// looks towards +y.
pub fn desk(width: f64, cell: f64, wood: Material, metal: Material, dark: Material) -> Mesh {
    let x = width / 2.0;
    let mut blocks = Blocks::empty().with_cell_size(cell);
    blocks.add([-x, -0.35, 0.70], [x, 0.35, 0.74], WOOD);
    blocks.add([-x, -0.35, 0.0], [-x + 0.04, 0.35, 0.70], WOOD);
    blocks.add([x - 0.04, -0.35, 0.0], [x, 0.35, 0.70], WOOD);
    blocks.add([-x + 0.04, 0.25, 0.30], [x - 0.04, 0.29, 0.70], WOOD);
    blocks.add([x - 0.44, -0.31, 0.10], [x - 0.04, 0.25, 0.70], DRAWERS);
    blocks.add([-0.10, 0.13, 0.74], [0.10, 0.25, 0.76], MONITOR);
    blocks.add([-0.03, 0.17, 0.76], [0.03, 0.21, 0.86], MONITOR);
    blocks.add([-0.26, 0.17, 0.86], [0.26, 0.21, 1.18], MONITOR);
    blocks.mesh(|face| match face.solid {
        DRAWERS => metal,
        MONITOR => dark,
        _ => wood,
    })
}
