//! From a covered rectangle of the plane to an occluder in f32, rounded so that it claims no more.

use super::footprint::{CONTOUR_ERROR, Footprint};
use super::frame::PlaneFrame;
use super::rectangle::Rectangle;
use super::set::Occluder;
use super::sheet::Sheet;
use super::slab::SlabRectangle;
use crate::math::NodeId;
use glam::{DVec2, DVec3};

/// First distance, in normalised units, kept for rounding to f32. The coordinates of the centre and
/// the halves round by at most 2^-26, the two sums of a corner by as much each, and mostly by less.
/// The result is checked, and the distance doubled if it fails.
const FIRST_MARGIN: f64 = 1.0 / (1u64 << 24) as f64;

/// Attempts before giving up; a margin beyond 2^-19 would mean a broken invariant.
const ATTEMPTS: usize = 6;

/// How far from the polygons, in w, a segment through the faces may stay sideways. A planar sheet adds
/// at most w/4 in height: sqrt(0.95^2 + 0.25^2) < 0.983, and the contours' error is far below the rest.
const SIDEWAYS: f64 = 0.95;

/// How far the faces may stick out over the border of `footprint` on each side.
///
/// Take a segment through both faces of the larger slab and shrink the plane, heights kept, about
/// the rectangle's centre until the larger rectangle becomes the smaller one. The image of the
/// segment is a segment through both faces of the smaller slab; it meets the surface, or a strip
/// within `strip_reach` of it. Shrinking moves no point by more than a corner's sqrt(2) overhangs, so the
/// segment itself passes within sqrt(2) overhang + strip_reach of the polygons.
///
/// Which side of a crack moves to the other is arbitrary. The border is kept within that of the other choice too, up to
/// strip_reach further in, lest a replay that closes it the other way finds the overhang too great by a hair.
fn overhang(footprint: &Footprint, weld: f64) -> f64 {
    let reach = footprint.strip_reach;
    ((SIDEWAYS * weld - reach) / std::f64::consts::SQRT_2 - reach).max(-reach)
}

/// The occluder of `rectangle`, which lies in the plane of `frame` (the sheet's, turned) and is
/// covered by `footprint`; `None` where rounding leaves nothing of it.
pub(super) fn thicken(
    sheet: &Sheet,
    footprint: &Footprint,
    frame: &PlaneFrame,
    rectangle: Rectangle,
    weld: f64,
    flush: bool,
    node: NodeId,
) -> Option<Occluder> {
    let [bottom, top] = heights(sheet, footprint, frame, rectangle);
    let outwards = if flush {
        overhang(footprint, weld)
    } else {
        // Welding may have moved the border outwards by as much.
        -footprint.strip_reach
    };
    let safe = rectangle.inset(DVec2::splat(CONTOUR_ERROR - outwards));
    let mut margin = FIRST_MARGIN;
    for _ in 0..ATTEMPTS {
        let occluder = round(
            frame,
            safe.inset(DVec2::splat(margin)),
            bottom,
            top,
            margin,
            node,
        )?;
        if is_within(&occluder, frame, safe, bottom, top) {
            return Some(occluder);
        }
        margin *= 2.0;
    }
    None
}

/// Lowest and highest point of the surface over `rectangle`, in the frame.
fn heights(
    sheet: &Sheet,
    footprint: &Footprint,
    frame: &PlaneFrame,
    rectangle: Rectangle,
) -> [f64; 2] {
    if footprint.planar {
        return [-sheet.deviation, sheet.deviation];
    }
    let axis = DVec2::new(frame.u.dot(sheet.frame.u), frame.u.dot(sheet.frame.v));
    let turn = |p: DVec3| DVec2::new(axis.dot(p.truncate()), axis.perp_dot(p.truncate()));
    let [mut low, mut high] = [f64::INFINITY, f64::NEG_INFINITY];
    // Strips of welded cracks may reach over the rectangle from triangles this far outside.
    let reach = footprint.strip_reach;
    let wide = rectangle.inset(DVec2::splat(-reach));
    for triangle in &sheet.triangles {
        let corners = triangle.map(|v| sheet.positions[v as usize]);
        let [a, b, c] = corners.map(turn);
        let apart = a.max(b).max(c).cmplt(wide.min) | a.min(b).min(c).cmpgt(wide.max);
        if !apart.any() {
            low = corners.iter().fold(low, |low, p| low.min(p.z));
            high = corners.iter().fold(high, |high, p| high.max(p.z));
        }
    }
    [low - reach, high + reach]
}

fn round(
    frame: &PlaneFrame,
    rectangle: Rectangle,
    bottom: f64,
    top: f64,
    margin: f64,
    node: NodeId,
) -> Option<Occluder> {
    let half = 0.5 * rectangle.size();
    if half.cmple(DVec2::ZERO).any() || !(top - bottom).is_finite() {
        return None;
    }
    let centre = frame.lift(rectangle.centre().extend(0.5 * (bottom + top)));
    let slab = SlabRectangle::new(
        centre.as_vec3(),
        (frame.u * half.x).as_vec3(),
        (frame.v * half.y).as_vec3(),
        frame.n.as_vec3(),
        ((0.5 * (top - bottom) + margin) as f32).next_up(),
    );
    Some(Occluder { slab, node })
}

/// True when both faces project into `safe` and lie above `top` and below `bottom`.
fn is_within(
    occluder: &Occluder,
    frame: &PlaneFrame,
    safe: Rectangle,
    bottom: f64,
    top: f64,
) -> bool {
    let inside = |p: DVec3| {
        let p = p.truncate();
        safe.contains(&Rectangle { min: p, max: p })
    };
    let above = occluder.slab.face_corners(1.0).map(|c| frame.project(c));
    let below = occluder.slab.face_corners(-1.0).map(|c| frame.project(c));
    above.iter().all(|&p| inside(p) && p.z > top)
        && below.iter().all(|&p| inside(p) && p.z < bottom)
}
