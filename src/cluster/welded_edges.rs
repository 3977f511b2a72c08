//! The edges of facets over welded vertices, ready to be matched.

use super::weld::weld_vertices;
use crate::scene::{Facet, Scene, Side};
use glam::DVec3;

/// Default weld distance over the diagonal of the scene: the width of cracks that count as closed,
/// below which no visibility claim promises anything.
pub(super) const WELD: f64 = 1.0e-6;

/// Links made for one half-edge, on average over an edge, before only the flattest are kept: edges
/// of real scenes carry at most a handful of facets, all of which may then be linked, while an edge
/// shared by thousands must not make millions of links.
pub(super) const LINKS_PER_HALF_EDGE: usize = 4;

/// Two neighbouring facets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Link {
    /// Index of the first facet.
    pub a: u32,
    /// Index of the second facet, greater than `a`.
    pub b: u32,
    /// Length of border that they share, in normalised units.
    pub length: f64,
}

/// An edge of a facet, in the facet's direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct HalfEdge {
    /// Smaller welded vertex.
    pub low: u32,
    /// Greater welded vertex.
    pub high: u32,
    /// True when the facet runs from `high` to `low`.
    pub reversed: bool,
    /// The facet.
    pub facet: u32,
}

impl HalfEdge {
    /// True for half-edges of one welded edge, whatever their direction.
    pub fn same_edge(&self, other: &Self) -> bool {
        (self.low, self.high) == (other.low, other.high)
    }
}

/// All half-edges of a facet list over welded vertices, sorted, so that those of one edge are a
/// run and inside it the two directions are two runs.
pub(super) struct WeldedEdges<'a> {
    pub scene: &'a Scene,
    pub facets: &'a [Facet],
    pub half_edges: Vec<HalfEdge>,
}

impl<'a> WeldedEdges<'a> {
    pub fn new(scene: &'a Scene, facets: &'a [Facet], weld: f64) -> Self {
        let representative = weld_vertices(&scene.positions, weld);
        let mut half_edges = Vec::with_capacity(3 * facets.len());
        for (index, facet) in facets.iter().enumerate() {
            let mut corner = scene.polygons[facet.polygon.index()]
                .vertices
                .map(|v| representative[v as usize]);
            if facet.side == Side::Back {
                corner.swap(1, 2);
            }
            for i in 0..3 {
                let (from, to) = (corner[i], corner[(i + 1) % 3]);
                if from != to {
                    half_edges.push(HalfEdge {
                        low: from.min(to),
                        high: from.max(to),
                        reversed: from > to,
                        facet: index as u32,
                    });
                }
            }
        }
        half_edges.sort_unstable();
        // A needle whose third corner is welded to its first runs twice along one edge.
        half_edges.dedup();
        Self {
            scene,
            facets,
            half_edges,
        }
    }

    pub fn position(&self, vertex: u32) -> DVec3 {
        self.scene.positions[vertex as usize].as_dvec3()
    }

    /// The link of two facets along `length`, or `None` for the two sides of one polygon.
    pub fn link(&self, a: u32, b: u32, length: f64) -> Option<Link> {
        let differ = self.facets[a as usize].polygon != self.facets[b as usize].polygon;
        differ.then_some(Link {
            a: a.min(b),
            b: a.max(b),
            length,
        })
    }
}
