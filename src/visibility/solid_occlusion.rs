//! Full occlusion of a pair of elements by one solid: all segments between their corners meet it, and both lie outside
//! ([`Solid`] says why that is enough).
//!
//! Whether a segment meets a box is told by six separating axes, without a division (Gottschalk, Lin, Manocha 1996): with
//! `m` the segment's middle and `d` half its extent, in coordinates in which the box is `|x_i| <= h_i`, it does unless
//! `|m_i| > h_i + |d_i|` for some axis or `|(m x d)_i| > h_j |d_k| + h_k |d_j|`.
//!
//! **Rounding.** All of it is in f64 from f32 coordinates. A corner's coordinates come out as those of a point that is
//! less than 1e-13 away (differences and products of numbers below 4, over a distance between opposite faces above
//! [`LEAST_HALF`]); pulling the solid's faces in by [`PULLED_IN`] more than the elements are grown covers that. What is left
//! are the roundings of `m`, `d` and the products, each relative to its result: [`PRODUCTS`] times the products' magnitudes.

use super::bounds::ElementBounds;
use super::probe_segment::ProbeSegment;
use super::tolerance::Tolerance;
use crate::occluder::Solid;
use glam::{DMat3, DVec3};

/// Least distance from a solid's middle to a face, normalised: thinner ones are not used.
const LEAST_HALF: f64 = 1.0e-5;
/// How much farther than the elements are grown the faces are pulled in, normalised.
const PULLED_IN: f64 = 1.0e-11;
/// Relative error of a product of two coordinates and of what follows: some ten roundings of 1.1e-16.
const PRODUCTS: f64 = 1.0e-14;
/// Greatest cosine between two axes of a solid: more would make its inverse ill-conditioned.
const MOST_LEAN: f64 = 1.0e-2;

/// A solid prepared for the test.
#[derive(Clone, Copy, Debug)]
pub(super) struct SolidBox {
    centre: DVec3,
    /// Takes a point's place from the centre to coordinates in which the solid is `|x_i| <= 1`.
    into: DMat3,
    /// What the solid is with its faces pulled in; above 1 nowhere.
    pulled_in: DVec3,
    /// Coordinates beyond which an element is outside with all that is wanted to spare.
    outside: DVec3,
    /// Coordinates below which an element is surely not beyond a face.
    inside: DVec3,
    /// Which faces are covered.
    covered: [[bool; 2]; 3],
}

impl SolidBox {
    /// Prepares `solid`; `None` if it is too thin or too far from a right-angled box.
    pub fn new(solid: &Solid, tolerance: &Tolerance) -> Option<Self> {
        let halves = solid.halves.map(|h| h.as_dvec3());
        let axes = DMat3::from_cols(halves[0], halves[1], halves[2]);
        let leans = (0..3).any(|i| {
            let (a, b) = (halves[i], halves[(i + 1) % 3]);
            a.dot(b).abs() > MOST_LEAN * a.length() * b.length()
        });
        let into = axes.inverse();
        // From the middle to the planes of the faces: a row of the inverse is a normal over that distance.
        let distances = DVec3::from_array([0, 1, 2].map(|i| 1.0 / into.row(i).length()));
        // Also false for NaN.
        if leans || !distances.cmpgt(DVec3::splat(LEAST_HALF)).all() {
            return None;
        }
        let grown = f64::from(tolerance.nesting) + PULLED_IN;
        let beyond = f64::from(tolerance.tau) * 1.001 + grown;
        Some(Self {
            centre: solid.centre.as_dvec3(),
            into,
            pulled_in: DVec3::ONE - DVec3::splat(grown) / distances,
            outside: DVec3::ONE + DVec3::splat(beyond) / distances,
            inside: DVec3::ONE - DVec3::splat(grown) / distances,
            covered: solid.covered,
        })
    }

    /// True only if all segments between `a` and `b`, each grown by [`Tolerance::nesting`], meet the solid, and both lie
    /// outside of it farther than `tau`.
    #[inline(always)]
    pub fn occludes(&self, a: &ElementBounds, b: &ElementBounds) -> bool {
        // The quick way out: most candidates fail on the first segments, from corner to corner.
        let (first, last) = (
            a.corner(0).as_dvec3(),
            b.corner(b.corner_count() - 1).as_dvec3(),
        );
        if !self.meets(self.local(first), self.local(last)) {
            return false;
        }
        let a = LocalCorners::new(self, a);
        if !a.is_outside(self.outside) {
            return false;
        }
        let b = LocalCorners::new(self, b);
        b.is_outside(self.outside)
            && (self.covers_towards(&a) || self.covers_towards(&b))
            && (0..b.count).all(|i| self.meets_all(&a, b.corner(i)))
    }

