//! The hierarchy as whoever asks what light a cluster casts on a point walks it: half a line of the cache a node.

use super::irradiance_kernel::POINT_RADII;
use crate::cluster::{Hierarchy, NodeKind};
use crate::math::NodeId;
use crate::scene::Scene;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// A cluster is taken as one flux vector beyond this many radii, else as its two children: radii of the rectangle along
/// the axes with its mean square. The centroid alone would send 2/3 (1/8)^2 = 1.0e-2 too much straight ahead, always to
/// the same side; with [`FluxNode::vector_from`] what is left is of the fourth order, 1e-3, and what an oblong cluster
/// sends more one way than the other. Between 6 and 12 the error of a solve does not change (`bench/runs/`, accuracy).
const CLUSTER_RADII: f32 = 8.0;
/// The squared radius of a rectangle over the mean square of its points' distances from its centre.
const RADIUS2_OVER_MEAN_SQUARE: f32 = 3.0;

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

    /// The irradiance vector of a flat cluster at unit radiosity, seen from `rel` before its centroid, `distance2` the
    /// square of that: of its centroid and of the spread of its points about it.
    ///
    /// With `h` the height over its plane, which is the same for all of its points, the vector of a point is
    /// `h r / |r|^4`. Its mean over points `r + u`, `u` in the plane with the mean square `m` in all directions alike,
    /// is to second order `h / |r|^4 (r (1 - 4 m / |r|^2 + 6 m s^2 / |r|^2) + 2 m h n / |r|^2)`, `s` the sine to the normal.
    pub(super) fn vector_from(&self, rel: Vec3, distance2: f32) -> Vec3 {
        let along = self.area_vector.dot(rel);
        let inverse = 1.0 / distance2;
        // Without area there is no flux either.
        let per_area2 = along / self.area_vector.length_squared().max(f32::MIN_POSITIVE);
        let spread =
            self.reach2 * (inverse / (CLUSTER_RADII * CLUSTER_RADII * RADIUS2_OVER_MEAN_SQUARE));
        let sine2 = 1.0 - along * per_area2 * inverse;
        let flux = (-along).max(0.0) * inverse * inverse * FRAC_1_PI;
        (rel * (1.0 - 4.0 * spread + 6.0 * spread * sine2)
            + self.area_vector * (2.0 * spread * per_area2))
            * flux
    }
}

/// The nodes, by [`NodeId`]. Those of volumes mean nothing.
#[derive(Clone, Debug)]
pub struct FluxTree {
    nodes: Vec<FluxNode>,
    /// Mean over each node's surface of the squared distance from its centroid.
    mean_squares: Vec<f32>,
}

impl FluxTree {
    /// The nodes of a hierarchy.
    pub fn new(scene: &Scene, hierarchy: &Hierarchy) -> Self {
        let mean_squares = mean_squares(scene, hierarchy);
        let nodes = hierarchy.nodes.iter().zip(&hierarchy.shapes);
        let nodes = nodes
            .zip(&mean_squares)
            .map(|((node, shape), &mean_square)| {
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
                    let radius2 = RADIUS2_OVER_MEAN_SQUARE * mean_square;
                    (
                        CLUSTER_RADII * CLUSTER_RADII * radius2,
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
        Self {
            nodes,
            mean_squares,
        }
    }

    /// Mean over a node's surface of the squared distance from its centroid.
    pub(super) fn mean_square(&self, id: NodeId) -> f32 {
        self.mean_squares[id.index()]
    }

    pub(super) fn node(&self, id: NodeId) -> &FluxNode {
        &self.nodes[id.index()]
    }
}

/// Mean over each node's surface of the squared distance from its centroid: of a triangle a 36th of the sum of its
/// edges' squares, of a node that of its children about their common centroid.
fn mean_squares(scene: &Scene, hierarchy: &Hierarchy) -> Vec<f32> {
    let mut means = vec![0.0f64; hierarchy.nodes.len()];
    // Children stand behind their parents.
    for at in (0..means.len()).rev() {
        let node = &hierarchy.nodes[at];
        if node.kind == NodeKind::Facet {
            let corners = scene.facet_corners(hierarchy.facets[node.first_facet as usize]);
            let [a, b, c] = corners.map(Vec3::as_dvec3);
            let edges = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
            means[at] = edges / 36.0;
            continue;
        }
        let centroid = hierarchy.shapes[at].centroid.as_dvec3();
        let (mut sum, mut area) = (0.0, 0.0);
        for child in [node.first_child as usize, node.first_child as usize + 1] {
            let shape = &hierarchy.shapes[child];
            let away = shape.centroid.as_dvec3().distance_squared(centroid);
            sum += f64::from(shape.area) * (means[child] + away);
            area += f64::from(shape.area);
        }
        means[at] = if area > 0.0 { sum / area } else { 0.0 };
    }
    means.into_iter().map(|mean| mean as f32).collect()
}
