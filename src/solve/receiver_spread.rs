//! How the irradiance varies over a flat cluster, from the vector at its centroid: to first order, and of the second what
//! its mean differs by.
//!
//! A source of area vector `n_s` a way `d` from a point with the normal `n_r` casts `E = q h / |d|^4` on it (up to a
//! factor), `q = -n_s . d` and `h = n_r . d`. With `P` the projection on the receiver's plane, moving the point in that plane
//! changes it by `E (P n_s / q + 4 P d / |d|^2)`, and its Laplacian in the plane is
//! `E (8 (P d . n_s) / q - 8 + 24 |P d|^2 / |d|^2) / |d|^2`. The mean over points with the mean square `m`, in all directions
//! alike, takes `m / 4` of that.

use super::element::Element;
use crate::cluster::ClusterShape;
use glam::Vec3;

/// Most that the mean over a cluster may be taken to differ from its centroid's: beyond, higher orders decide.
const MOST_CHANGE: f32 = 0.25;
/// Half the width of a square over the root of the mean square of its points, about: where a slope must not have taken
/// the irradiance below zero.
const REACH2_OVER_MEAN_SQUARE: f32 = 3.0;

/// What the irradiance `vector` of `source` at the centroid of a flat `receiver` has to be multiplied with for its mean, and
/// the slope of the irradiance along its plane.
pub(super) fn spread_over(
    receiver: &ClusterShape,
    mean_square: f32,
    source: &Element,
    vector: Vec3,
) -> (f32, Vec3) {
    let n = receiver.area_vector.normalize_or_zero();
    let d = source.centroid - receiver.centroid;
    let inverse = 1.0 / d.length_squared();
    let (height, q) = (n.dot(d), -source.normal.dot(d));
    let across = d - n * height;
    // The source's normal along the receiver's plane, over q.
    let tilt = match q > 0.0 {
        true => (source.normal - n * n.dot(source.normal)) * (1.0 / q),
        false => Vec3::ZERO,
    };
    let along2 = across.length_squared() * inverse;
    let change = 0.25 * mean_square * inverse * (8.0 * across.dot(tilt) + 24.0 * along2 - 8.0);
    let slope = (tilt + across * (4.0 * inverse)) * n.dot(vector);
    // Nowhere on the cluster below zero.
    let (reach2, most) = (REACH2_OVER_MEAN_SQUARE * mean_square, n.dot(vector));
    let steep2 = slope.length_squared() * reach2;
    let share = match steep2 > most * most {
        true => most.max(0.0) / steep2.sqrt(),
        false => 1.0,
    };
    let mean = 1.0 + change.clamp(-MOST_CHANGE, MOST_CHANGE);
    (mean, slope * share)
}
