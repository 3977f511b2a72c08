//! Flat, large clusters: where occluders may be found (paper, section 3.1 and 3.2).

use super::config::OccluderConfig;
use crate::cluster::{Hierarchy, NodeKind};
use crate::math::{Aabb, NodeId};
use crate::scene::{Facet, Scene};
use glam::Vec3;

/// Triangles whose altitude is below this fraction of the scene's diagonal are slivers: rounding of
/// their vertices to f32 alone turns their normals by a degree or so.
const SLIVER_ALTITUDE: f64 = 1.0e-5;

/// A cluster within this fraction of the diagonal of one side of the scene's box lies on it: nothing
/// is behind it.
const ON_BOX: f32 = 1.0e-5;

/// The flat nodes of `hierarchy` that are big enough, highest in the tree first come, without those
/// on the scene's bounding box and without second sides of sheets already listed; ascending.
pub fn flat_clusters(scene: &Scene, hierarchy: &Hierarchy, config: &OccluderConfig) -> Vec<NodeId> {
    if hierarchy.nodes.is_empty() {
        return Vec::new();
    }
    let bounds = scene.bounds();
    let diagonal = bounds.diagonal();
    let min_area = (config.min_area * f64::from(diagonal).powi(2)) as f32;
    let mut flat = Vec::new();
    let mut open = vec![Hierarchy::ROOT];
    while let Some(id) = open.pop() {
        let shape = hierarchy.shape(id);
        if shape.area < min_area || lies_on_box(hierarchy.node(id).bounds, bounds) {
            continue;
        }
        if is_flat(scene, hierarchy, id, f64::from(diagonal), config) {
            flat.push(id);
        } else if let Some(children) = hierarchy.children(id) {
            open.extend(children);
        }
    }
    without_twins(scene, hierarchy, flat, min_area)
}

/// True when `bounds` is a thin layer along one side of `scene`.
fn lies_on_box(bounds: Aabb, scene: Aabb) -> bool {
    let layer = Vec3::splat(ON_BOX * scene.diagonal());
    (bounds.max.cmple(scene.min + layer) | bounds.min.cmpge(scene.max - layer)).any()
}

fn is_flat(
    scene: &Scene,
    hierarchy: &Hierarchy,
    id: NodeId,
    diagonal: f64,
    config: &OccluderConfig,
) -> bool {
    let (node, shape) = (hierarchy.node(id), hierarchy.shape(id));
    if node.kind == NodeKind::Volume {
        return false;
    }
    // Area over length: the short side of a long strip.
    let width = f64::from(shape.area) / f64::from(node.bounds.diagonal()).max(f64::MIN_POSITIVE);
    if f64::from(shape.deviation) > width * config.flatness_degrees.to_radians().tan() {
        return false;
    }
    let Some(axis) = shape.area_vector.try_normalize() else {
        return false;
    };
    let limit = config.cone_degrees.to_radians();
    // The cone has slivers in it; only where it is too wide are the facets looked at one by one.
    let spread = f64::from(axis.angle_between(shape.cone.axis) + shape.cone.half_angle);
    spread <= limit
        || hierarchy.facets[hierarchy.facet_range(id)]
            .iter()
            .all(|&facet| points_along(scene, facet, axis, limit.cos(), SLIVER_ALTITUDE * diagonal))
}

/// True for slivers, and for facets whose normal is within the angle of `axis`.
fn points_along(scene: &Scene, facet: Facet, axis: Vec3, least_cosine: f64, sliver: f64) -> bool {
    let [a, b, c] = scene.facet_corners(facet).map(|p| p.as_dvec3());
    let normal = (b - a).cross(c - a);
    let longest = (b - a).length().max((c - b).length()).max((a - c).length());
    normal.length() < sliver * longest
        || normal.dot(axis.as_dvec3()) >= least_cosine * normal.length()
}

/// Front and back of a polygon are two facets and may lie in two clusters; their sheet is one. The
/// largest cluster takes the polygons; another stays only if it brings enough polygons of its own.
fn without_twins(
    scene: &Scene,
    hierarchy: &Hierarchy,
    mut flat: Vec<NodeId>,
    min_area: f32,
) -> Vec<NodeId> {
    flat.sort_unstable_by(|&a, &b| {
        let area = |id| hierarchy.shape(id).area;
        area(b).total_cmp(&area(a)).then(a.cmp(&b))
    });
    let mut taken = vec![false; scene.polygons.len()];
    flat.retain(|&id| {
        let facets = &hierarchy.facets[hierarchy.facet_range(id)];
        let own: f64 = facets
            .iter()
            .filter(|facet| !taken[facet.polygon.index()])
            .map(|facet| {
                let [a, b, c] = scene.corners(facet.polygon).map(|p| p.as_dvec3());
                0.5 * (b - a).cross(c - a).length()
            })
            .sum();
        // Half the least area: sums of f32 and f64 differ, and a tie must not depend on that.
        let keep = own >= 0.5 * f64::from(min_area);
        if keep {
            facets.iter().for_each(|f| taken[f.polygon.index()] = true);
        }
        keep
    });
    flat.sort_unstable();
    flat
}
