//! The proof of an occlusion claim, replayed: all pairs of corners against both faces of the slab.

use crate::occluder::SlabRectangle;
use crate::visibility::{ElementBounds, Tolerance};
use glam::DVec3;
use robust::{Coord3D, orient3d};

/// Why the proof of an occlusion claim does not hold.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum OcclusionFlaw {
    /// A corner is not beyond the slab by more than `tau`, or not on its element's side.
    #[error("the slab does not separate the elements by more than tau")]
    NotSeparated,
    /// The segment between corner `a` of the first and corner `b` of the second element passes
    /// beside an edge of a face.
    #[error("the segment between corners {a} and {b} misses edge {edge} of a face")]
    Missed {
        /// Corner of the first element.
        a: usize,
        /// Corner of the second element.
        b: usize,
        /// Edge of the face, starting at the corner of that number.
        edge: usize,
    },
    /// An element is not beyond one face of the solid by more than `tau`.
    #[error("an element is not outside of the solid by more than tau")]
    NotOutside,
    /// Segments may come into the solid and leave it through faces that nothing covers.
    #[error("segments may pass the solid through faces that are open")]
    OpenFace,
    /// A polygon of the surface may come within `tau` of an element.
    #[error("the surface comes within tau of an element")]
    TouchesSurface,
    /// The surface is taken to stick out by the weld distance or more.
    #[error("the surface sticks out too far")]
    LongOverhang,
    /// Segments may pass the border of the surface.
    #[error("segments may pass the border of the surface from {from} to {to}")]
    OpenBorder {
        /// One end of the edge, normalised.
        from: DVec3,
        /// The other.
        to: DVec3,
    },
    /// The surface is crossed as often in one sense as in the other.
    #[error("segments may pass the surface without crossing it")]
    NotCrossed,
    /// The segment between these corners misses the solid.
    #[error("the segment between corners {a} and {b} misses the solid")]
    MissesSolid {
        /// Corner of the first element.
        a: usize,
        /// Corner of the second element.
        b: usize,
    },
}

/// Checks with exact orientation tests that every segment between a corner of `a` and a corner of
/// `b` passes through both faces of `slab` ([`SlabRectangle::face_corners`]), and that both elements
/// lie beyond the slab widened by `tau`. By convexity the same then holds for all points of both.
pub fn replay_occlusion(
    slab: &SlabRectangle,
    a: &ElementBounds,
    b: &ElementBounds,
    tolerance: &Tolerance,
) -> Result<(), OcclusionFlaw> {
    let (from, to): (Vec<DVec3>, Vec<DVec3>) = (
        a.corners().map(|c| c.as_dvec3()).collect(),
        b.corners().map(|c| c.as_dvec3()).collect(),
    );
    let widened = SlabRectangle {
        half_thickness: slab.half_thickness + tolerance.tau,
        ..*slab
    };
    // Which element is above (on the normal's side)?
    let above = |points: &[DVec3], side: f64| {
        points
            .iter()
            .all(|&p| beyond(&widened.face_corners(side), p, side))
    };
    let sign = if above(&to, 1.0) && above(&from, -1.0) {
        1.0
    } else if above(&from, 1.0) && above(&to, -1.0) {
        -1.0
    } else {
        return Err(OcclusionFlaw::NotSeparated);
    };
    for side in [1.0, -1.0] {
        let face = slab.face_corners(side);
        for edge in 0..4 {
            let (start, end) = (face[edge], face[(edge + 1) % 4]);
            for (i, &p) in from.iter().enumerate() {
                for (j, &q) in to.iter().enumerate() {
                    if sign * determinant(end, p, q, start) <= 0.0 {
                        return Err(OcclusionFlaw::Missed { a: i, b: j, edge });
                    }
                }
            }
        }
    }
    Ok(())
}

/// True if `p` is on the `side` of the face's planes, whichever three corners span them.
pub(super) fn beyond(face: &[DVec3; 4], p: DVec3, side: f64) -> bool {
    (0..4).all(|i| {
        let (u, v, w) = (face[i], face[(i + 1) % 4], face[(i + 2) % 4]);
        side * determinant(v, w, p, u) > 0.0
    })
}

/// The sign of `det(a - d, b - d, c - d)`, exact.
pub(super) fn determinant(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let coord = |v: DVec3| Coord3D {
        x: v.x,
        y: v.y,
        z: v.z,
    };
    orient3d(coord(a), coord(b), coord(c), coord(d))
}
