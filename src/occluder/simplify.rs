//! Dropping vertices of contours without ever covering more.
//!
//! Cutting a convex corner off a contour with the surface on its left lowers the winding number by
//! one over the cut triangle and changes it nowhere else, whatever other contours pass through
//! that triangle. So the region of positive winding only shrinks.

use glam::DVec2;

/// The closed `contour` (surface on its left) without corners that cutting moves the contour
/// inwards by at most `tolerance`.
pub(super) fn simplify_inwards(contour: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let count = contour.len();
    let mut kept = Vec::new();
    let mut from = 0;
    while from < count {
        kept.push(contour[from]);
        from = furthest(contour, from, tolerance);
    }
    kept
}

/// The last vertex that a chord from `from` may reach with all vertices between on its right, none
/// further than `tolerance` away; at most one round.
fn furthest(contour: &[DVec2], from: usize, tolerance: f64) -> usize {
    let start = contour[from];
    let mut best = from + 1;
    // Doubling the length tried keeps long jagged runs linear times a logarithm.
    let mut step = 1;
    while step > 0 {
        let to = best + step;
        let allowed = to <= contour.len()
            && chord_cuts_corners(
                start,
                contour[to % contour.len()],
                &contour[from + 1..to],
                tolerance,
            );
        if allowed {
            best = to;
            step *= 2;
        } else {
            step /= 2;
        }
    }
    best
}

fn chord_cuts_corners(start: DVec2, end: DVec2, between: &[DVec2], tolerance: f64) -> bool {
    let along = end - start;
    let length = along.length();
    // A run monotone along the chord and wholly on its right bounds, with the chord, one simple
    // polygon counter-clockwise: what the contour loses, once.
    let mut last = 0.0;
    length > 0.0
        && between.iter().chain([&end]).all(|&p| {
            let t = along.dot(p - start);
            let forward = t >= last;
            last = t;
            let left = along.perp_dot(p - start);
            forward && (p == end || (left <= 0.0 && left >= -tolerance * length))
        })
}
