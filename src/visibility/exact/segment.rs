//! Is a segment surely blocked by a polygon, is it surely clear of it? The definitions of
//! [`Tolerance`], decided exactly.

use super::dyadic::{Dyadic, DyadicVector};
use crate::visibility::Tolerance;
use glam::{DVec3, Vec3};

/// True exactly if `p` and `q` lie on opposite sides of the triangle's plane, both deeper than
/// `tau`, and the segment crosses the triangle more than `weld` inside its border.
pub fn surely_blocked(p: DVec3, q: DVec3, triangle: [Vec3; 3], tolerance: &Tolerance) -> bool {
    let v = triangle.map(|c| DyadicVector::from(c.as_dvec3()));
    let (p, q) = (DyadicVector::from(p), DyadicVector::from(q));
    let normal = v[1].minus(&v[0]).cross(&v[2].minus(&v[0]));
    let normal_squared = normal.length_squared();
    let (dp, dq) = (normal.dot(&p.minus(&v[0])), normal.dot(&q.minus(&v[0])));
    if dp.signum() * dq.signum() >= 0 {
        return false;
    }
    let tau = Dyadic::from(tolerance.tau).square();
    let least = &tau * &normal_squared;
    if dp.square() <= least || dq.square() <= least {
        return false;
    }
    // The crossing point over `total`, homogeneous.
    let (dp, dq) = (dp.abs(), dq.abs());
    let total = &dp + &dq;
    let crossing = p.scale(&dq).plus(&q.scale(&dp));
    let weld = Dyadic::from(tolerance.weld).square();
    (0..3).all(|i| {
        let edge = v[(i + 1) % 3].minus(&v[i]);
        let inside = normal
            .cross(&edge)
            .dot(&crossing.minus(&v[i].scale(&total)));
        let reach = &(&weld * &total.square()) * &(&normal_squared * &edge.length_squared());
        inside.signum() > 0 && inside.square() > reach
    })
}

/// True only if the segment, cut back by `tau` at both ends, stays farther than `weld` from the
/// triangle; false also for segments not longer than `2 tau`.
///
/// The cut is irrational; it is taken a relative 1e-12 too short, so a true answer is certain.
pub fn surely_clear_of(p: DVec3, q: DVec3, triangle: [Vec3; 3], tolerance: &Tolerance) -> bool {
    let tau = f64::from(tolerance.tau);
    let length = (q - p).length() * (1.0 + 1.0e-12);
    if length <= 2.0 * tau {
        return false;
    }
    let cut = Dyadic::from(tau / length * (1.0 - 1.0e-12));
    let (p, q) = (DyadicVector::from(p), DyadicVector::from(q));
    let step = q.minus(&p).scale(&cut);
    let (p, q) = (p.plus(&step), q.minus(&step));
    let v = triangle.map(|c| DyadicVector::from(c.as_dvec3()));
    let weld = Dyadic::from(tolerance.weld).square();
    !crosses(&p, &q, &v)
        && farther_from_plane_part(&p, &v, &weld)
        && farther_from_plane_part(&q, &v, &weld)
        && (0..3).all(|i| segments_farther(&p, &q, &v[i], &v[(i + 1) % 3], &weld))
}

/// True exactly if `x` is farther than `limit` from the triangle.
pub(super) fn is_off(x: DVec3, triangle: [Vec3; 3], limit: f32) -> bool {
    let x = DyadicVector::from(x);
    let v = triangle.map(|c| DyadicVector::from(c.as_dvec3()));
    let limit = Dyadic::from(limit).square();
    farther_from_plane_part(&x, &v, &limit)
        && (0..3).all(|i| point_farther(&x, &v[i], &v[(i + 1) % 3], &limit))
}

