//! Tables.

use super::super::blocks::Blocks;
use super::super::lathe::{lathe, outline};
use super::super::material::Material;
use super::super::mesh::Mesh;

/// Thickness of a table top in metres.
const TOP: f64 = 0.04;
/// Width of a square leg in metres.
const LEG: f64 = 0.06;

/// A table of `width` (x) by `depth` (y) by `height` on four legs.
pub fn table(width: f64, depth: f64, height: f64, cell: f64, wood: Material) -> Mesh {
    let (x, y, under) = (width / 2.0, depth / 2.0, height - TOP);
    let mut blocks = Blocks::empty().with_cell_size(cell);
    blocks.add([-x, -y, under], [x, y, height], 0);
    for (left, front) in [(-x, -y), (x - LEG, -y), (-x, y - LEG), (x - LEG, y - LEG)] {
        blocks.add([left, front, 0.0], [left + LEG, front + LEG, under], 0);
    }
    blocks.mesh(|_| wood)
}

/// A round table on one pillar with a round foot.
pub fn round_table(radius: f64, height: f64, segments: usize, wood: Material) -> Mesh {
    let points = [
        (0.0, 0.0),
        (radius * 0.55, 0.0),
        (radius * 0.55, 0.03),
        (0.05, 0.06),
        (0.05, height - TOP),
        (radius, height - TOP),
        (radius, height),
        (0.0, height),
    ];
    lathe(&outline(wood, &points), segments)
}
