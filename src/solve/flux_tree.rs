//! The hierarchy as whoever asks what light a cluster casts on a point walks it: half a line of the cache a node.

use super::irradiance_kernel::POINT_RADII;
use crate::cluster::{Hierarchy, NodeKind};
use crate::math::NodeId;
use crate::scene::Scene;
use glam::Vec3;

/// A cluster is taken as one flux vector beyond this many radii, else as its two children. Its radius bounds its box:
/// a rectangle's squared radius of gyration is a third of that squared, so that the centroid alone sends
/// 2/3 (1/8)^2 = 1.0e-2 too much straight ahead, and at most 2 (1/8)^2 = 3.1e-2 too little low over the plane. In the
/// mean over directions it errs by less than 1e-2. Between 6 and 12 the error of a solve does not change (`bench/runs/`, accuracy).
const CLUSTER_RADII: f32 = 8.0;

/// A node: where its light seems to come from, and how much.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct FluxNode {
    /// Area-weighted centroid.
    pub(super) centroid: Vec3,
    /// Squared distance from the centroid beyond which the node stands as one.
    pub(super) reach2: f32,
    /// Sum of areas times unit normals.
    pub(super) area_vector: Vec3,
    /// Its children or its facet, by the last bit.
    below: u32,
}

/// What is below a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Below {
    /// Two nodes, side by side from this one on.
    Children(u32),
    /// A facet, by its place in the hierarchy's order.
    Facet(usize),
}

impl FluxNode {
    pub(super) fn below(&self) -> Below {
        match self.below & 1 {
            0 => Below::Children(self.below >> 1),
            _ => Below::Facet((self.below >> 1) as usize),
        }
    }
}

/// The nodes, by [`NodeId`]. Those of volumes mean nothing.
#[derive(Clone, Debug)]
pub struct FluxTree {
    nodes: Vec<FluxNode>,
}

impl FluxTree {
    /// The nodes of a hierarchy.
    pub fn new(scene: &Scene, hierarchy: &Hierarchy) -> Self {
        let nodes = hierarchy.nodes.iter().zip(&hierarchy.shapes);
        let nodes = nodes
            .map(|(node, shape)| {
                let (reach2, below) = if node.kind == NodeKind::Facet {
                    let corners = scene.facet_corners(hierarchy.facets[node.first_facet as usize]);
                    let centroid = shape.centroid;
                    let radius2 = corners.map(|c| c.distance_squared(centroid));
                    let radius2 = radius2.into_iter().fold(0.0f32, f32::max);
                    (
                        POINT_RADII * POINT_RADII * radius2,
                        node.first_facet << 1 | 1,
                    )
                } else {
                    let half = (node.bounds.max - node.bounds.min) * 0.5;
                    (
                        CLUSTER_RADII * CLUSTER_RADII * half.length_squared(),
                        node.first_child << 1,
                    )
                };
                FluxNode {
                    centroid: shape.centroid,
                    reach2,
                    area_vector: shape.area_vector,
                    below,
                }
            })
            .collect();
        Self { nodes }
    }

    pub(super) fn node(&self, id: NodeId) -> &FluxNode {
        &self.nodes[id.index()]
    }
}
