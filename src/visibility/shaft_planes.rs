//! The directions of a shaft's planes.
//!
//! For two boxes: the hull edges that join them in each of the three axis projections (Haines and
//! Wallace 1991). Every facet of the hull of two boxes that is not a facet of their union's box has
//! a normal without a component along one axis, so these planes *are* the hull. For corner lists we
//! go on where they stop: the planes through an edge of one element and a corner of the other that
//! have both elements on one side, and the elements' own planes.

// Lanes of several arrays run in step: an index says so, and is what vectorises.
#![allow(clippy::needless_range_loop)]

use super::bounds::{BoundsShape, ElementBounds};
use super::shaft::{Shaft, greatest_of, least_of};
use super::tolerance::Tolerance;
use glam::Vec3;

/// Gives the box of the union of two elements the planes that make it their shaft.
#[inline(always)]
pub(super) fn push_planes(
    shaft: &mut Shaft,
    a: &ElementBounds,
    b: &ElementBounds,
    tolerance: &Tolerance,
) {
    if a.shape() == BoundsShape::Box || b.shape() == BoundsShape::Box {
        push_projected_hulls(shaft, a, b);
    }
    // Far below the weld distance, far above rounding: which corner supports a plane.
    let slack = 0.25 * tolerance.weld;
    for (own, other) in [(a, b), (b, a)] {
        if own.shape() != BoundsShape::Box {
            push_supported(shaft, own, other, slack);
        }
    }
    shaft.complete();
}

/// In the projection along the third axis, the corners of the two rectangles in one quadrant are
/// joined by a hull edge exactly when a normal of that edge points into the quadrant.
#[inline(always)]
fn push_projected_hulls(shaft: &mut Shaft, a: &ElementBounds, b: &ElementBounds) {
    let (a_box, b_box) = (a.aabb, b.aabb);
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        for quadrant in 0..4 {
            let (positive_i, positive_j) = (quadrant & 1 != 0, quadrant & 2 != 0);
            let step = |axis: usize, positive: bool| {
                if positive {
                    b_box.max[axis] - a_box.max[axis]
                } else {
                    b_box.min[axis] - a_box.min[axis]
                }
            };
            let (along_i, along_j) = (step(i, positive_i), step(j, positive_j));
            let (mut n_i, mut n_j) = (along_j, -along_i);
            if (n_i > 0.0) != positive_i {
                (n_i, n_j) = (-n_i, -n_j);
            }
            if n_i != 0.0 && n_j != 0.0 && (n_j > 0.0) == positive_j {
                let mut normal = Vec3::ZERO;
                normal[i] = n_i;
                normal[j] = n_j;
                shaft.push(normal, a, b);
            }
        }
    }
}

/// The caps of `own` that have everything on one side, and for each edge of it the plane through the edge and a corner
/// of `other` that has.
///
/// With the edge's start `p`, the unit normal `n` of `own` and the direction `m` outwards across the edge within its
/// plane, a plane through the edge has a normal `m - s n`, which has `own` below it. A corner of `other` at the height `h`
/// over `own` and `x` along `m` is below it as well if `x <= s h`: every corner above bounds `s` from below, every corner
/// beneath from above, and the least such `s` supports both.
#[inline(always)]
fn push_supported(shaft: &mut Shaft, own: &ElementBounds, other: &ElementBounds, slack: f32) {
    let (p, q) = (own.corner(0), own.corner(1));
    let r = own.corner(own.corner_count().min(4) - 1);
    let normal = (q - p).cross(r - p).normalize_or_zero();
    if normal == Vec3::ZERO {
        return;
    }
    let height = along(normal, p, other);
    let (least, greatest) = (least_of(&height), greatest_of(&height));
    let (mut own_least, mut own_greatest) = (0.0, 0.0);
    if own.shape() == BoundsShape::Slab {
        let height = along(normal, p, own);
        (own_least, own_greatest) = (least_of(&height), greatest_of(&height));
    }
    if least >= own_least - slack {
        shaft.push(-normal, own, other);
    }
    if greatest <= own_greatest + slack {
        shaft.push(normal, own, other);
    }
    // Corners in the plane bound nothing, unless they lie beyond the edge: then no slant has both below.
    let mut inverse = [0.0_f32; 8];
    let (mut no_lower, mut no_upper, mut no_level) = ([0.0_f32; 8], [0.0_f32; 8], [0.0_f32; 8]);
    for l in 0..8 {
        let (above, below) = (height[l] > slack, height[l] < -slack);
        inverse[l] = if above | below { 1.0 / height[l] } else { 0.0 };
        no_lower[l] = if above { 0.0 } else { -FAR };
        no_upper[l] = if below { 0.0 } else { FAR };
        no_level[l] = if above | below { -FAR } else { 0.0 };
    }
    if greatest <= slack && least >= -slack {
        return;
    }
    for i in 0..own.corner_count() {
        let start = own.corner(i);
        let edge = own.corner(own.next_corner(i)) - start;
        let outwards = edge.cross(normal);
        let x = along(outwards, start, other);
        let (mut lower, mut upper, mut level) = ([0.0_f32; 8], [0.0_f32; 8], [0.0_f32; 8]);
        for l in 0..8 {
            let slant = x[l] * inverse[l];
            lower[l] = slant + no_lower[l];
            upper[l] = slant + no_upper[l];
            level[l] = x[l] + no_level[l];
        }
        let (lower, upper) = (greatest_of(&lower), least_of(&upper));
        let slant = if lower > -0.5 * FAR { lower } else { upper };
        if slant <= upper && greatest_of(&level) <= slack * edge.abs().element_sum() {
            shaft.push(outwards - normal * slant, own, other);
        }
    }
}

/// Beyond every slant and length.
const FAR: f32 = 1.0e30;

/// How far the corners of `bounds` lie along `direction` from `start`.
#[inline(always)]
fn along(direction: Vec3, start: Vec3, bounds: &ElementBounds) -> [f32; 8] {
    let mut length = [0.0_f32; 8];
    for l in 0..8 {
        length[l] = direction.x * (bounds.x[l] - start.x)
            + direction.y * (bounds.y[l] - start.y)
            + direction.z * (bounds.z[l] - start.z);
    }
    length
}
