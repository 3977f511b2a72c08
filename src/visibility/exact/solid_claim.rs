//! The proof of an occlusion claim that rests on a solid, replayed: all segments between corners meet it.

use super::occlusion_claim::{OcclusionFlaw, beyond, determinant};
use crate::occluder::Solid;
use crate::visibility::{ElementBounds, Tolerance};
use glam::DVec3;

/// Checks with exact orientation tests that every segment between a corner of `a` and a corner of `b` crosses a triangle
/// of corners of `solid`, and so meets their hull, and that each element lies beyond one face by `tau`. By convexity
/// ([`Solid`]) the same then holds for all points of both.
///
/// # Errors
/// What does not hold.
pub fn replay_solid_occlusion(
    solid: &Solid,
    a: &ElementBounds,
    b: &ElementBounds,
    tolerance: &Tolerance,
) -> Result<(), OcclusionFlaw> {
    let corners =
        |bounds: &ElementBounds| -> Vec<DVec3> { bounds.corners().map(|c| c.as_dvec3()).collect() };
    let (from, to) = (corners(a), corners(b));
    let mut triangles = Vec::with_capacity(12);
    let mut outer = Vec::with_capacity(6);
    let mut open = Vec::new();
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let face @ [p, q, r, s] = solid.face(axis, side);
            triangles.extend([[p, q, r], [p, r, s]]);
            let normal = (q - p).cross(r - q).normalize();
            let outwards = normal * (side * normal.dot(solid.halves[axis].as_dvec3())).signum();
            let shift = outwards * f64::from(tolerance.tau);
            // The sense in which a point is on the outer side of the face as it runs.
            let sense = determinant(q, r, p + outwards, p).signum();
            outer.push((face.map(|c| c + shift), sense));
            if !solid.covered[axis][usize::from(side > 0.0)] {
                open.push((face, sense));
            }
        }
    }
    let is_outside = |points: &[DVec3]| {
        outer
            .iter()
            .any(|(face, sense)| points.iter().all(|&p| beyond(face, p, *sense)))
    };
    if !is_outside(&from) || !is_outside(&to) {
        return Err(OcclusionFlaw::NotOutside);
    }
    // No segment comes in through a face of which the end is not beyond.
    let comes_in = |points: &[DVec3]| {
        let beyond_any = |(face, sense): &([DVec3; 4], f64)| {
            let not_inside = |&p: &DVec3| !beyond(face, p, -sense);
            points.iter().any(not_inside)
        };
        open.iter().any(beyond_any)
    };
    if comes_in(&from) && comes_in(&to) {
        return Err(OcclusionFlaw::OpenFace);
    }
    for (i, &p) in from.iter().enumerate() {
        for (j, &q) in to.iter().enumerate() {
            if !triangles.iter().any(|triangle| crosses(*triangle, p, q)) {
                return Err(OcclusionFlaw::MissesSolid { a: i, b: j });
            }
        }
    }
    Ok(())
}

/// True if the segment from `p` to `q` meets the triangle and is not in its plane: exactly.
fn crosses([a, b, c]: [DVec3; 3], p: DVec3, q: DVec3) -> bool {
    let (over_p, over_q) = (determinant(a, b, c, p), determinant(a, b, c, q));
    let apart = (over_p >= 0.0 && over_q <= 0.0) || (over_p <= 0.0 && over_q >= 0.0);
    if !apart || (over_p == 0.0 && over_q == 0.0) {
        return false;
    }
    let around = [(a, b), (b, c), (c, a)].map(|(u, v)| determinant(u, v, p, q));
    around.iter().all(|&s| s >= 0.0) || around.iter().all(|&s| s <= 0.0)
}