fn crosses(p: &DyadicVector, q: &DyadicVector, v: &[DyadicVector; 3]) -> bool {
    let normal = v[1].minus(&v[0]).cross(&v[2].minus(&v[0]));
    let (dp, dq) = (normal.dot(&p.minus(&v[0])), normal.dot(&q.minus(&v[0])));
    if dp.signum() * dq.signum() >= 0 {
        // Touching ends are found by the distances of points.
        return false;
    }
    let (dp, dq) = (dp.abs(), dq.abs());
    let total = &dp + &dq;
    let crossing = p.scale(&dq).plus(&q.scale(&dp));
    (0..3).all(|i| {
        let edge = v[(i + 1) % 3].minus(&v[i]);
        normal
            .cross(&edge)
            .dot(&crossing.minus(&v[i].scale(&total)))
            .signum()
            >= 0
    })
}

/// True if `x` does not project into the triangle, or is farther than the limit from its plane.
fn farther_from_plane_part(
    x: &DyadicVector,
    v: &[DyadicVector; 3],
    limit_squared: &Dyadic,
) -> bool {
    let normal = v[1].minus(&v[0]).cross(&v[2].minus(&v[0]));
    let inside = (0..3).all(|i| {
        let edge = v[(i + 1) % 3].minus(&v[i]);
        normal.cross(&edge).dot(&x.minus(&v[i])).signum() >= 0
    });
    let normal_squared = normal.length_squared();
    // A triangle without area has only its edges.
    !inside
        || normal_squared.signum() == 0
        || normal.dot(&x.minus(&v[0])).square() > limit_squared * &normal_squared
}

fn point_farther(x: &DyadicVector, s: &DyadicVector, t: &DyadicVector, limit: &Dyadic) -> bool {
    let (edge, d) = (t.minus(s), x.minus(s));
    let along = d.dot(&edge);
    let edge_squared = edge.length_squared();
    if along.signum() <= 0 {
        d.length_squared() > *limit
    } else if along >= edge_squared {
        x.minus(t).length_squared() > *limit
    } else {
        &(&d.length_squared() * &edge_squared) - &along.square() > limit * &edge_squared
    }
}

