//! The shape of the surface under a node: area, plane, deviation and cone of normals.
//!
//! Everything is computed from the facets themselves rather than merged from the children, so that
//! cones and deviations do not widen from level to level; the work is facets times depth.

use super::hierarchy::{ClusterShape, Node};
use crate::math::{Cone, Plane};
use crate::scene::{Facet, Scene};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// A sum of area vectors shorter than this share of the area (facets facing all ways) points nowhere.
const DIRECTED_SHARE: f64 = 1.0e-6;

/// Covers the rounding of an angle computed in f64 from unit vectors (a few 2^-53 each).
const ANGLE_ROUNDING: f64 = 1.0e-14;

/// The shapes of `nodes`, whose ranges index `facets`.
pub(super) fn cluster_shapes(scene: &Scene, facets: &[Facet], nodes: &[Node]) -> Vec<ClusterShape> {
    let corners: Vec<[Vec3; 3]> = facets.iter().map(|&f| scene.facet_corners(f)).collect();
    nodes
        .par_iter()
        .map(|node| {
            let first = node.first_facet as usize;
            shape_of(&corners[first..first + node.facet_count as usize])
        })
        .collect()
}

/// Twice the area times the unit normal of a facet, in f64 from its f32 corners, where the
/// differences are exact for corners within a factor of two and the products exact always.
pub(super) fn doubled_area_vector(corners: &[Vec3; 3]) -> DVec3 {
    let [a, b, c] = corners.map(|v| v.as_dvec3());
    (b - a).cross(c - a)
}

/// The shape of a set of facets given by their corners, counter-clockwise seen from their side.
pub(super) fn shape_of(corners: &[[Vec3; 3]]) -> ClusterShape {
    let mut doubled_area = 0.0;
    let mut doubled_vector = DVec3::ZERO;
    let mut moment = DVec3::ZERO;
    let (mut least, mut greatest) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for triangle in corners {
        let vector = doubled_area_vector(triangle);
        let length = vector.length();
        let sum: DVec3 = triangle.iter().map(|v| v.as_dvec3()).sum();
        doubled_area += length;
        doubled_vector += vector;
        moment += sum * length;
        if length > 0.0 {
            least = least.min(vector / length);
            greatest = greatest.max(vector / length);
        }
    }
    let centroid = if doubled_area > 0.0 {
        moment / (3.0 * doubled_area)
    } else {
        let points = corners.iter().flatten().map(|v| v.as_dvec3());
        points.sum::<DVec3>() / (3 * corners.len()) as f64
    };
    let directed = doubled_vector.length() > DIRECTED_SHARE * doubled_area;
    let mean = if directed {
        doubled_vector
    } else {
        DVec3::ZERO
    };
    let cone = narrower(
        cone_around(mean, corners),
        cone_around(least + greatest, corners),
    );
    let normal = mean.try_normalize().map_or(cone.axis, DVec3::as_vec3);
    let (plane, deviation) = fit_plane(normal, corners);
    ClusterShape {
        area: (0.5 * doubled_area) as f32,
        centroid: centroid.as_vec3(),
        area_vector: (0.5 * doubled_vector).as_vec3(),
        cone,
        plane,
        deviation,
    }
}

fn narrower(a: Cone, b: Cone) -> Cone {
    if b.half_angle < a.half_angle { b } else { a }
}

/// The narrowest cone around `axis` (any length) that contains the normals of all facets that have one.
fn cone_around(axis: DVec3, corners: &[[Vec3; 3]]) -> Cone {
    let Some(axis) = axis.try_normalize().map(DVec3::as_vec3) else {
        return Cone::EVERYTHING;
    };
    // The cone is about the rounded axis.
    let exact = axis.as_dvec3().normalize();
    let chord_squared = corners
        .iter()
        .filter_map(|triangle| doubled_area_vector(triangle).try_normalize())
        .map(|normal| normal.distance_squared(exact))
        .fold(0.0, f64::max);
    let half_angle = 2.0 * (0.5 * chord_squared.sqrt()).min(1.0).asin() + ANGLE_ROUNDING;
    Cone {
        axis,
        half_angle: round_up(half_angle).min(std::f32::consts::PI),
    }
}

/// The plane of the given unit normal that halves the range of the vertices' heights, and the
/// greatest distance of a vertex to it, rounded up.
fn fit_plane(normal: Vec3, corners: &[[Vec3; 3]]) -> (Plane, f32) {
    let direction = normal.as_dvec3();
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for vertex in corners.iter().flatten() {
        let height = direction.dot(vertex.as_dvec3());
        low = low.min(height);
        high = high.max(height);
    }
    let plane = Plane {
        normal,
        offset: (0.5 * (low + high)) as f32,
    };
    let offset = f64::from(plane.offset);
    // Products of f32 are exact in f64; the two additions and the difference round by less than
    // 2^-51 of the greatest term. Dividing by a length just below one turns heights into distances.
    let rounding = (low.abs() + high.abs() + offset.abs()) * 2.0 * f64::EPSILON;
    let deviation = (high - offset).max(offset - low) + rounding;
    let deviation = deviation / direction.length().min(1.0);
    (plane, round_up(deviation))
}

/// The least f32 that is not below `value`.
fn round_up(value: f64) -> f32 {
    let rounded = value as f32;
    if f64::from(rounded) < value {
        rounded.next_up()
    } else {
        rounded
    }
}
