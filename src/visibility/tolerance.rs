//! The lengths within which a guarantee promises nothing.
//!
//! A segment is *surely blocked* when some polygon has its ends on opposite sides of the polygon's
//! plane, both deeper than `tau`, and the segment crosses the polygon more than `weld` inside its
//! border. It is *surely clear* when, cut back by `tau` at both ends, it stays farther than `weld`
//! from every polygon. A visibility claim is false if a segment of its pair is surely blocked, an
//! occlusion claim if one is surely clear; in between lie grazing, shared edges and welded cracks.

use crate::math::Aabb;

/// Lengths in normalised units, all in proportion to the scene's diagonal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Depth below a plane that does not count as being behind it.
    pub tau: f32,
    /// Cracks narrower than this are closed, overlaps narrower than this are contacts.
    pub weld: f32,
    /// How far a vertex of an element may lie outside the bounds of its ancestors: every predicate
    /// treats an element as all points within this distance of its bounds, so that a claim proved
    /// for a pair holds for every pair below it.
    ///
    /// 2^-22 of the diagonal: a coordinate is at most half the diagonal, so rounding a vertex to
    /// f32 moves it by at most 2^-25 of the diagonal. That leaves room for 8 roundings that all
    /// conspire; a patch corner computed in f64 and rounded once uses one of them.
    pub nesting: f32,
    /// Bound on the magnitude of any coordinate.
    pub reach: f32,
}

impl Tolerance {
    /// `tau` and `weld` over the diagonal: a million f32 roundings of a coordinate are 0.03 of it,
    /// sixteen are 5e-7, so 1e-6 is the least that the predicates' own margins fit into.
    const RELATIVE: f32 = 1.0e-6;

    /// The tolerances of a scene with these normalised bounds.
    pub fn of_scene(bounds: Aabb) -> Self {
        let diagonal = if bounds.is_empty() {
            0.0
        } else {
            bounds.diagonal()
        };
        let tau = diagonal * Self::RELATIVE;
        let extreme = bounds.min.abs().max(bounds.max.abs()).max_element();
        Self {
            tau,
            weld: tau,
            nesting: diagonal / 4_194_304.0,
            // Bounds of elements stick out of the scene by their margins, a few tau.
            reach: if extreme.is_finite() {
                extreme + 64.0 * tau
            } else {
                0.0
            },
        }
    }
}