/// True if two segments are farther apart than the square root of `limit`.
fn segments_farther(
    p: &DyadicVector,
    q: &DyadicVector,
    s: &DyadicVector,
    t: &DyadicVector,
    limit: &Dyadic,
) -> bool {
    let ends = point_farther(p, s, t, limit)
        && point_farther(q, s, t, limit)
        && point_farther(s, p, q, limit)
        && point_farther(t, p, q, limit);
    if !ends {
        return false;
    }
    let (u, e, r) = (q.minus(p), t.minus(s), p.minus(s));
    let (a, b, c) = (u.dot(&u), u.dot(&e), e.dot(&e));
    let (d, f) = (u.dot(&r), e.dot(&r));
    let determinant = &(&a * &c) - &b.square();
    if determinant.signum() <= 0 {
        return true;
    }
    let on_first = &(&b * &f) - &(&c * &d);
    let on_second = &(&a * &f) - &(&b * &d);
    let interior = |x: &Dyadic| x.signum() >= 0 && *x <= determinant;
    if !interior(&on_first) || !interior(&on_second) {
        return true;
    }
    u.cross(&e).dot(&r).square() > limit * &determinant
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const UNIT: Tolerance = Tolerance {
        tau: 1.0e-6,
        weld: 1.0e-6,
        nesting: 0.0,
        reach: 1.0,
    };
    const TRIANGLE: [Vec3; 3] = [Vec3::ZERO, Vec3::X, Vec3::Y];

    fn through(x: f64, y: f64) -> (DVec3, DVec3) {
        (DVec3::new(x, y, -0.5), DVec3::new(x, y, 0.5))
    }

    #[test]
    fn the_border_is_neither_blocked_nor_clear() {
        for (x, blocked, clear) in [
            (2.0e-6, true, false),
            (1.1e-6, true, false),
            (0.9e-6, false, false),
            (0.0, false, false),
            (-0.9e-6, false, false),
            (-1.1e-6, false, true),
            (-1.0, false, true),
        ] {
            let (p, q) = through(x, 0.3);
            assert_eq!(surely_blocked(p, q, TRIANGLE, &UNIT), blocked, "{x}");
            assert_eq!(surely_clear_of(p, q, TRIANGLE, &UNIT), clear, "{x}");
        }
    }

    #[test]
    fn ends_in_the_plane_count_by_depth() {
        let (p, q) = (DVec3::new(0.2, 0.2, -0.9e-6), DVec3::new(0.2, 0.2, 0.5));
        assert!(!surely_blocked(p, q, TRIANGLE, &UNIT));
        let (p, q) = (DVec3::new(0.2, 0.2, -1.1e-6), DVec3::new(0.2, 0.2, 0.5));
        assert!(surely_blocked(p, q, TRIANGLE, &UNIT));
        // Leaves the triangle itself: clear only once the cut is longer than the weld distance.
        let (p, q) = (DVec3::new(0.2, 0.2, 0.0), DVec3::new(0.2, 0.2, 0.5));
        assert!(!surely_clear_of(p, q, TRIANGLE, &UNIT));
        let (p, q) = (DVec3::new(0.2, 0.2, 1.0e-6), DVec3::new(0.2, 0.2, 0.5));
        assert!(surely_clear_of(p, q, TRIANGLE, &UNIT));
        // In the plane, through the inside.
        let (p, q) = (DVec3::new(-1.0, 0.2, 0.0), DVec3::new(2.0, 0.2, 0.0));
        assert!(!surely_blocked(p, q, TRIANGLE, &UNIT));
        assert!(!surely_clear_of(p, q, TRIANGLE, &UNIT));
    }

    proptest! {
        /// Against the closed form of f64 geometry, wherever that is not in doubt.
        #[test]
        fn agrees_with_floating_point_away_from_the_border(
            c in prop::array::uniform32(-1.0_f64..1.0),
        ) {
            let point = |i: usize| DVec3::new(c[i], c[i + 1], c[i + 2]);
            let v = [point(0).as_vec3(), point(3).as_vec3(), point(6).as_vec3()];
            let (p, q) = (point(9), point(12));
            let w = v.map(Vec3::as_dvec3);
            let n = (w[1] - w[0]).cross(w[2] - w[0]);
            let (hp, hq) = (n.dot(p - w[0]), n.dot(q - w[0]));
            let x = p + (q - p) * (hp / (hp - hq));
            let inside = (0..3)
                .map(|i| n.cross(w[(i + 1) % 3] - w[i]).dot(x - w[i]))
                .fold(f64::INFINITY, f64::min);
            prop_assume!(hp.abs() > 1.0e-3 && hq.abs() > 1.0e-3 && inside.abs() > 1.0e-3);
            let hit = (hp > 0.0) != (hq > 0.0) && inside > 0.0;
            prop_assert_eq!(surely_blocked(p, q, v, &UNIT), hit);
            if hit {
                prop_assert!(!surely_clear_of(p, q, v, &UNIT));
            }
            // Dense sampling bounds the true distance from above.
            let mut nearest = f64::INFINITY;
            for i in 0..=30 {
                for j in 0..=(30 - i) {
                    let (s, t) = (f64::from(i) / 30.0, f64::from(j) / 30.0);
                    let y = w[0] + (w[1] - w[0]) * s + (w[2] - w[0]) * t;
                    let along = ((y - p).dot(q - p) / (q - p).length_squared()).clamp(0.0, 1.0);
                    nearest = nearest.min((y - p - (q - p) * along).length());
                }
            }
            let coarse = Tolerance { weld: 0.05, ..UNIT };
            if surely_clear_of(p, q, v, &coarse) {
                prop_assert!(nearest > 0.05 - 1.0e-5);
            } else {
                // Some point of the triangle is within 0.05, and the grid has one within 0.1 of that.
                prop_assert!(nearest < 0.16);
            }
        }
    }
}
