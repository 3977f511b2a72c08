//! Rectilinear space: rooms carved out of solid, or furniture put together from blocks.
//!
//! Boxes are filled one after the other with air or solid. The planes of all boxes cut space into
//! cells, and the mesh is the border between air and solid, facing the air. Because it is a border it
//! is closed, whatever the boxes: doors get jambs, shared walls get two skins, touching blocks
//! become one.

use super::border::border_mesh;
use super::cell_grid::{BorderFace, Cell, CellGrid, SAME_CUT};
use super::material::Material;
use super::mesh::Mesh;
use glam::DVec3;

/// Rectilinear space under construction.
#[derive(Clone, Debug)]
pub struct Blocks {
    start: Cell,
    fills: Vec<(DVec3, DVec3, Cell)>,
    cell_size: DVec3,
}

impl Blocks {
    /// All solid: rooms are carved out of it.
    pub fn solid() -> Self {
        Self::filled_with(Cell::Solid(0))
    }

    /// All air: blocks are put into it.
    pub fn empty() -> Self {
        Self::filled_with(Cell::Air(0))
    }

    fn filled_with(start: Cell) -> Self {
        Self {
            start,
            fills: Vec::new(),
            cell_size: DVec3::INFINITY,
        }
    }

    /// Cuts cells so that none is longer than `size` (metres) along any axis.
    #[must_use]
    pub fn with_cell_size(self, size: f64) -> Self {
        self.with_cell_sizes(DVec3::splat(size))
    }

    /// Cuts cells so that none is longer than `sizes` (metres) along its axis.
    #[must_use]
    pub fn with_cell_sizes(mut self, sizes: DVec3) -> Self {
        self.cell_size = sizes;
        self
    }

    /// Fills the box from `min` to `max` with air of tag `tag`.
    pub fn carve(&mut self, min: [f64; 3], max: [f64; 3], tag: u16) {
        self.fills.push((min.into(), max.into(), Cell::Air(tag)));
    }

    /// Fills the box from `min` to `max` with solid of tag `tag`.
    pub fn add(&mut self, min: [f64; 3], max: [f64; 3], tag: u16) {
        self.fills.push((min.into(), max.into(), Cell::Solid(tag)));
    }

    /// The border between air and solid, each cell of it painted by `paint`.
    pub fn mesh(&self, paint: impl Fn(&BorderFace) -> Material) -> Mesh {
        let lines: [Vec<f64>; 3] = std::array::from_fn(|axis| self.lines(axis));
        let grid = CellGrid::new(self.start, &self.fills, &lines);
        border_mesh(&grid, &lines, self.cell_size, paint)
    }

    /// All cuts along one axis, ascending: the boxes' planes and what the cell size asks for.
    fn lines(&self, axis: usize) -> Vec<f64> {
        let planes = |(min, max, _): &(DVec3, DVec3, Cell)| [min[axis], max[axis]];
        let mut all: Vec<f64> = self.fills.iter().flat_map(planes).collect();
        all.sort_by(f64::total_cmp);
        all.dedup_by(|b, a| *b - *a < SAME_CUT);
        let mut lines = Vec::with_capacity(all.len());
        for pair in all.windows(2) {
            let length = pair[1] - pair[0];
            // A hair of slack, so that 1.2 m in cells of 0.4 m is three cells and not four.
            let pieces = (length / self.cell_size[axis] - 1e-6).ceil().max(1.0);
            for k in 0..pieces as usize {
                lines.push(pair[0] + length * k as f64 / pieces);
            }
        }
        lines.extend(all.last());
        lines
    }
}

/// A closed box facing outwards, in cells of at most `cell_size` metres.
pub fn cuboid(min: [f64; 3], max: [f64; 3], cell_size: f64, material: Material) -> Mesh {
    let mut blocks = Blocks::empty().with_cell_size(cell_size);
    blocks.add(min, max, 0);
    blocks.mesh(|_| material)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAINT: Material = Material::grey("paint", 0.5, 0.0);

    /// Six times the signed volume under a mesh: positive where it faces outwards.
    fn six_volumes(mesh: &Mesh) -> f64 {
        mesh.triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.vertices.map(|v| mesh.vertices[v]);
                a.dot(b.cross(c))
            })
            .sum()
    }

    #[test]
    fn a_box_has_twelve_triangles_and_its_volume_outwards() {
        let mesh = cuboid([1.0, 2.0, 3.0], [3.0, 5.0, 7.0], 10.0, PAINT);
        assert_eq!(mesh.triangles.len(), 12);
        assert_eq!(mesh.vertices.len(), 8);
        assert!((six_volumes(&mesh) / 6.0 - 24.0).abs() < 1e-12);
    }

    #[test]
    fn a_carved_room_faces_inwards() {
        let mut rooms = Blocks::solid();
        rooms.carve([0.0; 3], [2.0, 3.0, 4.0], 0);
        let mesh = rooms.mesh(|_| PAINT);
        assert_eq!(mesh.triangles.len(), 12);
        assert!((six_volumes(&mesh) / 6.0 + 24.0).abs() < 1e-12);
    }

    #[test]
    fn blocks_that_touch_become_one_and_rooms_with_a_door_share_its_jambs() {
        let mut pair = Blocks::empty();
        pair.add([0.0; 3], [1.0; 3], 0);
        pair.add([1.0, 0.0, 0.0], [2.0, 1.0, 1.0], 0);
        // One box of twice the length: no face where the two cubes touch.
        let mesh = pair.mesh(|_| PAINT);
        assert_eq!(mesh.triangles.len(), 12);
        assert!((six_volumes(&mesh) / 6.0 - 2.0).abs() < 1e-12);

        let mut rooms = Blocks::solid();
        rooms.carve([0.0; 3], [3.0, 3.0, 3.0], 1);
        rooms.carve([3.2, 0.0, 0.0], [6.2, 3.0, 3.0], 2);
        rooms.carve([3.0, 1.0, 0.0], [3.2, 2.0, 2.0], 3);
        let mesh = rooms.mesh(|_| PAINT);
        let volume = 2.0 * 27.0 + 0.2 * 1.0 * 2.0;
        assert!((six_volumes(&mesh) / 6.0 + volume).abs() < 1e-12);
    }

    #[test]
    fn cells_keep_to_the_size_asked_for() {
        let mesh = cuboid([0.0; 3], [1.2, 0.4, 0.4], 0.4, PAINT);
        // 3 cells on each of the four long sides and one at each end.
        assert_eq!(mesh.triangles.len(), 2 * (4 * 3 + 2));
    }
}
