//! Which polygons share an edge exactly: what a surface that cuts a shaft hangs together by.
//!
//! Corners count as one only where they are the same to the bit, so that two polygons at an edge leave no crack at all
//! and nothing has to be argued about its width.

use crate::math::PolygonId;
use glam::Vec3;

/// Polygons and the edges that they share.
#[derive(Clone, Debug, Default)]
pub struct SurfaceEdges {
    corners: Vec<[Vec3; 3]>,
    /// First of the corners at the same place, for each corner of each polygon.
    vertices: Vec<[u32; 3]>,
    /// Edges of polygons, sorted by their two vertices.
    by_vertices: Vec<EdgeOf>,
}

/// An edge of a polygon, known by its two vertices in ascending order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct EdgeOf {
    low: u32,
    high: u32,
    polygon: u32,
    /// The corner where it begins.
    corner: u8,
}

/// One side of a polygon: the edge from corner `corner` to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PolygonEdge {
    /// The polygon.
    pub polygon: PolygonId,
    /// The corner where it begins: 0, 1 or 2.
    pub corner: usize,
    /// True where it runs from the lesser of its vertices to the greater.
    pub ascends: bool,
}

impl SurfaceEdges {
    /// The edges of `corners`, whose indices are the polygons' ids.
    pub fn new(corners: Vec<[Vec3; 3]>) -> Self {
        let vertices = vertices_of(&corners);
        let mut by_vertices: Vec<EdgeOf> = vertices
            .iter()
            .zip(0_u32..)
            .flat_map(|(vertices, polygon)| {
                (0..3_u8).map(move |corner| {
                    let (from, to) = ends(vertices, usize::from(corner));
                    EdgeOf {
                        low: from.min(to),
                        high: from.max(to),
                        polygon,
                        corner,
                    }
                })
            })
            .collect();
        by_vertices.sort_unstable();
        Self {
            corners,
            vertices,
            by_vertices,
        }
    }

    /// The corners of a polygon.
    pub(super) fn corners(&self, polygon: PolygonId) -> [Vec3; 3] {
        self.corners[polygon.index()]
    }

    /// The edge that begins at a corner of a polygon.
    pub(super) fn edge(&self, polygon: PolygonId, corner: usize) -> PolygonEdge {
        let (from, to) = ends(&self.vertices[polygon.index()], corner);
        PolygonEdge {
            polygon,
            corner,
            ascends: from < to,
        }
    }

    /// The same edge as it belongs to the other polygons that have it.
    pub(super) fn others(&self, edge: PolygonEdge) -> impl Iterator<Item = PolygonEdge> + '_ {
        let (from, to) = ends(&self.vertices[edge.polygon.index()], edge.corner);
        let key = (from.min(to), from.max(to));
        let first = self.by_vertices.partition_point(|e| (e.low, e.high) < key);
        self.by_vertices[first..]
            .iter()
            .take_while(move |e| (e.low, e.high) == key)
            .filter(move |e| e.polygon != edge.polygon.0)
            .map(|e| self.edge(PolygonId(e.polygon), usize::from(e.corner)))
    }
}

fn ends(vertices: &[u32; 3], corner: usize) -> (u32, u32) {
    (vertices[corner], vertices[(corner + 1) % 3])
}

/// Numbers corners so that those at one place have the number of the first of them.
fn vertices_of(corners: &[[Vec3; 3]]) -> Vec<[u32; 3]> {
    // Adding zero makes one zero of the two.
    let place = |i: u32| {
        let corner = corners[i as usize / 3][i as usize % 3] + Vec3::ZERO;
        corner.to_array().map(f32::to_bits)
    };
    let mut order: Vec<u32> = (0..3 * corners.len() as u32).collect();
    order.sort_unstable_by_key(|&i| (place(i), i));
    let mut vertices = vec![[0; 3]; corners.len()];
    let mut first = 0;
    for (k, &i) in order.iter().enumerate() {
        if k == 0 || place(i) != place(first) {
            first = i;
        }
        vertices[i as usize / 3][i as usize % 3] = first;
    }
    vertices
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two triangles of a square, and one that touches it at a corner.
    fn square() -> SurfaceEdges {
        let at = |x: f32, y: f32| Vec3::new(x, y, 0.0);
        SurfaceEdges::new(vec![
            [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0)],
            [at(-0.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)],
            [at(1.0, 1.0), at(2.0, 1.0), at(2.0, 2.0)],
        ])
    }

    #[test]
    fn neighbours_share_edges_and_run_along_them_in_opposite_directions() {
        let edges = square();
        let shared = edges.edge(PolygonId(0), 2);
        let others: Vec<PolygonEdge> = edges.others(shared).collect();
        assert_eq!(others, [edges.edge(PolygonId(1), 0)]);
        assert_ne!(others[0].ascends, shared.ascends);
        for (polygon, corner) in [(0, 0), (0, 1), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2)] {
            let edge = edges.edge(PolygonId(polygon), corner);
            assert_eq!(edges.others(edge).count(), 0, "{polygon} {corner}");
        }
    }

    #[test]
    fn corners_a_bit_apart_are_two() {
        let at = |x: f32, y: f32| Vec3::new(x, y, 0.0);
        let next = 1.0_f32.next_up();
        let edges = SurfaceEdges::new(vec![
            [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0)],
            [at(0.0, 0.0), at(next, 1.0), at(0.0, 1.0)],
        ]);
        assert_eq!(edges.others(edges.edge(PolygonId(0), 2)).count(), 0);
    }
}
