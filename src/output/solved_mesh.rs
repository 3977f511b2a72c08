//! A solution as a mesh in the file's units: what `solution.ply` holds.

use crate::math::{FacetId, PolygonId};
use crate::scene::{Facet, Scene, Side};
use crate::solve::{Solution, SolvedPatch};
use glam::DVec3;
use std::collections::HashMap;

/// One side of one leaf patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolvedFace {
    /// Indices into [`SolvedMesh::vertices`], counter-clockwise seen from this side.
    pub vertices: [u32; 3],
    /// 0-based index, in file order, of the `f` statement that it came from.
    pub source_face: u32,
    /// Which side of the statement's polygon.
    pub side: Side,
    /// Radiosity in W/m2, emission included.
    pub radiosity: [f32; 3],
    /// Irradiance in W/m2.
    pub irradiance: [f32; 3],
}

/// The leaf patches of a solution, one face a patch and side, in the file's units.
///
/// Faces stand polygon by polygon, the front before the back, and within one facet in the
/// depth-first order of [`crate::solve::PatchPath`]. Vertices are shared where they agree in every
/// bit, so patches of neighbouring facets are connected. A polygon without a lit side is one black
/// face on its front, so that the patches of every face tile it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolvedMesh {
    /// Corners of the patches; those of the input stand as they were read.
    pub vertices: Vec<DVec3>,
    /// Leaf patches.
    pub faces: Vec<SolvedFace>,
}

impl SolvedMesh {
    /// Maps a solution back to the units of its scene. Time and memory grow with the patches.
    pub fn new(scene: &Scene, solution: &Solution) -> Self {
        let mut builder = Builder {
            scene,
            mesh: Self {
                vertices: Vec::with_capacity(scene.source_positions.len()),
                faces: Vec::with_capacity(solution.patches.len()),
            },
            index: HashMap::with_capacity(scene.source_positions.len()),
        };
        for (facet, id) in in_file_order(scene, solution) {
            builder.add_facet(facet, id.map_or(&[UNLIT], |id| solution.facet_patches(id)));
        }
        builder.mesh
    }

    /// Corners of a face.
    pub fn corners(&self, face: &SolvedFace) -> [DVec3; 3] {
        face.vertices.map(|v| self.vertices[v as usize])
    }

    /// Area of a face in the square of the file's units.
    pub fn area(&self, face: &SolvedFace) -> f64 {
        triangle_area(self.corners(face))
    }
}

/// The facets of a solution polygon by polygon, the front before the back, with their ids; a polygon without a lit side
/// stands there by its front, without one.
pub(super) fn in_file_order(scene: &Scene, solution: &Solution) -> Vec<(Facet, Option<FacetId>)> {
    let mut order: Vec<FacetId> = (0..solution.facets.len()).map(FacetId::new).collect();
    let facet = |id: &FacetId| solution.facets[id.index()];
    order.sort_unstable_by_key(|id| (facet(id).polygon, facet(id).side));
    let mut next = order.into_iter().peekable();
    let mut all = Vec::with_capacity(solution.facets.len());
    for p in 0..scene.polygons.len() {
        let polygon = PolygonId::new(p);
        let before = all.len();
        while let Some(id) = next.next_if(|id| facet(id).polygon == polygon) {
            all.push((facet(&id), Some(id)));
        }
        if all.len() == before {
            let side = Side::Front;
            all.push((Facet { polygon, side }, None));
        }
    }
    all
}

/// The whole of a polygon that no light reaches and that emits none.
const UNLIT: SolvedPatch = SolvedPatch {
    path: crate::solve::PatchPath::ROOT,
    radiosity: [0.0; 3],
    irradiance: [0.0; 3],
};

/// Area of a triangle.
pub(crate) fn triangle_area([a, b, c]: [DVec3; 3]) -> f64 {
    let (u, v) = (b - a, c - a);
    // In units of its size: the length of a cross product takes fourth powers, which leave the range of f64 far sooner.
    let size = u.abs().max(v.abs()).max_element();
    match size > 0.0 {
        true => 0.5 * (u / size).cross(v / size).length() * size * size,
        false => 0.0,
    }
}

/// A mesh under construction, with the vertices found so far.
struct Builder<'a> {
    scene: &'a Scene,
    mesh: SolvedMesh,
    index: HashMap<[u64; 3], u32>,
}

impl Builder<'_> {
    fn add_facet(&mut self, facet: Facet, patches: &[SolvedPatch]) {
        let [a, b, c] = self.scene.source_corners(facet.polygon);
        let corners = match facet.side {
            Side::Front => [a, b, c],
            Side::Back => [a, c, b],
        };
        let source_face = self.scene.polygons[facet.polygon.index()].source_face;
        for patch in patches {
            let vertices = patch.path.corners(corners).map(|v| self.vertex(v));
            self.mesh.faces.push(SolvedFace {
                vertices,
                source_face,
                side: facet.side,
                radiosity: patch.radiosity,
                irradiance: patch.irradiance,
            });
        }
    }

    fn vertex(&mut self, position: DVec3) -> u32 {
        let vertices = &mut self.mesh.vertices;
        *self
            .index
            .entry(position.to_array().map(f64::to_bits))
            .or_insert_with(|| {
                let id = u32::try_from(vertices.len())
                    .expect("fewer vertices than 3 times the 2^32 patches' share of memory");
                vertices.push(position);
                id
            })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The range of sizes that the loader takes: 1e-100 to 1e100.
    #[test]
    fn areas_of_triangles_of_any_size_are_finite_and_right() {
        for size in [1e-99, 1e-60, 1.0, 1e60, 1e99] {
            let corners = [
                DVec3::ONE,
                DVec3::new(4.0, 1.0, 1.0),
                DVec3::new(1.0, 1.0, -3.0),
            ];
            let area = triangle_area(corners.map(|p| p * size));
            let expected = 6.0 * size * size;
            assert!(
                (area - expected).abs() <= 1e-12 * expected,
                "{size:e}: {area:e}"
            );
        }
        assert_eq!(triangle_area([DVec3::ONE; 3]), 0.0);
    }
}
