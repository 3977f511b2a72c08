//! Form factors and radiosities with closed forms, for perfectly diffuse grey surfaces.
//!
//! Sources: Howell, "A Catalog of Radiation Heat Transfer Configuration Factors" (the entry is named
//! at each function), and CIE 171:2006. Lengths may have any unit as long as it is the same for all;
//! form factors are dimensionless and lie in [0, 1].

use std::f64::consts::PI;

/// Form factor between two parallel rectangles `a` x `b`, opposite each other at distance `c`
/// (Howell C-11). All positive.
pub fn parallel_rectangles(a: f64, b: f64, c: f64) -> f64 {
    let (x, y) = (a / c, b / c);
    let (rx, ry) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    let log = (rx * ry / (1.0 + x * x + y * y).sqrt()).ln();
    let arcs = x * ry * (x / ry).atan() + y * rx * (y / rx).atan() - x * x.atan() - y * y.atan();
    2.0 / (PI * x * y) * (log + arcs)
}

/// Form factor from a rectangle `width` x `edge` to a rectangle `height` x `edge` at a right angle to
/// it, which shares the side of length `edge` (Howell C-14). All positive.
pub fn perpendicular_rectangles(edge: f64, width: f64, height: f64) -> f64 {
    let (w, h) = (width / edge, height / edge);
    let (w2, h2) = (w * w, h * h);
    let diagonal = (w2 + h2).sqrt();
    let all = 1.0 + w2 + h2;
    // Logarithms of the three factors A, B and C; B and C are powers.
    let log_a = ((1.0 + w2) * (1.0 + h2) / all).ln();
    let log_power = |s: f64| s * (s * all / ((1.0 + s) * (w2 + h2))).ln();
    let arcs = w * (1.0 / w).atan() + h * (1.0 / h).atan() - diagonal * (1.0 / diagonal).atan();
    (arcs + 0.25 * (log_a + log_power(w2) + log_power(h2))) / (PI * w)
}

/// Form factor from a point to a parallel rectangle `a` x `b` at distance `c`, one of whose corners
/// lies on the point's normal (Howell B-3). `a` and `b` at least 0, `c` positive.
pub fn point_to_parallel_rectangle(a: f64, b: f64, c: f64) -> f64 {
    let (x, y) = (a / c, b / c);
    let (rx, ry) = ((1.0 + x * x).sqrt(), (1.0 + y * y).sqrt());
    (x / rx * (y / rx).atan() + y / ry * (x / ry).atan()) / (2.0 * PI)
}

/// Form factor from a point to a rectangle in a plane at a right angle to the point's plane, at
/// distance `c` along the point's plane (Howell B-4). One corner is the foot of the perpendicular from
/// the point; the rectangle reaches `a` along the line in which the planes meet and `b` along the
/// point's normal. `a` and `b` at least 0, `c` positive.
pub fn point_to_perpendicular_rectangle(a: f64, b: f64, c: f64) -> f64 {
    let reach = b.hypot(c);
    ((a / c).atan() - c / reach * (a / reach).atan()) / (2.0 * PI)
}

/// Form factor from a disc of radius `r1` to one of radius `r2` on the same axis at distance `h`
/// (Howell C-41). All positive.
pub fn coaxial_discs(r1: f64, r2: f64, h: f64) -> f64 {
    let (x, y) = (r1 / h, r2 / h);
    let s = 1.0 + (1.0 + y * y) / (x * x);
    0.5 * (s - (s * s - 4.0 * (r2 / r1).powi(2)).sqrt())
}

/// Form factors `[F_12, F_21, F_22]` of a sphere of radius `r1` inside the concentric sphere of radius
/// `r2` (Howell C-135 and C-136). `0 < r1 <= r2`.
pub fn concentric_spheres(r1: f64, r2: f64) -> [f64; 3] {
    let back = (r1 / r2).powi(2);
    [1.0, back, 1.0 - back]
}

