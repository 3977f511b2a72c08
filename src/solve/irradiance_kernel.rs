//! Irradiance that a triangle of unit radiosity casts on many points of a plane, eight at a time.
//!
//! The same three rules as [`super::triangle_vector::triangle_vector`], which is its scalar twin and its
//! test: Lambert's contour integral clipped to the receiver's horizon nearby, a quadrature farther
//! off, the centroid from afar. An octet takes the rule that its nearest point asks for.

// Lanes of several arrays run in step: an index says so, and is what vectorises.
#![allow(clippy::needless_range_loop)]

use glam::Vec3;
use pulp::{Arch, Simd, WithSimd};
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, PI};

/// Beyond this many radii a three-point rule of degree 2 errs by less than (1/6)^4 = 8e-4.
pub(super) const CONTOUR_RADII: f32 = 6.0;
/// Beyond this many radii the centroid alone errs by less than (1/20)^2 = 2.5e-3, a fifth of that in the mean.
pub(super) const POINT_RADII: f32 = 20.0;

/// A triangle that shines.
#[derive(Clone, Copy, Debug)]
pub struct Shining {
    /// Corners, counter-clockwise seen from the lit side.
    pub corners: [Vec3; 3],
    /// Unit normal.
    pub normal: Vec3,
    /// Area.
    pub area: f32,
}

/// Irradiance on points of a triangle with the given normal: those with the barycentric coordinates
/// `octets`, `[coordinate][lane]`; one result an octet.
pub fn irradiance_on(
    source: &Shining,
    receiver: [Vec3; 3],
    receiver_normal: Vec3,
    tau: f32,
    octets: &[[[f32; 8]; 3]],
    results: &mut [[f32; 8]],
) {
    let mut run = || {
        Arch::new().dispatch(Kernel {
            source,
            receiver,
            normal: receiver_normal,
            tau,
            octets,
            results: &mut *results,
        });
    };
    #[cfg(feature = "plant-regressions")]
    if super::planted::repeats_call() {
        run();
    }
    run();
}

struct Kernel<'a> {
    source: &'a Shining,
    receiver: [Vec3; 3],
    normal: Vec3,
    tau: f32,
    octets: &'a [[[f32; 8]; 3]],
    results: &'a mut [[f32; 8]],
}

type Lanes = [f32; 8];
type LaneVector = [Lanes; 3];

macro_rules! lanes {
    ($l:ident => $value:expr) => {{
        let mut out = [0.0_f32; 8];
        for $l in 0..8 {
            out[$l] = $value;
        }
        out
    }};
}

macro_rules! lane_vector {
    ($axis:ident, $l:ident => $value:expr) => {{
        let mut out = [[0.0_f32; 8]; 3];
        for $axis in 0..3 {
            for $l in 0..8 {
                out[$axis][$l] = $value;
            }
        }
        out
    }};
}

impl WithSimd for Kernel<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, _: S) {
        let results = std::mem::take(&mut self.results);
        let [a, b, c] = self.source.corners;
        let centroid = (a + b + c) * (1.0 / 3.0);
        let radius2 = (a - centroid)
            .length_squared()
            .max((b - centroid).length_squared())
            .max((c - centroid).length_squared());
        for (octet, result) in self.octets.iter().zip(results) {
            *result = self.one_octet(octet, centroid, radius2);
        }
    }
}

impl Kernel<'_> {
    #[inline(always)]
    fn one_octet(&self, octet: &[[f32; 8]; 3], centroid: Vec3, radius2: f32) -> Lanes {
        let [ra, rb, rc] = self.receiver.map(|p| p.to_array());
        let point =
            lane_vector!(k, l => ra[k] * octet[0][l] + rb[k] * octet[1][l] + rc[k] * octet[2][l]);
        let n = self.normal.to_array();
        let s = self.source.normal.to_array();
        let mut rel = [[[0.0_f32; 8]; 3]; 3];
        let mut h = [[0.0_f32; 8]; 3];
        for i in 0..3 {
            let corner = self.source.corners[i].to_array();
            rel[i] = lane_vector!(k, l => corner[k] - point[k][l]);
            h[i] = dot(&n, &rel[i]);
        }
        let depth = dot(&s, &rel[0]);
        let height = lanes!(l => -depth[l]);
        let low = lanes!(l => min(h[0][l], min(h[1][l], h[2][l])));
        let high = lanes!(l => max(h[0][l], max(h[1][l], h[2][l])));
        let g = centroid.to_array();
        let to_centroid = lane_vector!(k, l => g[k] - point[k][l]);
        let distance2 = dot_lanes(&to_centroid, &to_centroid);
        let (mut nearest, mut lowest, mut highest) = (f32::INFINITY, 0.0_f32, 0.0_f32);
        for l in 0..8 {
            nearest = min(nearest, distance2[l]);
            lowest = min(lowest, low[l]);
            highest = max(highest, high[l]);
        }
        if highest <= 0.0 {
            return [0.0; 8];
        }
        let value = if lowest < 0.0 {
            clipped_contour(&n, &rel, &h)
        } else if nearest > POINT_RADII * POINT_RADII * radius2 {
            let cosine = dot(&n, &to_centroid);
            let area = self.source.area * FRAC_1_PI;
            lanes!(l => cosine[l] * (area * height[l] / (distance2[l] * distance2[l])))
        } else if nearest > CONTOUR_RADII * CONTOUR_RADII * radius2 {
            let mut sum = [0.0_f32; 8];
            for r in &rel {
                let q = lane_vector!(k, l => (to_centroid[k][l] + r[k][l]) * 0.5);
                let (cosine, q2) = (dot(&n, &q), dot_lanes(&q, &q));
                sum = lanes!(l => sum[l] + cosine[l] / (q2[l] * q2[l]));
            }
            let area = self.source.area * (FRAC_1_PI / 3.0);
            lanes!(l => sum[l] * (area * height[l]))
        } else {
            let mut sum = [0.0_f32; 8];
            for i in 0..3 {
                sum = add_edge(sum, &n, &rel[i], &rel[(i + 1) % 3], &[1.0; 8]);
            }
            lanes!(l => sum[l] * (0.5 * FRAC_1_PI))
        };
        let tau = self.tau;
        lanes!(l => if height[l] > tau { max(value[l], 0.0) } else { 0.0 })
    }
}

