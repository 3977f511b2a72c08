//! Irradiance that any element of unit radiosity casts on a point, as a vector (see [`super::triangle_vector`]).

use super::element::{Element, Shape};
use super::triangle_vector::triangle_vector;
use crate::cluster::Hierarchy;
use crate::math::NodeId;
use crate::scene::Scene;
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// A cluster is taken as one flux vector beyond this many radii (its radius bounds its box, about
/// twice its radius of gyration, so the error is below (1/16)^2 = 4e-3), else as its two children. Between 6 and 12
/// the error of a solve does not change; 12 makes pass 2 of c a sixth slower than 6 (`bench/runs/`, accuracy).
const CLUSTER_RADII: f32 = 8.0;

/// Where elements stand.
#[derive(Clone, Copy)]
pub struct Space<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its hierarchy.
    pub hierarchy: &'a Hierarchy,
    /// The element of each node.
    pub elements: &'a [Element],
    /// Unit normal of each facet.
    pub normals: &'a [Vec3],
    /// Sums of the sources' power before each facet, and of all.
    pub power_before: &'a [f64],
    /// Depth below a surface within which nothing counts, normalised.
    pub tau: f32,
}

/// The vector K of a unit-radiosity element at a point. A cluster must face the point fully.
pub fn element_vector(
    space: &Space,
    source: &Element,
    point: Vec3,
    normal: Option<Vec3>,
    flat: bool,
) -> Vec3 {
    match source.shape {
        Shape::Triangle(corners) => triangle_vector(
            corners,
            source.normal,
            source.area,
            point,
            normal,
            space.tau,
        ),
        Shape::Cluster if flat => cluster_vector(space, source.node, point, normal),
        Shape::Cluster => wide_vector(space, source, point, normal),
        Shape::Volume => Vec3::ZERO,
    }
}

/// The vector K of a cluster of any shape and mean radiosity 1, seen from far away: every facet that faces the point
/// counts by its power, as if it stood at the centroid, since lamps seldom shine the way their housings face. What hides behind other facets is left to visibility.
fn wide_vector(space: &Space, source: &Element, point: Vec3, normal: Option<Vec3>) -> Vec3 {
    let rel = source.centroid - point;
    if normal.is_some_and(|n| n.dot(rel) <= 0.0) {
        return Vec3::ZERO;
    }
    let inverse = 1.0 / rel.length_squared();
    let range = source.facet_range();
    let whole = space.power_before[range.end] - space.power_before[range.start];
    let mut flux = 0.0f32;
    for facet in range {
        let power = space.power_before[facet + 1] - space.power_before[facet];
        // The area that would send as much at the cluster's mean radiosity.
        let area = source.area * (power / whole) as f32;
        flux += area * (-space.normals[facet].dot(rel)).max(0.0);
    }
    rel * (flux * inverse * inverse * FRAC_1_PI)
}

fn cluster_vector(space: &Space, id: NodeId, point: Vec3, normal: Option<Vec3>) -> Vec3 {
    let Some(children) = space.hierarchy.children(id) else {
        let leaf = &space.elements[id.index()];
        return element_vector(space, leaf, point, normal, true);
    };
    let node = space.hierarchy.node(id);
    let shape = space.hierarchy.shape(id);
    let rel = shape.centroid - point;
    let distance2 = rel.length_squared();
    let half = (node.bounds.max - node.bounds.min) * 0.5;
    if distance2 > CLUSTER_RADII * CLUSTER_RADII * half.length_squared() {
        let flux = (-shape.area_vector.dot(rel)).max(0.0);
        let inverse = 1.0 / distance2;
        let above = normal.is_none_or(|n| n.dot(rel) > 0.0);
        return if above {
            rel * (flux * inverse * inverse * FRAC_1_PI)
        } else {
            Vec3::ZERO
        };
    }
    children
        .into_iter()
        .map(|child| cluster_vector(space, child, point, normal))
        .sum()
}
