//! Free-standing partition screens, benches and blocks.

use super::super::blocks::{Blocks, cuboid};
use super::super::material::Material;
use super::super::mesh::Mesh;

/// A panel of `width` by `height`, 5 cm thick, on two feet.
pub fn screen(width: f64, height: f64, cell: f64, cloth: Material, metal: Material) -> Mesh {
    let x = width / 2.0;
    let mut blocks = Blocks::empty().with_cell_size(cell);
    blocks.add([-x, -0.025, 0.06], [x, 0.025, height], 1);
    for left in [-x, x - 0.06] {
        blocks.add([left, -0.2, 0.0], [left + 0.06, 0.2, 0.06], 0);
    }
    blocks.mesh(|face| if face.solid == 1 { cloth } else { metal })
}

/// A bench `width` wide: a seat on two slabs.
pub fn bench(width: f64, cell: f64, wood: Material) -> Mesh {
    let x = width / 2.0;
    let mut blocks = Blocks::empty().with_cell_size(cell);
    blocks.add([-x, -0.22, 0.40], [x, 0.22, 0.46], 0);
    for left in [-x, x - 0.08] {
        blocks.add([left, -0.22, 0.0], [left + 0.08, 0.22, 0.40], 0);
    }
    blocks.mesh(|_| wood)
}

/// A plain block standing on the floor, centred on the origin.
pub fn block([width, depth, height]: [f64; 3], cell: f64, material: Material) -> Mesh {
    cuboid(
        [-width / 2.0, -depth / 2.0, 0.0],
        [width / 2.0, depth / 2.0, height],
        cell,
        material,
    )
}
