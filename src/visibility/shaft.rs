//! The shaft between two elements: the convex hull of their bounds, as planes (Haines and Wallace
//! 1991), and what boxes and polygons have to do with it.
//!
//! Soundness does not hang on the planes' directions: whatever a normal is, its offset is the
//! greatest value over all corners of both elements plus the margins, so the shaft always contains
//! the hull. Only how tight it is hangs on the directions, which [`super::shaft_planes`] chooses.

// Lanes of several arrays run in step: an index says so, and is what vectorises.
#![allow(clippy::needless_range_loop)]

use super::bounds::{BoundsShape, ElementBounds};
use super::tolerance::Tolerance;
use super::wide_tree::BoxOctet;
use glam::{DVec3, Vec3};

/// Unit roundoff of f32.
const U: f32 = 1.0 / 16_777_216.0;

/// Most slanted planes of a shaft: 8 edges of each element and both caps are 18; 6 more where a box
/// is involved.
pub(super) const MAX_PLANES: usize = 24;

/// Half-spaces `normal . x <= offset` that all contain the shaft, besides the box of the union.
#[derive(Clone, Debug)]
pub(super) struct Shaft {
    normals: [Vec3; MAX_PLANES],
    offsets: [f32; MAX_PLANES],
    /// What a point has to be below to be inside by far more than any margin.
    inner_offsets: [f32; MAX_PLANES],
    count: usize,
    low: Vec3,
    high: Vec3,
    inner_low: Vec3,
    inner_high: Vec3,
    rounding: f32,
    nesting: f32,
    clearance: f32,
    /// False for the box of the union alone, which says only what is outside.
    has_planes: bool,
    /// The corners of both elements, where they are at most four each.
    corners: Option<[[f32; 8]; 3]>,
}

/// Eight triangles in structure-of-arrays form.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct TriangleOctet {
    /// `corners[i][axis][lane]`.
    pub corners: [[[f32; 8]; 3]; 3],
}

impl Shaft {
    /// The box of the union and no plane yet.
    ///
    /// Margins. A point `x` of the *scene as stored* is off the true one by at most `u reach` a
    /// coordinate (see [`super::scene_tree`]); an element's point is off its bounds by at most
    /// `nesting`. Evaluating `normal . x` for both sides of a comparison costs `3 u |n|_1 reach`
    /// each, so `8 u |n|_1 reach + |n| nesting` covers the stored point as well.
    #[inline(always)]
    pub(super) fn new(a: &ElementBounds, b: &ElementBounds, tolerance: &Tolerance) -> Self {
        let union = a.aabb.union(b.aabb);
        let rounding = 8.0 * U * tolerance.reach;
        let margin = Vec3::splat(rounding + tolerance.nesting);
        // Flat clusters carry their thickness of a few tau in their bounds: their own polygons
        // must not count as being inside.
        let clearance = 8.0 * tolerance.tau + 2.0 * rounding;
        let inner = Vec3::splat(clearance);
        Self {
            normals: [Vec3::ZERO; MAX_PLANES],
            offsets: [0.0; MAX_PLANES],
            inner_offsets: [0.0; MAX_PLANES],
            count: 0,
            low: union.min - margin,
            high: union.max + margin,
            inner_low: union.min + inner,
            inner_high: union.max - inner,
            rounding,
            nesting: tolerance.nesting,
            clearance,
            has_planes: false,
            corners: joint_corners(a, b),
        }
    }

    /// The box of the union with its margins.
    pub(super) fn bounds(&self) -> (Vec3, Vec3) {
        (self.low, self.high)
    }

