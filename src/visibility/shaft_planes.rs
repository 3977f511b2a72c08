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
use super::shaft::Shaft;
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
            push_supported_by_edges(shaft, own, other, slack);
            push_caps(shaft, own, other, slack);
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

/// For each edge of `own`, the plane through it and a corner of `other` with everything on one side.
#[inline(always)]
fn push_supported_by_edges(
    shaft: &mut Shaft,
    own: &ElementBounds,
    other: &ElementBounds,
    slack: f32,
) {
    for i in 0..own.corner_count() {
        let start = own.corner(i);
        let edge = own.corner(own.next_corner(i)) - start;
        // Eight candidate planes, one for each corner of the other element.
        let (mut nx, mut ny, mut nz) = ([0.0_f32; 8], [0.0_f32; 8], [0.0_f32; 8]);
        let mut limit = [0.0_f32; 8];
        for l in 0..8 {
            let (dx, dy, dz) = (
                other.x[l] - start.x,
                other.y[l] - start.y,
                other.z[l] - start.z,
            );
            nx[l] = edge.y * dz - edge.z * dy;
            ny[l] = edge.z * dx - edge.x * dz;
            nz[l] = edge.x * dy - edge.y * dx;
            limit[l] = slack * (nx[l] * nx[l] + ny[l] * ny[l] + nz[l] * nz[l]).sqrt();
        }
        let (mut least, mut greatest) = ([0.0_f32; 8], [0.0_f32; 8]);
        // The edge's own ends lie in all eight planes.
        let next = own.next_corner(i);
        for (bounds, skipped) in [(own, [i, next]), (other, [8, 8])] {
            for k in 0..bounds.corner_count() {
                if k == skipped[0] || k == skipped[1] {
                    continue;
                }
                let d = bounds.corner(k) - start;
                for l in 0..8 {
                    let height = nx[l] * d.x + ny[l] * d.y + nz[l] * d.z;
                    least[l] = if height < least[l] { height } else { least[l] };
                    greatest[l] = if height > greatest[l] {
                        height
                    } else {
                        greatest[l]
                    };
                }
            }
        }
        // Where everything lies in the plane it is a cap, not a side.
        let mut bits = [0_u32; 8];
        for l in 0..8 {
            let side = (greatest[l] <= limit[l]) != (least[l] >= -limit[l]);
            bits[l] = if side { 1 << l } else { 0 };
        }
        let mut sides = 0;
        for bit in bits {
            sides |= bit;
        }
        if sides != 0 {
            let l = (sides.trailing_zeros() & 7) as usize;
            let normal = Vec3::new(nx[l], ny[l], nz[l]);
            let outward = if greatest[l] <= limit[l] {
                normal
            } else {
                -normal
            };
            shaft.push(outward, own, other);
        }
    }
}

/// The planes of `own`'s faces that have everything on one side.
#[inline(always)]
fn push_caps(shaft: &mut Shaft, own: &ElementBounds, other: &ElementBounds, slack: f32) {
    let (p, q) = (own.corner(0), own.corner(1));
    let r = own.corner(own.corner_count().min(4) - 1);
    let normal = (q - p).cross(r - p);
    let limit = slack * normal.length();
    if limit <= 0.0 {
        return;
    }
    let (mut least, mut greatest) = (f32::INFINITY, f32::NEG_INFINITY);
    for corner in other.corners() {
        let height = normal.dot(corner - p);
        least = least.min(height);
        greatest = greatest.max(height);
    }
    let (mut own_least, mut own_greatest) = (0.0_f32, 0.0_f32);
    for corner in own.corners() {
        let height = normal.dot(corner - p);
        own_least = own_least.min(height);
        own_greatest = own_greatest.max(height);
    }
    if least >= own_least - limit {
        shaft.push(-normal, own, other);
    }
    if greatest <= own_greatest + limit {
        shaft.push(normal, own, other);
    }
}
