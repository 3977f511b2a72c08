//! Full occlusion of a pair of elements by one slab rectangle (paper, section 5.2).
//!
//! Where the paper cuts the shaft's hull edges with the occluder's plane, we ask of each edge of the
//! rectangle that every segment between the elements passes on its inner side: for the edge through
//! `r` along `e`, counter-clockwise about the normal `n`, the number
//! `g(a, b) = e . ((a - r) x (b - r))` has the sign of `(b - a) . n` exactly when the line from `a`
//! to `b` passes inside. `g` is linear in `a` and in `b`, so its extremes over two convex sets are at
//! their vertices; over an axis-aligned box `B` with centre `c` and half-extents `h` the least value
//! is `w . (c - r) - |w| . h` with `w = e x (a - r)`.
//!
//! **Flush elements.** The commonest pair of all lies on the floor on both sides of a wall that
//! stands on it: the wall's edge passes within a fraction of the weld distance of every segment,
//! and no margin of a bilinear form fits in there. But where both elements lie on the inner side of
//! the plane through the edge at right angles to the rectangle, nothing bilinear is left to decide:
//! in the axes across the edge, with `x` inwards and `h` along the normal, `g` is `x_a h_b - h_a x_b`
//! times the edge's length, and `x > 0` on both sides with `h_a < 0 < h_b` settles its sign. Growing
//! the elements by `m` costs exactly `m` there, however slanted the segments, and in f64 rounding
//! costs nothing; see [`super::slab_planes`].

use super::bounds::{BoundsShape, ElementBounds};
use super::faults::Faults;
use super::slab_planes::{BorderPlane, Lie, PlaneRange, SlabPlanes};
use super::tolerance::Tolerance;
use crate::occluder::SlabRectangle;
use glam::Vec3;

/// Unit roundoff of f32.
const U: f32 = 1.0 / 16_777_216.0;

/// A slab rectangle prepared for the test.
#[derive(Clone, Copy, Debug)]
pub struct OccluderFaces {
    planes: SlabPlanes,
    /// Every point of the slab has `normal . x` in `[low, high]`.
    low: f32,
    high: f32,
    half_thickness: f32,
    edges: [FaceEdge; 4],
    borders: [BorderPlane; 4],
    /// Greatest cosine between the normal and an edge: corners are rounded, so not quite zero.
    lean: f32,
    centre: Vec3,
    /// Greatest coordinate difference between the centre and a corner.
    radius: f32,
}

#[derive(Clone, Copy, Debug, Default)]
struct FaceEdge {
    start: Vec3,
    direction: Vec3,
    /// `direction x normal`: how the test changes from the middle plane to a face.
    outward: Vec3,
    /// Sum of the components' magnitudes of `direction`.
    length_l1: f32,
}