    /// Those planes of the shaft, by number, that have both points beyond them even when moved outwards by `apart`.
    pub(super) fn planes_before(
        &self,
        u: DVec3,
        v: DVec3,
        apart: f64,
    ) -> impl Iterator<Item = usize> + '_ {
        let (low, high) = (u.min(v), u.max(v));
        let sides = (0..3).flat_map(move |axis| {
            [
                (2 * axis, high[axis] < f64::from(self.low[axis]) - apart),
                (2 * axis + 1, low[axis] > f64::from(self.high[axis]) + apart),
            ]
        });
        let slanted = (0..self.count).map(move |k| {
            let normal = self.normals[k].as_dvec3();
            // The shaft's own margins are a billion times what f64 rounds here.
            let offset = f64::from(self.offsets[k]) + apart * normal.length();
            (6 + k, normal.dot(u) > offset && normal.dot(v) > offset)
        });
        sides
            .chain(slanted)
            .filter(|(_, beyond)| *beyond)
            .map(|(plane, _)| plane)
    }

    /// The outward unit normal of a plane, by its number among [`Self::planes_before`].
    pub(super) fn unit_normal(&self, plane: usize) -> DVec3 {
        match plane.checked_sub(6) {
            Some(slanted) => self.normals[slanted].as_dvec3().normalize(),
            None => DVec3::AXES[plane / 2] * if plane.is_multiple_of(2) { -1.0 } else { 1.0 },
        }
    }

    /// All planes are in: what is inside all of them is inside the shaft.
    pub(super) fn complete(&mut self) {
        self.has_planes = true;
    }

    /// Adds the plane with this outward normal (any length, not zero) that touches the hull.
    #[inline(always)]
    pub(super) fn push(&mut self, normal: Vec3, a: &ElementBounds, b: &ElementBounds) {
        if self.count == MAX_PLANES {
            return;
        }
        let touch = match &self.corners {
            Some([x, y, z]) => greatest_along(normal, x, y, z),
            None => support(normal, a).max(support(normal, b)),
        };
        let length = normal.length();
        let margin = self.rounding * normal.abs().element_sum() + 1.0001 * self.nesting * length;
        self.normals[self.count] = normal;
        self.offsets[self.count] = touch + margin;
        self.inner_offsets[self.count] = touch - self.clearance * length;
        self.count += 1;
    }

    /// Bit per lane: the box may meet the shaft.
    #[inline(always)]
    pub(super) fn meets_boxes(&self, boxes: &BoxOctet) -> u32 {
        let mut out = [0_u32; 8];
        for axis in 0..3 {
            let (low, high) = (self.low[axis], self.high[axis]);
            for l in 0..8 {
                out[l] |=
                    u32::from(boxes.min[axis][l] > high) | u32::from(boxes.max[axis][l] < low);
            }
        }
        for k in 0..self.count {
            if all_set(&out) {
                return 0;
            }
            let (n, offset) = (self.normals[k], self.offsets[k]);
            let [x, y, z] = extreme_corners(boxes, n, false);
            for l in 0..8 {
                let height = n.x * x[l] + n.y * y[l] + n.z * z[l];
                out[l] |= u32::from(height > offset);
            }
        }
        clear_lanes(&out)
    }

    /// Bit per lane: the box lies inside the shaft, away from its border. Unused lanes are not.
    #[inline(always)]
    pub(super) fn contains_boxes(&self, boxes: &BoxOctet, lanes: u32) -> u32 {
        if !self.has_planes {
            return 0;
        }
        let mut out = [0_u32; 8];
        for axis in 0..3 {
            let (low, high) = (self.inner_low[axis], self.inner_high[axis]);
            for l in 0..8 {
                out[l] |=
                    u32::from(boxes.max[axis][l] > high) | u32::from(boxes.min[axis][l] < low);
            }
        }
        for k in 0..self.count {
            if clear_lanes(&out) & lanes == 0 {
                return 0;
            }
            let (n, offset) = (self.normals[k], self.inner_offsets[k]);
            let [x, y, z] = extreme_corners(boxes, n, true);
            for l in 0..8 {
                let height = n.x * x[l] + n.y * y[l] + n.z * z[l];
                out[l] |= u32::from(height > offset);
            }
        }
        clear_lanes(&out) & lanes
    }

    /// Bit per lane of `lanes`: the triangle may meet the shaft (no plane of the shaft has it outside).
    #[inline(always)]
    pub(super) fn meets_triangles(&self, triangles: &TriangleOctet, lanes: u32) -> u32 {
        let mut out = [0_u32; 8];
        for l in 0..8 {
            out[l] = !(lanes >> l) & 1;
        }
        let c = &triangles.corners;
        for axis in 0..3 {
            let (low, high) = (self.low[axis], self.high[axis]);
            for l in 0..8 {
                let (p, q, r) = (c[0][axis][l], c[1][axis][l], c[2][axis][l]);
                out[l] |= u32::from((p > high) & (q > high) & (r > high))
                    | u32::from((p < low) & (q < low) & (r < low));
            }
        }
        for k in 0..self.count {
            if all_set(&out) {
                return 0;
            }
            let (n, offset) = (self.normals[k], self.offsets[k]);
            for l in 0..8 {
                let p = n.x * c[0][0][l] + n.y * c[0][1][l] + n.z * c[0][2][l];
                let q = n.x * c[1][0][l] + n.y * c[1][1][l] + n.z * c[1][2][l];
                let r = n.x * c[2][0][l] + n.y * c[2][1][l] + n.z * c[2][2][l];
                out[l] |= u32::from((p > offset) & (q > offset) & (r > offset));
            }
        }
        clear_lanes(&out)
    }
}

