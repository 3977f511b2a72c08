//! Irradiance that a uniformly radiant triangle of unit radiosity casts on a point: form factors from
//! a differential receiver.
//!
//! Near triangles use the exact contour integral (Lambert; truth: 1/(2 pi) sum of theta_i (n . gamma_i)
//! after clipping to the receiver's horizon). Far ones use a quadrature of the kernel
//! cos cos / (pi r^2). Everything is a *vector* K with irradiance n . K, so that one evaluation
//! serves every normal of a receiving cluster that has the source wholly in front.

use super::irradiance_kernel::{POINT_RADII, angle};
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;

/// Beyond this many radii a six-point rule of degree 4 errs by less than 1e-3, and a three-point rule of degree 2
/// beyond as many. A quadrature takes a third of the time of a contour.
pub(super) const SIX_POINT_RADII: f32 = 2.5;
const THREE_POINT_RADII: f32 = 5.0;

/// The symmetric rule of degree 4 (Dunavant 1985): weight of the three points near the midpoints of the edges, and the
/// share of the centroid in each; the same of the three near the corners. A point lies at the centroid times its share
/// plus the corner times what is left: towards the corner where that is positive, else away from it.
const SIX_POINTS: [(f32, f32); 2] = [
    (0.223_381_6, 3.0 * 0.445_948_5),
    (0.109_951_74, 3.0 * 0.091_576_21),
];

/// The vector K of a unit-radiosity triangle at `point`, clipped to the horizon of `normal` where
/// that is given. Zero where the point lies behind the triangle or within `tau` of its plane.
pub fn triangle_vector(
    corners: [Vec3; 3],
    source_normal: Vec3,
    area: f32,
    point: Vec3,
    normal: Option<Vec3>,
    tau: f32,
) -> Vec3 {
    let rel = corners.map(|c| c - point);
    // Height of the point over the source's plane; behind it, and within tau of it, there is no light:
    // the other side of the same sheet lies there.
    let height = -source_normal.dot(rel[0]);
    if height <= tau {
        return Vec3::ZERO;
    }
    if let Some(n) = normal {
        let h = rel.map(|r| n.dot(r));
        let low = h[0].min(h[1]).min(h[2]);
        if low < 0.0 {
            if h[0].max(h[1]).max(h[2]) <= 0.0 {
                return Vec3::ZERO;
            }
            return contour_clipped(rel, h);
        }
    }
    let centroid = (rel[0] + rel[1] + rel[2]) * (1.0 / 3.0);
    let radius2 = rel
        .iter()
        .fold(0.0f32, |m, r| m.max((*r - centroid).length_squared()));
    let distance2 = centroid.length_squared();
    let flux = area * height;
    if distance2 > POINT_RADII * POINT_RADII * radius2 {
        let inverse = 1.0 / distance2;
        return centroid * (flux * inverse * inverse * FRAC_1_PI);
    }
    if distance2 > SIX_POINT_RADII * SIX_POINT_RADII * radius2 {
        return quadrature(rel, centroid, flux, distance2, radius2);
    }
    contour(&rel)
}

/// The vector of a triangle that lies wholly above the horizon, at least [`SIX_POINT_RADII`] away: corners and centroid
/// relative to the point, area times the point's height over its plane.
pub(super) fn quadrature(
    rel: [Vec3; 3],
    centroid: Vec3,
    flux: f32,
    distance2: f32,
    radius2: f32,
) -> Vec3 {
    let towards = |q: Vec3| {
        let inverse = 1.0 / q.length_squared();
        q * (inverse * inverse)
    };
    if distance2 > THREE_POINT_RADII * THREE_POINT_RADII * radius2 {
        // The midpoints between the centroid and the corners.
        let [a, b, c] = rel.map(|r| towards((centroid + r) * 0.5));
        return (a + b + c) * (flux * (FRAC_1_PI / 3.0));
    }
    let mut sum = Vec3::ZERO;
    for (weight, share) in SIX_POINTS {
        let inwards = centroid * share;
        let [a, b, c] = rel.map(|r| towards(inwards + r * (1.0 - share)));
        sum += (a + b + c) * weight;
    }
    sum * (flux * FRAC_1_PI)
}