    /// Whether a segment meets it, up to rounding.
    #[inline(always)]
    pub fn meets_segment(&self, segment: &ProbeSegment) -> bool {
        let (from, along) = (segment.origin.as_dvec3(), segment.along.as_dvec3());
        self.meets(self.local(from), self.local(from + along))
    }

    /// Whether all faces are covered through which segments from an element may come in.
    #[inline(always)]
    fn covers_towards(&self, element: &LocalCorners) -> bool {
        let covers = |axis: usize, values: &[f64; 8], limit: f64| {
            let [low, high] = self.covered[axis];
            (low || values.iter().all(|&v| v >= -limit))
                && (high || values.iter().all(|&v| v <= limit))
        };
        covers(0, &element.x, self.inside.x)
            && covers(1, &element.y, self.inside.y)
            && covers(2, &element.z, self.inside.z)
    }

    #[inline(always)]
    fn local(&self, point: DVec3) -> DVec3 {
        self.into * (point - self.centre)
    }

    /// One segment.
    #[inline(always)]
    fn meets(&self, p: DVec3, q: DVec3) -> bool {
        let mut corners = LocalCorners::EMPTY;
        (corners.x, corners.y, corners.z) = ([p.x; 8], [p.y; 8], [p.z; 8]);
        self.meets_all(&corners, q)
    }

    /// All segments from the corners to `q`.
    // Lanes of several arrays run in step: an index says so, and is what vectorises.
    #[allow(clippy::needless_range_loop)]
    #[inline(always)]
    fn meets_all(&self, corners: &LocalCorners, q: DVec3) -> bool {
        let h = self.pulled_in;
        let mut met = [0_u32; 8];
        for l in 0..8 {
            let m = [
                0.5 * (corners.x[l] + q.x),
                0.5 * (corners.y[l] + q.y),
                0.5 * (corners.z[l] + q.z),
            ];
            let d = [
                0.5 * (q.x - corners.x[l]),
                0.5 * (q.y - corners.y[l]),
                0.5 * (q.z - corners.z[l]),
            ];
            let (am, ad) = (m.map(f64::abs), d.map(f64::abs));
            let crosses = |j: usize, k: usize| {
                let (left, right) = (m[j] * d[k], m[k] * d[j]);
                let doubt = PRODUCTS * (am[j] * ad[k] + am[k] * ad[j]);
                (left - right).abs() + doubt <= h[j] * ad[k] + h[k] * ad[j]
            };
            let within = |i: usize| am[i] <= h[i] + ad[i];
            let all =
                within(0) & within(1) & within(2) & crosses(1, 2) & crosses(2, 0) & crosses(0, 1);
            met[l] = u32::from(all);
        }
        // Counting keeps a NaN from passing.
        met.iter().sum::<u32>() == 8
    }
}

/// The corners of an element in a solid's coordinates; lanes beyond the count repeat the last one.
struct LocalCorners {
    x: [f64; 8],
    y: [f64; 8],
    z: [f64; 8],
    count: usize,
}

impl LocalCorners {
    const EMPTY: Self = Self {
        x: [0.0; 8],
        y: [0.0; 8],
        z: [0.0; 8],
        count: 0,
    };

    #[inline(always)]
    fn new(solid: &SolidBox, bounds: &ElementBounds) -> Self {
        let mut corners = Self {
            count: bounds.corner_count(),
            ..Self::EMPTY
        };
        let (c, [u, v, w]) = (
            solid.centre,
            [solid.into.x_axis, solid.into.y_axis, solid.into.z_axis],
        );
        for l in 0..8 {
            let x = f64::from(bounds.x[l]) - c.x;
            let y = f64::from(bounds.y[l]) - c.y;
            let z = f64::from(bounds.z[l]) - c.z;
            corners.x[l] = u.x * x + v.x * y + w.x * z;
            corners.y[l] = u.y * x + v.y * y + w.y * z;
            corners.z[l] = u.z * x + v.z * y + w.z * z;
        }
        corners
    }

    fn corner(&self, i: usize) -> DVec3 {
        DVec3::new(self.x[i], self.y[i], self.z[i])
    }

    /// True if one face's plane has all corners beyond it.
    #[inline(always)]
    fn is_outside(&self, limits: DVec3) -> bool {
        let beyond = |values: &[f64; 8], limit: f64| {
            let (mut above, mut below) = (0_u32, 0_u32);
            for &v in values {
                above += u32::from(v > limit);
                below += u32::from(v < -limit);
            }
            above == 8 || below == 8
        };
        beyond(&self.x, limits.x) || beyond(&self.y, limits.y) || beyond(&self.z, limits.z)
    }
}