/// Greatest `normal . x` over the corners, as evaluated in f32.
#[inline(always)]
fn support(normal: Vec3, bounds: &ElementBounds) -> f32 {
    if bounds.shape() == BoundsShape::Box {
        let pick = |axis: usize| {
            if normal[axis] > 0.0 {
                bounds.aabb.max[axis]
            } else {
                bounds.aabb.min[axis]
            }
        };
        return normal.x * pick(0) + normal.y * pick(1) + normal.z * pick(2);
    }
    greatest_along(normal, &bounds.x, &bounds.y, &bounds.z)
}

#[inline(always)]
fn greatest_along(normal: Vec3, x: &[f32; 8], y: &[f32; 8], z: &[f32; 8]) -> f32 {
    let mut height = [0.0_f32; 8];
    for l in 0..8 {
        height[l] = normal.x * x[l] + normal.y * y[l] + normal.z * z[l];
    }
    greatest_of(&height)
}

/// The corners of two planar elements of at most four each, side by side.
#[inline(always)]
fn joint_corners(a: &ElementBounds, b: &ElementBounds) -> Option<[[f32; 8]; 3]> {
    if a.corner_count() > 4 || b.corner_count() > 4 {
        return None;
    }
    let mut corners = [[0.0_f32; 8]; 3];
    for l in 0..4 {
        for (axis, (of_a, of_b)) in [(&a.x, &b.x), (&a.y, &b.y), (&a.z, &b.z)]
            .into_iter()
            .enumerate()
        {
            corners[axis][l] = of_a[l];
            corners[axis][l + 4] = of_b[l];
        }
    }
    Some(corners)
}

/// Greatest of eight numbers, in three steps.
#[inline(always)]
pub(super) fn greatest_of(lanes: &[f32; 8]) -> f32 {
    let larger = |a: f32, b: f32| if a > b { a } else { b };
    let mut four = [0.0_f32; 4];
    for l in 0..4 {
        four[l] = larger(lanes[l], lanes[l + 4]);
    }
    larger(larger(four[0], four[2]), larger(four[1], four[3]))
}

/// Least of eight numbers, in three steps.
#[inline(always)]
pub(super) fn least_of(lanes: &[f32; 8]) -> f32 {
    let smaller = |a: f32, b: f32| if a < b { a } else { b };
    let mut four = [0.0_f32; 4];
    for l in 0..4 {
        four[l] = smaller(lanes[l], lanes[l + 4]);
    }
    smaller(smaller(four[0], four[2]), smaller(four[1], four[3]))
}

/// The coordinates of each box's corner that lies least (or most) far along `normal`.
#[inline(always)]
fn extreme_corners(boxes: &BoxOctet, normal: Vec3, farthest: bool) -> [&[f32; 8]; 3] {
    let pick = |axis: usize, component: f32| {
        if (component > 0.0) == farthest {
            &boxes.max[axis]
        } else {
            &boxes.min[axis]
        }
    };
    [pick(0, normal.x), pick(1, normal.y), pick(2, normal.z)]
}

#[inline(always)]
fn all_set(lanes: &[u32; 8]) -> bool {
    lanes.iter().fold(1, |all, l| all & l) == 1
}

/// Bit per lane that is zero.
#[inline(always)]
fn clear_lanes(lanes: &[u32; 8]) -> u32 {
    let mut bits = [0_u32; 8];
    for l in 0..8 {
        bits[l] = if lanes[l] == 0 { 1 << l } else { 0 };
    }
    bits.iter().fold(0, |mask, bit| mask | bit)
}