/// Lambert's integral over the part of the triangle above the horizon: every edge cut there, and one
/// more along the horizon from where the border leaves to where it comes back.
#[inline(always)]
fn clipped_contour(n: &[f32; 3], rel: &[LaneVector; 3], h: &[Lanes; 3]) -> Lanes {
    let mut sum = [0.0_f32; 8];
    let mut exit = [[0.0_f32; 8]; 3];
    let mut entry = [[0.0_f32; 8]; 3];
    for i in 0..3 {
        let j = (i + 1) % 3;
        let (a, b, ha, hb) = (&rel[i], &rel[j], &h[i], &h[j]);
        let part = lanes!(l => {
            let crosses = (ha[l] >= 0.0) != (hb[l] >= 0.0);
            let span = if crosses { ha[l] - hb[l] } else { 1.0 };
            ha[l] / span
        });
        let cut = lane_vector!(k, l => a[k][l] + (b[k][l] - a[k][l]) * part[l]);
        let start = lane_vector!(k, l => if ha[l] >= 0.0 { a[k][l] } else { cut[k][l] });
        let end = lane_vector!(k, l => if hb[l] >= 0.0 { b[k][l] } else { cut[k][l] });
        exit = lane_vector!(k, l => if (ha[l] >= 0.0) & (hb[l] < 0.0) { cut[k][l] } else { exit[k][l] });
        entry = lane_vector!(k, l => if (ha[l] < 0.0) & (hb[l] >= 0.0) { cut[k][l] } else { entry[k][l] });
        let above = lanes!(l => if (ha[l] >= 0.0) | (hb[l] >= 0.0) { 1.0 } else { 0.0 });
        sum = add_edge(sum, n, &start, &end, &above);
    }
    // Where nothing is cut both points are the origin, and the edge subtends nothing.
    sum = add_edge(sum, n, &exit, &entry, &[1.0; 8]);
    lanes!(l => sum[l] * (0.5 * FRAC_1_PI))
}

/// Adds what the edge from `a` to `b` gives: its angle at the point times the cosine of its plane.
#[inline(always)]
fn add_edge(sum: Lanes, n: &[f32; 3], a: &LaneVector, b: &LaneVector, counts: &Lanes) -> Lanes {
    let cross = [
        lanes!(l => b[1][l] * a[2][l] - b[2][l] * a[1][l]),
        lanes!(l => b[2][l] * a[0][l] - b[0][l] * a[2][l]),
        lanes!(l => b[0][l] * a[1][l] - b[1][l] * a[0][l]),
    ];
    let (along, sine2, cosine) = (dot(n, &cross), dot_lanes(&cross, &cross), dot_lanes(a, b));
    lanes!(l => {
        let sine = sine2[l].sqrt();
        // An edge that passes through the point, or of no length, subtends nothing.
        let safe = if sine > 0.0 { sine } else { 1.0 };
        let value = along[l] * (angle(sine, cosine[l]) / safe) * counts[l];
        sum[l] + if sine > 0.0 { value } else { 0.0 }
    })
}

/// atan2 for a sine of at least 0: in [0, pi], right to 2e-8 before rounding (Abramowitz and Stegun, 4.4.49).
/// Its bits do not depend on the system's mathematical library.
#[inline(always)]
pub(super) fn angle(sine: f32, cosine: f32) -> f32 {
    let width = cosine.abs();
    let (small, large) = (min(sine, width), max(sine, width));
    let x = small / if large > 0.0 { large } else { 1.0 };
    let x2 = x * x;
    let mut series = 0.002_866_225_7_f32;
    series = series * x2 - 0.016_165_737;
    series = series * x2 + 0.042_909_614;
    series = series * x2 - 0.075_289_64;
    series = series * x2 + 0.106_562_64;
    series = series * x2 - 0.142_089;
    series = series * x2 + 0.199_935_51;
    series = series * x2 - 0.333_331_45;
    let first = x + x * (x2 * series);
    let quadrant = if sine > width {
        FRAC_PI_2 - first
    } else {
        first
    };
    if cosine < 0.0 {
        PI - quadrant
    } else {
        quadrant
    }
}

#[inline(always)]
fn dot(n: &[f32; 3], v: &LaneVector) -> Lanes {
    lanes!(l => n[0] * v[0][l] + n[1] * v[1][l] + n[2] * v[2][l])
}

#[inline(always)]
fn dot_lanes(a: &LaneVector, b: &LaneVector) -> Lanes {
    lanes!(l => a[0][l] * b[0][l] + a[1][l] * b[1][l] + a[2][l] * b[2][l])
}

#[inline(always)]
fn min(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

#[inline(always)]
fn max(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_angle_is_that_of_the_library() {
        for i in 0..=2000 {
            let want = f64::from(i) * std::f64::consts::PI / 2000.0;
            for scale in [1.0e-12, 1.0, 1.0e12] {
                let got = angle((want.sin() * scale) as f32, (want.cos() * scale) as f32);
                assert!(
                    (f64::from(got) - want).abs() < 4.0e-7,
                    "{want} {scale}: {got}"
                );
            }
        }
    }
}
