//! Irradiance that any element of unit radiosity casts on a point, as a vector (see [`super::triangle_vector`]).

use super::element::{Element, Shape};
use super::facet_frame::FacetFrame;
use super::flux_tree::{Below, FluxNode, FluxTree};
use super::irradiance_kernel::POINT_RADII;
use super::triangle_vector::{SIX_POINT_RADII, quadrature, triangle_vector};
use crate::cluster::Hierarchy;
use crate::math::NodeId;
use crate::scene::Scene;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// Where elements stand.
#[derive(Clone, Copy)]
pub struct Space<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its hierarchy.
    pub hierarchy: &'a Hierarchy,
    /// The same, for sums over a cluster.
    pub flux_tree: &'a FluxTree,
    /// Where each facet lies.
    pub frames: &'a [FacetFrame],
    /// Depth below a surface within which nothing counts, normalised.
    pub tau: f32,
}

/// The vector K of a unit-radiosity element at a point. A cluster must face the point fully.
pub fn element_vector(space: &Space, source: &Element, point: Vec3, normal: Option<Vec3>) -> Vec3 {
    match source.shape {
        Shape::Triangle(corners) => triangle_vector(
            corners,
            source.normal,
            source.area,
            point,
            normal,
            space.tau,
        ),
        Shape::Cluster => cluster_vector(space, source.node, point, normal),
        Shape::Volume => Vec3::ZERO,
    }
}

/// The vector K of a cluster whose facets all face the point: the sum over parts that are far enough to stand as one.
fn cluster_vector(space: &Space, id: NodeId, point: Vec3, normal: Option<Vec3>) -> Vec3 {
    let node = space.flux_tree.node(id);
    let rel = node.centroid - point;
    let distance2 = rel.length_squared();
    match node.below() {
        Below::Children(_) if distance2 > node.reach2 => {
            match normal.is_none_or(|n| n.dot(rel) > 0.0) {
                true => node.vector_from(rel, distance2),
                false => Vec3::ZERO,
            }
        }
        Below::Children(first) => {
            cluster_vector(space, NodeId(first), point, normal)
                + cluster_vector(space, NodeId(first + 1), point, normal)
        }
        Below::Facet(facet) => {
            let flux = -node.area_vector.dot(rel);
            // Behind the facet, or within tau of its plane (see `triangle_vector`).
            if flux <= 0.0
                || flux * flux <= space.tau * space.tau * node.area_vector.length_squared()
            {
                return Vec3::ZERO;
            }
            let frame = &space.frames[facet];
            let radius2 = node.reach2 * (1.0 / (POINT_RADII * POINT_RADII));
            let depth = normal.map_or(f32::INFINITY, |n| n.dot(rel));
            // Wholly above or below the horizon, by a safe margin.
            if distance2 > SIX_POINT_RADII * SIX_POINT_RADII * radius2
                && depth * depth > 1.01 * radius2
            {
                return if depth < 0.0 {
                    Vec3::ZERO
                } else if distance2 > node.reach2 {
                    far_vector(node, rel, distance2)
                } else {
                    let corners = frame.corners().map(|corner| corner - point);
                    quadrature(corners, rel, flux, distance2, radius2)
                };
            }
            let (corners, area) = (frame.corners(), node.area_vector.length());
            triangle_vector(corners, frame.normal, area, point, normal, space.tau)
        }
    }
}

/// All of a node as if it stood at its centroid.
fn far_vector(node: &FluxNode, rel: Vec3, distance2: f32) -> Vec3 {
    let flux = (-node.area_vector.dot(rel)).max(0.0);
    let inverse = 1.0 / distance2;
    rel * (flux * inverse * inverse * FRAC_1_PI)
}
