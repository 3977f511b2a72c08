//! The five planes that decide most occlusion tests: the one that an occluder lies in, and the four
//! that stand on its edges at right angles to it. One lane each, so that a corner meets all at once.
//!
//! Where both elements lie on the inner side of the plane on an edge, every segment between them
//! that passes through the rectangle's plane passes inside that edge.

// Lanes of several arrays run in step: an index says so, and is what vectorises.
#![allow(clippy::needless_range_loop)]

use super::bounds::{BoundsShape, ElementBounds};
use glam::{DVec3, Vec3};

/// Unit roundoff of f32.
const U: f32 = 1.0 / 16_777_216.0;

/// The lane of the rectangle's own plane; those before it belong to the edges.
const OWN: usize = 4;

/// The planes in f32, for the quick look: `normal . x - offset` a lane. Lanes beyond the fifth are 0.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct SlabPlanes {
    normal: [[f32; 8]; 3],
    offset: [f32; 8],
    /// Bound on the error over the greatest coordinate, for corners and for boxes.
    doubt: [[f32; 8]; 2],
}

/// The plane on an edge, in f64, for where the quick look leaves a doubt.
#[derive(Clone, Copy, Debug)]
pub(super) struct BorderPlane {
    /// Unit normal towards the rectangle.
    inward: DVec3,
    offset: f64,
}

/// Least and greatest of an element's points over each plane.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaneRange {
    least: [f32; 8],
    greatest: [f32; 8],
}

/// How two elements, grown by a margin, lie to the plane on an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Lie {
    /// Proved: both wholly on the inner side.
    Inside,
    /// Both wholly on the outer side: no segment between them passes inside. (Not proved at
    /// distances below rounding: nothing is claimed from it.)
    Outside,
    /// Neither.
    Across,
    /// Too near to say in f32 whether inside.
    Doubtful,
}

impl BorderPlane {
    /// The plane through the edge from `start` along `direction`, which runs counter-clockwise about
    /// the slab's `normal`. It is at right angles to `direction x normal` exactly, so that the edges
    /// of both faces lie in it. An edge without length gives a plane that nothing lies inside of.
    pub(super) fn new(start: Vec3, direction: Vec3, normal: Vec3) -> Self {
        let across = normal.as_dvec3().cross(direction.as_dvec3());
        match across.try_normalize() {
            Some(inward) => Self {
                inward,
                offset: inward.dot(start.as_dvec3()),
            },
            None => Self {
                inward: DVec3::ZERO,
                offset: f64::from(f32::MAX),
            },
        }
    }

    /// True if both elements lie farther inside than `margin`. The terms are right to 1e-15.
    #[inline(always)]
    pub(super) fn has_inside(&self, a: &ElementBounds, b: &ElementBounds, margin: f64) -> bool {
        let n = self.inward;
        let mut inside = [0_u64; 8];
        for l in 0..8 {
            let p = n.x * f64::from(a.x[l]) + n.y * f64::from(a.y[l]) + n.z * f64::from(a.z[l]);
            let q = n.x * f64::from(b.x[l]) + n.y * f64::from(b.y[l]) + n.z * f64::from(b.z[l]);
            let least = if p < q { p } else { q };
            inside[l] = u64::from(least - self.offset > margin + 1.0e-14);
        }
        inside.iter().sum::<u64>() == 8
    }
}

impl SlabPlanes {
    /// The planes of a rectangle with this unit normal.
    ///
    /// Error. Normal and offset are rounded, u each; of a corner, products and sums add 3 u and the
    /// difference one of its two terms. With terms below `|n|_1 reach` and an offset below
    /// `sqrt(3) reach` that is `(4 |n|_1 + 5.3) u reach`. Of a box, `n . c` and `|n| . h` take 3 u
    /// each, `h` being below reach, their difference 2 u and the rounding of n 2 u: `(10 |n|_1 + 6) u
    /// reach`. Of a corner along an axis nothing is rounded but the difference, and that only where
    /// it is far above the distances that are compared.
    pub(super) fn new(normal: Vec3, borders: &[BorderPlane; 4]) -> Self {
        let mut planes = Self {
            normal: [[0.0; 8]; 3],
            offset: [0.0; 8],
            doubt: [[0.0; 8]; 2],
        };
        for (l, border) in borders.iter().enumerate() {
            let n = border.inward.as_vec3();
            let offset = border.offset as f32;
            let along_axis = n.abs().max_element() == 1.0
                && n.abs().element_sum() == 1.0
                && n.as_dvec3() == border.inward
                && f64::from(offset) == border.offset;
            planes.set(l, n, offset);
            let l1 = n.abs().element_sum();
            if !along_axis {
                planes.doubt[0][l] = U * (4.0 * l1 + 6.0);
            }
            planes.doubt[1][l] = U * (10.0 * l1 + 7.0);
        }
        planes.set(OWN, normal, 0.0);
        planes
    }

    fn set(&mut self, lane: usize, normal: Vec3, offset: f32) {
        for axis in 0..3 {
            self.normal[axis][lane] = normal[axis];
        }
        self.offset[lane] = offset;
    }

    #[inline(always)]
    pub(super) fn range(&self, bounds: &ElementBounds) -> PlaneRange {
        let [nx, ny, nz] = &self.normal;
        let mut least = [0.0_f32; 8];
        let mut greatest = [0.0_f32; 8];
        if bounds.shape() == BoundsShape::Box {
            let (c, h) = (bounds.box_centre, bounds.half);
            for l in 0..8 {
                let middle = nx[l] * c.x + ny[l] * c.y + nz[l] * c.z;
                let spread = nx[l].abs() * h.x + ny[l].abs() * h.y + nz[l].abs() * h.z;
                least[l] = middle - spread - self.offset[l];
                greatest[l] = middle + spread - self.offset[l];
            }
            return PlaneRange { least, greatest };
        }
        for l in 0..8 {
            least[l] = f32::INFINITY;
            greatest[l] = f32::NEG_INFINITY;
        }
        for i in 0..bounds.corner_count() {
            let (x, y, z) = (bounds.x[i], bounds.y[i], bounds.z[i]);
            for l in 0..8 {
                let h = nx[l] * x + ny[l] * y + nz[l] * z;
                least[l] = if h < least[l] { h } else { least[l] };
                greatest[l] = if h > greatest[l] { h } else { greatest[l] };
            }
        }
        for l in 0..8 {
            least[l] -= self.offset[l];
            greatest[l] -= self.offset[l];
        }
        PlaneRange { least, greatest }
    }

    /// How both elements, grown by `margin`, lie to the plane on each edge; `boxes` tells whether
    /// one of them is a box.
    #[inline(always)]
    pub(super) fn lies(
        &self,
        a: &PlaneRange,
        b: &PlaneRange,
        boxes: bool,
        margin: f32,
        reach: f32,
    ) -> [Lie; 4] {
        let mut lies = [Lie::Across; 4];
        for (l, lie) in lies.iter_mut().enumerate() {
            let doubt = self.doubt[usize::from(boxes)][l] * reach;
            let least = a.least[l].min(b.least[l]);
            let greatest = a.greatest[l].max(b.greatest[l]);
            *lie = if least > margin + doubt {
                Lie::Inside
            } else if greatest < -(margin + doubt) {
                Lie::Outside
            } else if least > margin - doubt {
                Lie::Doubtful
            } else {
                Lie::Across
            };
        }
        lies
    }
}

impl PlaneRange {
    /// Least and greatest height over the rectangle's own plane, from the origin.
    #[inline(always)]
    pub(super) fn heights(&self) -> (f32, f32) {
        (self.least[OWN], self.greatest[OWN])
    }
}
