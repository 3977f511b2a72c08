//! Replay of a visibility claim by brute force: every polygon of the scene against the hull of the two
//! elements, in exact arithmetic.

use crate::math::{Aabb, PolygonId};
use crate::visibility::exact::{PolygonStanding, judge_polygon};
use crate::visibility::{ElementBounds, SceneTree};
use glam::{DVec3, Vec3};

/// What the polygons of one claim are.
#[derive(Clone, Debug, Default)]
pub(super) struct ShaftReplay {
    /// Polygons shown to be harmless or outside.
    pub proved: u64,
    /// Polygons that reach into the hull by less than any segment would notice: neither proved nor
    /// refuted.
    pub undecided: u64,
    /// A polygon that surely blocks this segment of the pair.
    pub blocked: Option<(PolygonId, [DVec3; 2])>,
}

/// Judges every polygon.
pub(super) fn replay_visibility(
    scene: &SceneTree,
    a: &ElementBounds,
    b: &ElementBounds,
) -> ShaftReplay {
    let mut replay = ShaftReplay::default();
    let hull = a.aabb().union(b.aabb());
    for (id, corners) in scene.polygons() {
        // Boxes with no point in common part their contents: comparisons are exact.
        let own = Aabb::from_points(corners);
        let apart = own.min.cmpgt(hull.max).any() || own.max.cmplt(hull.min).any();
        if apart || is_surely_harmless(scene, corners, a, b) {
            replay.proved += 1;
            continue;
        }
        match judge_polygon(a, b, corners, scene.tolerance()) {
            PolygonStanding::Outside | PolygonStanding::Harmless => replay.proved += 1,
            PolygonStanding::NotRefuted => replay.undecided += 1,
            PolygonStanding::Blocks(p, q) => {
                replay.blocked.get_or_insert((id, [p, q]));
            }
        }
    }
    replay
}

/// The quick way to [`PolygonStanding::Harmless`], in f64 where that leaves no doubt.
///
/// A height over the plane is a triple product of differences of f32 numbers below 2, over the
/// normal's length. The product's rounding is below 1e-14 |e1| |e2|, so where the normal is longer
/// than a hundredth of |e1| |e2| a height is wrong by less than 1e-12.
fn is_surely_harmless(
    scene: &SceneTree,
    corners: [Vec3; 3],
    a: &ElementBounds,
    b: &ElementBounds,
) -> bool {
    const DOUBT: f64 = 1.0e-11;
    let [p, q, r] = corners.map(Vec3::as_dvec3);
    let (e1, e2) = (q - p, r - p);
    let normal = e1.cross(e2);
    let length = normal.length();
    // Also false for NaN.
    let fat = length > 0.01 * e1.length() * e2.length();
    if !fat {
        return false;
    }
    let range = |bounds: &ElementBounds| {
        bounds
            .corners()
            .map(|c| normal.dot(c.as_dvec3() - p) / length)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| {
                (low.min(h), high.max(h))
            })
    };
    let deep = f64::from(scene.tolerance().tau) - DOUBT;
    let ((a_low, a_high), (b_low, b_high)) = (range(a), range(b));
    let across = (a_high > deep && b_low < -deep) || (b_high > deep && a_low < -deep);
    !across
}