/// Lambert's contour integral over a polygon given relative to the receiving point,
/// counter-clockwise seen from the point's side of it.
fn contour(rel: &[Vec3]) -> Vec3 {
    let mut sum = Vec3::ZERO;
    let mut previous = rel[rel.len() - 1];
    for &next in rel {
        let cross = next.cross(previous);
        let sine = cross.length();
        // An edge that passes through the point, or of no length, subtends nothing.
        if sine > 0.0 {
            let theta = angle(sine, previous.dot(next));
            sum += cross * (theta / sine);
        }
        previous = next;
    }
    // Counter-clockwise seen from the point, next x previous turns gamma towards the polygon.
    sum * (0.5 * FRAC_1_PI)
}

/// The contour integral of the part of a triangle above the horizon (`h >= 0`).
fn contour_clipped(rel: [Vec3; 3], h: [f32; 3]) -> Vec3 {
    let mut clipped = [Vec3::ZERO; 4];
    let mut count = 0;
    for i in 0..3 {
        let j = (i + 1) % 3;
        if h[i] >= 0.0 {
            clipped[count] = rel[i];
            count += 1;
        }
        if (h[i] >= 0.0) != (h[j] >= 0.0) {
            let t = h[i] / (h[i] - h[j]);
            clipped[count] = rel[i] + (rel[j] - rel[i]) * t;
            count += 1;
        }
    }
    contour(&clipped[..count])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Irradiance of a unit-radiosity rectangle `corners` (counter-clockwise seen from the light's
    /// side) on a point.
    fn rectangle(corners: [Vec3; 4], point: Vec3, normal: Vec3) -> f32 {
        let [a, b, c, d] = corners;
        [[a, b, c], [a, c, d]]
            .into_iter()
            .map(|t| {
                let cross = (t[1] - t[0]).cross(t[2] - t[0]);
                let k = triangle_vector(
                    t,
                    cross.normalize(),
                    0.5 * cross.length(),
                    point,
                    Some(normal),
                    0.0,
                );
                normal.dot(k)
            })
            .sum()
    }

    /// Point to a parallel rectangle a x b at distance c, one corner on the point's normal.
    fn parallel(a: f64, b: f64, c: f64) -> f64 {
        let (a, b) = (a / c, b / c);
        let (ra, rb) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
        (a / ra * (b / ra).atan() + b / rb * (a / rb).atan()) / (2.0 * std::f64::consts::PI)
    }

    /// Point to a perpendicular rectangle of width a and height b, its lower corner at distance c.
    fn perpendicular(a: f64, b: f64, c: f64) -> f64 {
        let r = (b * b + c * c).sqrt();
        ((a / c).atan() - c / r * (a / r).atan()) / (2.0 * std::f64::consts::PI)
    }

    fn above(a: f32, b: f32, c: f32) -> [Vec3; 4] {
        [
            Vec3::new(0.0, 0.0, c),
            Vec3::new(0.0, b, c),
            Vec3::new(a, b, c),
            Vec3::new(a, 0.0, c),
        ]
    }

    #[test]
    fn parallel_rectangle_matches_its_closed_form_at_any_distance() {
        // From contact to the far rules: relative error of each against the closed form.
        for c in [
            0.01f32, 0.1, 0.5, 1.0, 3.0, 6.0, 9.0, 15.0, 25.0, 45.0, 100.0,
        ] {
            for (a, b) in [(1.0f32, 1.0), (0.5, 2.0)] {
                let got = rectangle(above(a, b, c), Vec3::ZERO, Vec3::Z);
                let want = parallel(f64::from(a), f64::from(b), f64::from(c));
                let error = (f64::from(got) - want).abs() / want;
                assert!(error < 1.0e-3, "a {a} b {b} c {c}: {got} for {want}");
            }
        }
    }

    #[test]
    fn perpendicular_rectangle_matches_its_closed_form() {
        for c in [0.01f32, 0.1, 1.0, 5.0] {
            let corners = [
                Vec3::new(c, 0.0, 0.0),
                Vec3::new(c, 1.0, 0.0),
                Vec3::new(c, 1.0, 1.0),
                Vec3::new(c, 0.0, 1.0),
            ]
            .map(|v| Vec3::new(v.x, v.y, v.z));
            // Seen from -x: counter-clockwise is y then z reversed.
            let corners = [corners[0], corners[3], corners[2], corners[1]];
            let got = rectangle(corners, Vec3::ZERO, Vec3::Z);
            let want = perpendicular(1.0, 1.0, f64::from(c));
            assert!(
                (f64::from(got) - want).abs() < 1.0e-4 * want.max(0.01),
                "c {c}: {got} for {want}"
            );
        }
    }

    #[test]
    fn a_rectangle_below_the_horizon_gives_nothing_and_one_across_it_half() {
        let below = above(1.0, 1.0, -1.0);
        let flipped = [below[0], below[3], below[2], below[1]];
        assert_eq!(rectangle(flipped, Vec3::ZERO, Vec3::Z), 0.0);
        // A wall at x = 1 from z = -1 to 1 gives what its upper half gives.
        let wall = |low: f32| {
            [
                Vec3::new(1.0, 0.0, low),
                Vec3::new(1.0, 0.0, 1.0),
                Vec3::new(1.0, 1.0, 1.0),
                Vec3::new(1.0, 1.0, low),
            ]
        };
        let (whole, half) = (
            rectangle(wall(-1.0), Vec3::ZERO, Vec3::Z),
            rectangle(wall(0.0), Vec3::ZERO, Vec3::Z),
        );
        assert!(half > 0.05);
        assert!((whole - half).abs() < 1.0e-6, "{whole} for {half}");
    }

    #[test]
    fn the_back_of_a_source_is_dark() {
        let [a, b, c, d] = above(1.0, 1.0, 1.0);
        assert_eq!(rectangle([d, c, b, a], Vec3::ZERO, Vec3::Z), 0.0);
    }

    #[test]
    fn the_six_walls_of_a_cube_fill_every_points_sky() {
        // Closure: the irradiance vectors of a closed convex room, with unit radiosity, sum to 1
        // about any normal.
        let lo = Vec3::splat(-0.5);
        let hi = Vec3::splat(0.5);
        let mut walls = Vec::new();
        for axis in 0..3 {
            for (sign, at) in [(1.0f32, lo[axis]), (-1.0, hi[axis])] {
                let mut u = Vec3::ZERO;
                let mut v = Vec3::ZERO;
                u[(axis + 1) % 3] = 1.0;
                v[(axis + 2) % 3] = sign;
                let mut corner = lo;
                corner[axis] = at;
                if sign < 0.0 {
                    corner[(axis + 2) % 3] = hi[(axis + 2) % 3];
                }
                walls.push([corner, corner + u, corner + u + v, corner + v]);
            }
        }
        for (point, normal) in [
            (
                Vec3::new(0.1, -0.2, 0.3),
                Vec3::new(0.3, 0.5, -0.8).normalize(),
            ),
            (Vec3::new(-0.499, 0.499, -0.499), Vec3::Z),
            (
                Vec3::new(0.0, 0.45, 0.2),
                Vec3::new(-1.0, 0.02, 0.1).normalize(),
            ),
        ] {
            let sum: f32 = walls.iter().map(|&w| rectangle(w, point, normal)).sum();
            assert!((sum - 1.0).abs() < 1.0e-5, "{point} {normal}: {sum}");
        }
    }
}
