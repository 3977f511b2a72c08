//! Can this polygon block any segment of a pair? The slow and sharp test, in f64, for the few
//! polygons that no plane of the shaft has outside.
//!
//! A segment from `p` to `q` is surely blocked by a polygon only if `p` and `q` lie deeper than
//! `tau` on opposite sides of its plane. So only the part of each element that lies so deep counts,
//! and the segments between those parts cross the plane within the hull of where vertex-vertex
//! segments cross it. The polygon is harmless if that hull is empty, for both ways of assigning the
//! sides, or lies beyond one of its edges. This covers with one rule, and without asking whose
//! polygon it is:
//!
//! * the polygons of a planar element itself, and all others in its plane;
//! * polygons that have both elements on one closed side;
//! * polygons of a wall that is flat only up to rounding, whose planes tilt by a few tau far away.

// Lanes of several arrays run in step: an index says so, and is what vectorises.
#![allow(clippy::needless_range_loop)]

use super::stored_polygon::StoredPolygon;
use super::tolerance::Tolerance;
use super::wide_corners::{Points, WideCorners};
use glam::DVec3;

/// False only if `polygon` surely blocks no segment between `a` and `b`, both grown by
/// [`Tolerance::nesting`]; so also of no pair inside them.
///
/// Error: heights are right to 2e-9 (see [`StoredPolygon::new`]), far inside the `tau - nesting`
/// that is compared with. The crossing test has a quarter of the weld distance to spare, because the
/// polygon is pulled in by only three quarters of it.
#[inline(always)]
pub(super) fn may_block(
    polygon: &StoredPolygon,
    a: &WideCorners,
    b: &WideCorners,
    tolerance: &Tolerance,
) -> bool {
    if let Some(known) = polygon.may_block_by_shape() {
        return known;
    }
    if blocks_centre_segment(polygon, a.centre, b.centre, tolerance) {
        return true;
    }
    let normal = polygon.normal;
    let v = corners_of(polygon);
    let (over_a, over_b) = (a.heights(v[0], normal), b.heights(v[0], normal));
    let depth = harmless_depth(tolerance);
    let nesting = f64::from(tolerance.nesting);
    let pull = polygon.pull(tolerance);
    for side in [1.0, -1.0] {
        let apart = if side > 0.0 {
            over_a.least < -depth && over_b.greatest > depth
        } else {
            over_a.greatest > depth && over_b.least < -depth
        };
        if !apart {
            continue;
        }
        let (mut room_a, mut room_b) = (None, None);
        let from = a.beyond(&over_a, -side, depth, &mut room_a);
        let to = b.beyond(&over_b, side, depth, &mut room_b);
        let (from_centre, to_centre) = (a.centre - v[0], b.centre - v[0]);
        let crosses =
            -side * normal.dot(from_centre) > depth && side * normal.dot(to_centre) > depth;
        let mut missed = false;
        for i in 0..3 {
            let edge = v[(i + 1) % 3] - v[i];
            // Where the segment between the centres passes inside the edge moved inwards, not all
            // pass outside. Moving it changes the number by less than this.
            let (p, q) = (a.centre - v[i], b.centre - v[i]);
            let moved = pull * edge.abs().element_sum() * (q - p).abs().element_sum();
            if crosses && side * edge.cross(p).dot(q) > moved {
                continue;
            }
            let length = edge.length();
            // The edge moved inwards within the plane.
            let start = v[i] + normal.cross(edge) * (pull / length);
            let growth = 1.001 * nesting * length;
            if all_pass_outside(start, edge * side, growth, &from, &to, nesting) {
                missed = true;
                break;
            }
        }
        if !missed {
            return true;
        }
    }
    false
}

/// The quick way to a yes: the segment between the centres crosses the polygon, deep on both sides
/// and inside its border.
#[inline(always)]
pub(super) fn blocks_centre_segment(
    polygon: &StoredPolygon,
    p: DVec3,
    q: DVec3,
    tolerance: &Tolerance,
) -> bool {
    if polygon.may_block_by_shape().is_some() {
        return false;
    }
    let v = corners_of(polygon);
    let (hp, hq) = (polygon.normal.dot(p - v[0]), polygon.normal.dot(q - v[0]));
    let deep = 4.0 * f64::from(tolerance.tau);
    if hp.abs() < deep || hq.abs() < deep || (hp > 0.0) == (hq > 0.0) {
        return false;
    }
    let x = p + (q - p) * (hp / (hp - hq));
    let mut inside = true;
    for i in 0..3 {
        let edge = v[(i + 1) % 3] - v[i];
        let across = edge.cross(x - v[i]).dot(polygon.normal);
        inside &= across > 0.0 && across * across > deep * deep * edge.length_squared();
    }
    inside
}

#[inline(always)]
fn corners_of(polygon: &StoredPolygon) -> [DVec3; 3] {
    let [a, b, c] = polygon.corners;
    [a.as_dvec3(), b.as_dvec3(), c.as_dvec3()]
}

/// Depth up to which a point of the bounds stands for points that are not deeper than `tau`.
#[inline(always)]
pub(super) fn harmless_depth(tolerance: &Tolerance) -> f64 {
    f64::from(tolerance.tau) - 1.001 * f64::from(tolerance.nesting)
}

/// True if every segment between the two point sets, both grown by `nesting`, passes on the outer
/// side of the edge: then so do the segments between their hulls, the number being bilinear.
/// `growth` is `nesting` times the edge's length, rounded up.
#[inline(always)]
fn all_pass_outside(
    start: DVec3,
    edge: DVec3,
    growth: f64,
    from: &Points,
    to: &Points,
    nesting: f64,
) -> bool {
    let mut first = 0;
    while first < to.count {
        let (mut dx, mut dy, mut dz) = ([0.0_f64; 8], [0.0_f64; 8], [0.0_f64; 8]);
        let mut far = [0.0_f64; 8];
        for l in 0..8 {
            dx[l] = to.x[first + l] - start.x;
            dy[l] = to.y[first + l] - start.y;
            dz[l] = to.z[first + l] - start.z;
            far[l] = growth * (dx[l].abs() + dy[l].abs() + dz[l].abs());
        }
        for i in 0..from.count {
            let p = from.point(i) - start;
            let w = edge.cross(p);
            let near = growth * (p.x.abs() + p.y.abs() + p.z.abs() + nesting);
            // Counting lanes that pass keeps a NaN from passing.
            let mut passed = [0_u64; 8];
            for l in 0..8 {
                let g = w.x * dx[l] + w.y * dy[l] + w.z * dz[l];
                passed[l] = u64::from(g + far[l] < -near);
            }
            let mut count = 0;
            for lane in passed {
                count += lane;
            }
            if count != 8 {
                return false;
            }
        }
        first += 8;
    }
    true
}
