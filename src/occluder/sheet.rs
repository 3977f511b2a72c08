//! A flat cluster as an oriented surface over its plane.
//!
//! # Why a rectangle on an almost flat cluster may claim anything
//!
//! Let C be the sum of the cluster's triangles, each oriented by its facet, as a 2-chain: a formal
//! sum of oriented pieces of surface. Its boundary is the sum of the directed edges, in which
//! opposite edges cancel ([`super::boundary`]). Let R be a rectangle of the plane over which the
//! surface stays strictly within the slab -h < z < h, and let no edge of the boundary project into
//! R. Then C, cut down to the block R x [-h, h], is a relative cycle: it ends only on the block's
//! walls. How often it separates the block's top from its bottom is one integer for the whole
//! block, its *degree*: the number of triangles over any point of R, upward ones counted +1 and
//! downward ones -1, which is also the winding number of the projected boundary about that point.
//! If the degree is not zero, every path through the block from top to bottom crosses C.
//!
//! Folds, hems, steps and slivers turned over by rounding need no special case. Two sheets at
//! different heights that merely abut in projection keep both their edges, for those do not cancel
//! in space, and no rectangle crosses them. The design's demand that every triangle project with
//! positive orientation is sufficient, not necessary; this is the whole of it.
//!
//! Welding ([`super::weld`]) adds thin strips to C that stay within w of the cluster's edges; a
//! segment that crosses a strip comes within w of a polygon and so is not surely clear, which is all
//! that an occluder promises.

use super::boundary::{DirectedEdge, cancel};
use super::frame::PlaneFrame;
use crate::scene::{Facet, Scene};
use glam::DVec3;

/// The oriented triangles of a cluster in the coordinates of its plane.
pub(super) struct Sheet {
    /// The frame; its plane lies half-way between the lowest and the highest vertex.
    pub frame: PlaneFrame,
    /// Distinct vertices in the frame's coordinates; `z` is the height above the plane.
    pub positions: Vec<DVec3>,
    /// Triangles, counter-clockwise seen from the facets' side.
    pub triangles: Vec<[u32; 3]>,
    /// Edges that do not cancel between vertices at the very same place.
    pub boundary: Vec<DirectedEdge>,
    /// Greatest distance of a vertex to the plane.
    pub deviation: f64,
}

impl Sheet {
    /// The sheet of `facets`; `None` where their normals cancel.
    pub fn new(scene: &Scene, facets: &[Facet]) -> Option<Self> {
        let corners = |f: &Facet| scene.facet_corners(*f).map(|p| p.as_dvec3());
        let frame = PlaneFrame::fit(facets.iter().map(corners))?;

        // One vertex a place: vertices that differ only in their index are the same.
        let mut places: Vec<[u32; 4]> = facets
            .iter()
            .flat_map(|f| scene.polygons[f.polygon.index()].vertices)
            .map(|vertex| {
                let p = scene.positions[vertex as usize];
                // Adding zero makes -0 into +0, which are one place.
                let [x, y, z] = [p.x, p.y, p.z].map(|c| (c + 0.0).to_bits());
                [x, y, z, vertex]
            })
            .collect();
        places.sort_unstable();
        places.dedup();
        let mut vertex_of: Vec<(u32, u32)> = Vec::with_capacity(places.len());
        let mut positions = Vec::new();
        for same in places.chunk_by(|a, b| a[..3] == b[..3]) {
            let [x, y, z] =
                [same[0][0], same[0][1], same[0][2]].map(|c| f64::from(f32::from_bits(c)));
            let index = positions.len() as u32;
            positions.push(frame.project(DVec3::new(x, y, z)));
            vertex_of.extend(same.iter().map(|place| (place[3], index)));
        }
        vertex_of.sort_unstable();
        let local = |vertex: u32| {
            let at = vertex_of.partition_point(|&(v, _)| v < vertex);
            vertex_of[at].1
        };
        let triangles: Vec<[u32; 3]> = facets
            .iter()
            .map(|f| oriented_vertices(scene, *f).map(local))
            .collect();

        let (low, high) = positions
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), p| {
                (low.min(p.z), high.max(p.z))
            });
        let middle = 0.5 * (low + high);
        for p in &mut positions {
            p.z -= middle;
        }
        let boundary = cancel(
            triangles
                .iter()
                .flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]])
                .collect(),
        );
        Some(Self {
            frame: frame.raised(middle),
            positions,
            triangles,
            boundary,
            deviation: 0.5 * (high - low),
        })
    }
}

/// The vertices of a facet, counter-clockwise seen from its side.
fn oriented_vertices(scene: &Scene, facet: Facet) -> [u32; 3] {
    let [a, b, c] = scene.polygons[facet.polygon.index()].vertices;
    match facet.side {
        crate::scene::Side::Front => [a, b, c],
        crate::scene::Side::Back => [a, c, b],
    }
}