impl OccluderFaces {
    /// Prepares `slab`.
    pub fn new(slab: &SlabRectangle) -> Self {
        let n = slab.normal;
        let heights = slab.corners.map(|c| n.as_dvec3().dot(c.as_dvec3()));
        let thickness = f64::from(slab.half_thickness) * n.as_dvec3().length_squared();
        let low = heights.iter().copied().fold(f64::INFINITY, f64::min) - thickness;
        let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max) + thickness;
        let centre = (slab.corners[0] + slab.corners[2]) * 0.5;
        let radius = slab
            .corners
            .iter()
            .fold(0.0_f32, |r, &c| r.max((c - centre).abs().max_element()));
        let edges = std::array::from_fn(|i| {
            let direction = slab.corners[(i + 1) % 4] - slab.corners[i];
            FaceEdge {
                start: slab.corners[i],
                direction,
                outward: direction.cross(n),
                length_l1: direction.abs().element_sum(),
            }
        });
        let borders: [BorderPlane; 4] =
            std::array::from_fn(|i| BorderPlane::new(edges[i].start, edges[i].direction, n));
        Self {
            planes: SlabPlanes::new(n, &borders),
            borders,
            lean: edges.iter().fold(0.0, |lean, edge| {
                let e = edge.direction.as_dvec3();
                let cosine = n.as_dvec3().dot(e).abs() / e.length();
                // NaN, of an edge without length, is passed over: its border plane decides nothing.
                (cosine as f32).next_up().max(lean)
            }),
            low: (low as f32).next_down(),
            high: (high as f32).next_up(),
            half_thickness: slab.half_thickness,
            edges,
            centre,
            radius: radius.next_up(),
        }
    }

    /// True only if every segment between a point of `a` and a point of `b` passes through both
    /// faces of the slab, with both elements more than `tau` beyond them; elements count as grown by
    /// [`Tolerance::nesting`]. The order of `a` and `b` does not matter.
    pub fn occludes(&self, a: &ElementBounds, b: &ElementBounds, tolerance: &Tolerance) -> bool {
        self.occludes_with(a, b, tolerance, Faults::NONE)
    }

    #[inline(always)]
    pub(super) fn occludes_with(
        &self,
        a: &ElementBounds,
        b: &ElementBounds,
        tolerance: &Tolerance,
        faults: Faults,
    ) -> bool {
        let (over_a, over_b) = (self.planes.range(a), self.planes.range(b));
        let Some((sign, spare)) = self.side_of_second(&over_a, &over_b, tolerance) else {
            return false;
        };
        // Heights across an edge are along the part of the normal at right angles to it; they
        // differ from those along the normal by at most `lean` times the distance to the edge, below
        // 2 sqrt(3) reach. What `side_of_second` proves has `tau + spare` to give for that.
        let upright = 3.5 * self.lean * tolerance.reach <= tolerance.tau + 0.999 * spare;
        let boxes = a.shape() == BoundsShape::Box || b.shape() == BoundsShape::Box;
        let grown = 1.001 * tolerance.nesting;
        let lies = self
            .planes
            .lies(&over_a, &over_b, boxes, grown, tolerance.reach);
        let mut open = [true; 4];
        for i in 0..4 {
            match lies[i] {
                Lie::Outside if !faults.beside_counts_as_inside() => return false,
                Lie::Inside => open[i] = !upright,
                Lie::Doubtful if upright => {
                    open[i] = !self.borders[i].has_inside(a, b, f64::from(grown));
                }
                _ => {}
            }
        }
        if open == [false; 4] {
            return true;
        }
        // The eight lanes hold the vertices of one element; a box is best left as the other one.
        let swap = match (a.shape(), b.shape()) {
            (_, BoundsShape::Box) => false,
            (BoundsShape::Box, _) => true,
            _ => a.corner_count() < b.corner_count(),
        };
        let (a, b, sign) = if swap { (b, a, -sign) } else { (a, b, sign) };
        let frame = PairFrame::new(self, a, b, tolerance);
        // A loop, not `all`: its closure would not be compiled for the wide instruction set.
        for (edge, open) in self.edges.iter().zip(open) {
            if !open {
                continue;
            }
            let threshold = frame.threshold(edge);
            let inside = passes_inside(edge, sign, a, b, threshold)
                || (faults.beside_counts_as_inside()
                    && passes_inside(edge, -sign, a, b, threshold));
            if !inside {
                return false;
            }
        }
        true
    }

    /// 1 if `b` lies beyond the slab on the normal's side and `a` on the other, -1 if the other way
    /// round, `None` if the slab does not separate them with `tau` to spare; and how much more than
    /// that is to spare.
    ///
    /// Error: `n . x` of a corner takes 3 roundings relative to `sum |n_i x_i| <= sqrt(3) reach`
    /// (`|n|` is 1 up to 4 u); of a box, `n . c -+ |n| . h` takes 5 relative to
    /// `sqrt(3) (reach + 2 reach)`. 32 u reach covers both with the comparison's own rounding.
    #[inline(always)]
    fn side_of_second(
        &self,
        a: &PlaneRange,
        b: &PlaneRange,
        tolerance: &Tolerance,
    ) -> Option<(f32, f32)> {
        let margin = tolerance.tau + 1.001 * tolerance.nesting + 32.0 * U * tolerance.reach;
        let (low, high) = (self.low - margin, self.high + margin);
        let ((a_min, a_max), (b_min, b_max)) = (a.heights(), b.heights());
        if a_max < low {
            (b_min > high).then_some((1.0, (low - a_max).min(b_min - high)))
        } else if a_min > high {
            (b_max < low).then_some((-1.0, (low - b_max).min(a_min - high)))
        } else {
            None
        }
    }
}

/// The magnitudes that bound the rounding of `g` for one pair and one rectangle.
struct PairFrame {
    /// At least the greatest coordinate difference between a point of each element and a corner of
    /// the rectangle, multiplied together as the error bound wants them.
    rounding: f32,
    between_centres: Vec3,
    half_sum: Vec3,
    half_thickness: f32,
    nesting: f32,
}

