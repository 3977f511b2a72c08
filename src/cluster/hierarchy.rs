//! The one scene hierarchy as flat arrays: volume clusters above face clusters above facets.
//!
//! Paper, section 4: a binary tree of axis-aligned boxes. The leaves are *facets* (one side of a
//! polygon); they are stored in the order in which a depth-first walk meets them, so that every
//! node covers a contiguous range of [`Hierarchy::facets`].

use crate::math::{Aabb, Cone, FacetId, NodeId, Plane};
use crate::scene::Facet;
use glam::Vec3;

/// What a node stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize)]
pub enum NodeKind {
    /// Joins unconnected or dissimilar pieces; exchanges no energy.
    Volume,
    /// Connected facets with similar normals.
    FaceCluster,
    /// A leaf: one side of one polygon.
    Facet,
}

/// The hot part of a node: what walking the tree touches.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// Box around the node's facets.
    pub bounds: Aabb,
    /// Index of the first child; the second stands next to it. Zero for a leaf.
    pub first_child: u32,
    /// First facet covered.
    pub first_facet: u32,
    /// Number of facets covered; 1 for a leaf.
    pub facet_count: u32,
    /// What it stands for.
    pub kind: NodeKind,
}

/// The cold part of a node: the shape of the surface that it covers.
#[derive(Clone, Copy, Debug)]
pub struct ClusterShape {
    /// Sum of the facets' areas, normalised units squared.
    pub area: f32,
    /// Area-weighted mean of the facets' centroids.
    pub centroid: Vec3,
    /// Sum over facets of area times unit normal; shorter than `area` where the surface bends.
    pub area_vector: Vec3,
    /// Cone that contains the normal of every facet.
    pub cone: Cone,
    /// Plane fitted to the facets, its normal on their side.
    pub plane: Plane,
    /// Greatest distance of a vertex to `plane`, rounded up.
    pub deviation: f32,
}

/// The scene hierarchy. Node 0 is the root; children stand behind their parents.
#[derive(Clone, Debug)]
pub struct Hierarchy {
    /// Hot parts.
    pub nodes: Vec<Node>,
    /// Cold parts, parallel to `nodes`.
    pub shapes: Vec<ClusterShape>,
    /// The facets in depth-first order; `FacetId` indexes this.
    pub facets: Vec<Facet>,
    /// The leaf of each facet.
    pub leaf_of_facet: Vec<NodeId>,
}

/// Why a hierarchy is not one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("hierarchy node {node}: {reason}")]
pub struct HierarchyDefect {
    /// The offending node.
    pub node: u32,
    /// What is wrong with it.
    pub reason: &'static str,
}

impl Hierarchy {
    /// The root.
    pub const ROOT: NodeId = NodeId(0);

    /// The hot part of a node.
    pub fn node(&self, id: NodeId) -> &Node {
        &self.nodes[id.index()]
    }

    /// The shape of a node.
    pub fn shape(&self, id: NodeId) -> &ClusterShape {
        &self.shapes[id.index()]
    }

    /// The two children, or `None` for a leaf.
    pub fn children(&self, id: NodeId) -> Option<[NodeId; 2]> {
        let node = self.node(id);
        (node.kind != NodeKind::Facet)
            .then_some([NodeId(node.first_child), NodeId(node.first_child + 1)])
    }

    /// The facets that a node covers.
    pub fn facet_range(&self, id: NodeId) -> std::ops::Range<usize> {
        let node = self.node(id);
        node.first_facet as usize..(node.first_facet + node.facet_count) as usize
    }

    /// The facet of a leaf.
    pub fn facet_of_leaf(&self, id: NodeId) -> FacetId {
        debug_assert_eq!(self.node(id).kind, NodeKind::Facet);
        FacetId(self.node(id).first_facet)
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.nodes.len() * (size_of::<Node>() + size_of::<ClusterShape>())
            + self.facets.len() * (size_of::<Facet>() + size_of::<NodeId>())
    }
}