/// Radiosity of the first of two infinite parallel plates that emit radiosities `e1`, `e2` (W/m2) and
/// reflect the shares `rho1`, `rho2` in [0, 1): each sees nothing but the other.
pub fn two_infinite_plates(e1: f64, e2: f64, rho1: f64, rho2: f64) -> f64 {
    (e1 + rho1 * e2) / (1.0 - rho1 * rho2)
}

/// Mean indirect illuminance (lx) in a closed space of area `area` (m2) and reflectance `rho` in
/// [0, 1) whose surfaces receive `flux` (lm) of direct light evenly: CIE 171:2006, section 5.8.
pub fn interreflection_illuminance(rho: f64, flux: f64, area: f64) -> f64 {
    rho * flux / (area * (1.0 - rho))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn close(got: f64, want: f64, within: f64) {
        assert!((got - want).abs() <= within, "{got} is not {want}");
    }

    #[test]
    fn the_unit_cube_has_the_published_factors_and_closes() {
        let opposite = parallel_rectangles(1.0, 1.0, 1.0);
        let adjacent = perpendicular_rectangles(1.0, 1.0, 1.0);
        close(opposite, 0.199_824_895_698, 1e-12);
        close(adjacent, 0.200_043_776_075, 1e-12);
        close(opposite + 4.0 * adjacent, 1.0, 1e-12);
    }

    #[test]
    fn an_oblong_box_closes_and_is_reciprocal() {
        let (x, y, z) = (2.0, 3.0, 0.7);
        let rows = parallel_rectangles(x, y, z)
            + 2.0 * perpendicular_rectangles(x, y, z)
            + 2.0 * perpendicular_rectangles(y, x, z);
        close(rows, 1.0, 1e-12);
        let there = y * perpendicular_rectangles(x, y, z);
        close(there, z * perpendicular_rectangles(x, z, y), 1e-12);
    }

    #[test]
    fn unit_discs_have_the_published_factor() {
        close(coaxial_discs(1.0, 1.0, 1.0), 0.381_966, 5e-7);
        close(
            coaxial_discs(1.0, 2.0, 3.0),
            4.0 * coaxial_discs(2.0, 1.0, 3.0),
            1e-12,
        );
    }

    #[test]
    fn points_agree_with_rectangles_by_quadrature() {
        let n = 400;
        let mid = |i: usize| (i as f64 + 0.5) / n as f64;
        let (mut parallel, mut perpendicular) = (0.0, 0.0);
        for i in 0..n {
            for j in 0..n {
                let (x, y) = (mid(i), mid(j));
                for (a, b) in [(x, y), (1.0 - x, y), (x, 1.0 - y), (1.0 - x, 1.0 - y)] {
                    parallel += point_to_parallel_rectangle(a, b, 1.0);
                }
                for a in [x, 1.0 - x] {
                    perpendicular += point_to_perpendicular_rectangle(a, 1.0, y);
                }
            }
        }
        let count = (n * n) as f64;
        close(parallel / count, parallel_rectangles(1.0, 1.0, 1.0), 1e-6);
        close(
            perpendicular / count,
            perpendicular_rectangles(1.0, 1.0, 1.0),
            1e-5,
        );
    }

    #[test]
    fn enclosed_surfaces_balance() {
        let [inner, back, own] = concentric_spheres(0.5, 1.0);
        close(back + own, inner, 0.0);
        close(back, 0.25, 0.0);
        let (b1, b2) = (
            two_infinite_plates(1.0, 0.25, 0.5, 0.7),
            two_infinite_plates(0.25, 1.0, 0.7, 0.5),
        );
        close(b1, 1.0 + 0.5 * b2, 1e-12);
        close(b2, 0.25 + 0.7 * b1, 1e-12);
    }

    #[test]
    fn interreflection_has_the_published_illuminances() {
        for (rho, want) in [(0.5, 104.17), (0.9, 937.5), (0.95, 1979.2)] {
            close(interreflection_illuminance(rho, 1e4, 96.0), want, 0.05);
        }
    }
}