impl PairFrame {
    /// The computed `g` differs from the exact one by less than `length_l1 * rounding`:
    ///
    /// * `e`, `a - r` and their products and differences give `w` with 4 roundings, `b - r` (or
    ///   `c - r`), the products and the sums add 5 more, `|w| . h` has no more than that: at most
    ///   9 u / (1 - 9 u) < 12 u of `S = sum over permutations of |e_i| |d_j| |f_k|` with
    ///   `|d_j| <= ma` and `|f_k| <= mb`, so `S <= 2 length_l1 ma mb`; `length_l1`, `ma` and `mb`
    ///   are themselves rounded by a few u, which 24 -> 26 u covers.
    /// * Growing each element by `m` (nesting) moves `g` by at most
    ///   `|e| m (|a - r| + |b - r| + m) <= length_l1 m (sqrt(3) (ma + mb) + m)`.
    /// * Passing from the middle plane to the face at `+-H` changes `g` by exactly
    ///   `-+H (e x n) . (b - a)`. Its extreme over the two boxes is subtracted apart; the rounding
    ///   of that and the growth by `m` of both ends cost `H length_l1 (16 u (ma + mb) + 2 m)`.
    /// * Underflow: every product that underflows loses at most 2^-150 times a factor below 4;
    ///   the constant 1e-36 is millions of times their sum.
    #[inline(always)]
    fn new(
        slab: &OccluderFaces,
        a: &ElementBounds,
        b: &ElementBounds,
        tolerance: &Tolerance,
    ) -> Self {
        let ma = ((a.box_centre - slab.centre).abs() + a.half).max_element() + slab.radius;
        let mb = ((b.box_centre - slab.centre).abs() + b.half).max_element() + slab.radius;
        let m = tolerance.nesting;
        let rounding = 26.0 * U * ma * mb
            + m * (1.7321 * (ma + mb) + m)
            + slab.half_thickness * (16.0 * U * (ma + mb) + 2.0 * m);
        Self {
            rounding: rounding * 1.0001,
            between_centres: b.box_centre - a.box_centre,
            half_sum: a.half + b.half,
            half_thickness: slab.half_thickness,
            nesting: m,
        }
    }

    /// What `g` has to exceed for this edge on both faces.
    #[inline(always)]
    fn threshold(&self, edge: &FaceEdge) -> f32 {
        let lean = edge.outward.dot(self.between_centres).abs()
            + edge.outward.abs().dot(self.half_sum)
            + edge.length_l1 * self.nesting;
        edge.length_l1 * self.rounding + self.half_thickness * lean * 1.0001 + 1.0e-36
    }
}

/// True if `sign * g(a, b) > threshold` for all vertices of both.
#[inline(always)]
fn passes_inside(
    edge: &FaceEdge,
    sign: f32,
    a: &ElementBounds,
    b: &ElementBounds,
    threshold: f32,
) -> bool {
    let e = edge.direction * sign;
    let r = edge.start;
    let (mut wx, mut wy, mut wz) = ([0.0_f32; 8], [0.0_f32; 8], [0.0_f32; 8]);
    for l in 0..8 {
        let (dx, dy, dz) = (a.x[l] - r.x, a.y[l] - r.y, a.z[l] - r.z);
        wx[l] = e.y * dz - e.z * dy;
        wy[l] = e.z * dx - e.x * dz;
        wz[l] = e.x * dy - e.y * dx;
    }
    // Counting lanes that pass keeps a NaN from passing.
    let mut passed = [0_u32; 8];
    if b.shape() == BoundsShape::Box {
        let (f, h) = (b.box_centre - r, b.half);
        for l in 0..8 {
            let middle = wx[l] * f.x + wy[l] * f.y + wz[l] * f.z;
            let spread = wx[l].abs() * h.x + wy[l].abs() * h.y + wz[l].abs() * h.z;
            passed[l] = u32::from(middle - spread > threshold);
        }
        passed.iter().sum::<u32>() == 8
    } else {
        for i in 0..b.corner_count() {
            let f = b.corner(i) - r;
            for l in 0..8 {
                let g = wx[l] * f.x + wy[l] * f.y + wz[l] * f.z;
                passed[l] += u32::from(g > threshold);
            }
        }
        passed.iter().sum::<u32>() == 8 * b.corner_count() as u32
    }
}
