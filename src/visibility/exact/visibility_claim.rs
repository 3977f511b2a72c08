//! The proof of a visibility claim, replayed polygon by polygon, and the search for a segment that
//! refutes it.

use super::dyadic::{Dyadic, DyadicVector};
use super::occlusion_claim::determinant;
use super::segment::surely_blocked;
use crate::visibility::{ElementBounds, Tolerance};
use glam::{DVec2, DVec3, Vec3};

/// How a polygon stands to a claim that two elements see each other fully.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PolygonStanding {
    /// Proved exactly: the hull of the two bounds has it outside or only touches it.
    Outside,
    /// Proved exactly: its plane never has a point of each element deeper than `tau` on opposite
    /// sides.
    Harmless,
    /// Neither, but no segment was found that it surely blocks.
    NotRefuted,
    /// This segment between the elements is surely blocked by it: the claim is false. The ends are
    /// right to f64 rounding, the blocking exactly.
    Blocks(DVec3, DVec3),
}

/// Judges one polygon.
pub fn judge_polygon(
    a: &ElementBounds,
    b: &ElementBounds,
    triangle: [Vec3; 3],
    tolerance: &Tolerance,
) -> PolygonStanding {
    if !has_depth_on_both_sides(a, b, triangle, tolerance) {
        return PolygonStanding::Harmless;
    }
    let corners: Vec<DVec3> = a
        .corners()
        .chain(b.corners())
        .map(|c| c.as_dvec3())
        .collect();
    if hull_is_separated(&corners, &triangle.map(Vec3::as_dvec3)) {
        return PolygonStanding::Outside;
    }
    match visibility_counterexample(a, b, triangle, tolerance) {
        Some((p, q)) => PolygonStanding::Blocks(p, q),
        None => PolygonStanding::NotRefuted,
    }
}

/// True exactly if one element has a corner deeper than `tau` on one side of the triangle's plane
/// and the other a corner deeper than `tau` on the other.
fn has_depth_on_both_sides(
    a: &ElementBounds,
    b: &ElementBounds,
    triangle: [Vec3; 3],
    tolerance: &Tolerance,
) -> bool {
    let v = triangle.map(|c| DyadicVector::from(c.as_dvec3()));
    let normal = v[1].minus(&v[0]).cross(&v[2].minus(&v[0]));
    let least = &Dyadic::from(tolerance.tau).square() * &normal.length_squared();
    let deep = |bounds: &ElementBounds, side: i32| {
        bounds.corners().any(|c| {
            let height = normal.dot(&DyadicVector::from(c.as_dvec3()).minus(&v[0]));
            height.signum() == side && height.square() > least
        })
    };
    (deep(a, 1) && deep(b, -1)) || (deep(a, -1) && deep(b, 1))
}

/// True exactly if some plane through three of the points has all of `hull` on one closed side and
/// all of `polygon` on the other, without everything lying in it: their convex hulls then have no
/// interior point in common. Two disjoint hulls always have such a plane. Brute force.
pub fn hull_is_separated(hull: &[DVec3], polygon: &[DVec3]) -> bool {
    let all: Vec<DVec3> = hull.iter().chain(polygon).copied().collect();
    for i in 0..all.len() {
        for j in i + 1..all.len() {
            for k in j + 1..all.len() {
                if separates(all[i], all[j], all[k], hull, polygon) {
                    return true;
                }
            }
        }
    }
    false
}

fn separates(u: DVec3, v: DVec3, w: DVec3, hull: &[DVec3], polygon: &[DVec3]) -> bool {
    let range = |points: &[DVec3]| {
        points.iter().fold((0.0_f64, 0.0_f64), |(low, high), &p| {
            let side = determinant(v, w, p, u);
            (low.min(side), high.max(side))
        })
    };
    let (hull_low, hull_high) = range(hull);
    if hull_low < 0.0 && hull_high > 0.0 {
        return false;
    }
    let (low, high) = range(polygon);
    let proper = hull_low < 0.0 || hull_high > 0.0 || low < 0.0 || high > 0.0;
    proper && ((hull_high <= 0.0 && low >= 0.0) || (hull_low >= 0.0 && high <= 0.0))
}

/// A crossing of the triangle's plane by a segment of the pair.
#[derive(Clone, Copy)]
struct Crossing {
    at: DVec2,
    ends: (DVec3, DVec3),
    /// Weight of the first end in the crossing point.
    weight: f64,
}

/// Looks for a segment between the elements that the triangle surely blocks. The search runs in
/// f64; what it finds is checked exactly.
pub fn visibility_counterexample(
    a: &ElementBounds,
    b: &ElementBounds,
    triangle: [Vec3; 3],
    tolerance: &Tolerance,
) -> Option<(DVec3, DVec3)> {
    let v = triangle.map(Vec3::as_dvec3);
    let normal = (v[1] - v[0]).cross(v[2] - v[0]).try_normalize()?;
    let axis = (v[1] - v[0]).normalize();
    let other = normal.cross(axis);
    let flat = |p: DVec3| DVec2::new(axis.dot(p - v[0]), other.dot(p - v[0]));
    let inner = inset(v.map(flat), f64::from(tolerance.weld) * (1.0 + 1.0e-6))?;
    let depth = f64::from(tolerance.tau) * (1.0 + 1.0e-6);
    for side in [1.0, -1.0] {
        let below = beyond(a, v[0], -normal * side, depth);
        let above = beyond(b, v[0], normal * side, depth);
        let mut crossings = Vec::new();
        for &p in &below {
            for &q in &above {
                let (hp, hq) = (normal.dot(p - v[0]), normal.dot(q - v[0]));
                let weight = hq / (hq - hp);
                crossings.push(Crossing {
                    at: flat(p * weight + q * (1.0 - weight)),
                    ends: (p, q),
                    weight,
                });
            }
        }
        if let Some((p, q)) = common_segment(&crossings, inner)
            && surely_blocked(p, q, triangle, tolerance)
        {
            return Some((p, q));
        }
    }
    None
}

/// Corners beyond the plane by more than `depth`, and the cuts between them and the others.
fn beyond(bounds: &ElementBounds, origin: DVec3, normal: DVec3, depth: f64) -> Vec<DVec3> {
    let corners: Vec<(DVec3, f64)> = bounds
        .corners()
        .map(|c| (c.as_dvec3(), normal.dot(c.as_dvec3() - origin) - depth))
        .collect();
    let mut points = Vec::new();
    for &(p, h) in corners.iter().filter(|c| c.1 > 0.0) {
        points.push(p);
        for &(q, k) in corners.iter().filter(|c| c.1 <= 0.0) {
            points.push(p + (q - p) * (h / (h - k) * (1.0 - 1.0e-9)));
        }
    }
    points
}

/// The triangle moved inwards by `distance`, counter-clockwise, where anything is left.
fn inset(v: [DVec2; 3], distance: f64) -> Option<[DVec2; 3]> {
    let [a, b, c] = v;
    let (la, lb, lc) = (b.distance(c), c.distance(a), a.distance(b));
    let perimeter = la + lb + lc;
    let inradius = (b - a).perp_dot(c - a) / perimeter;
    let incentre = (a * la + b * lb + c * lc) / perimeter;
    (inradius > distance)
        .then(|| v.map(|p| incentre + (p - incentre) * (1.0 - distance / inradius)))
}

/// A segment of the pair through a point that the hull of the crossings shares with the triangle.
fn common_segment(crossings: &[Crossing], triangle: [DVec2; 3]) -> Option<(DVec3, DVec3)> {
    let hull = hull_of(crossings);
    if hull.len() < 3 {
        return hull
            .iter()
            .find(|c| contains(&triangle, c.at))
            .map(|c| c.ends);
    }
    let mut region = triangle.to_vec();
    for (i, c) in hull.iter().enumerate() {
        region = clip(&region, c.at, hull[(i + 1) % hull.len()].at);
    }
    if region.is_empty() {
        return None;
    }
    let centre = region.iter().copied().sum::<DVec2>() / region.len() as f64;
    // The fan triangle of the hull that holds the point, and its barycentric weights.
    for i in 1..hull.len() - 1 {
        let (u, v, w) = (&hull[0], &hull[i], &hull[i + 1]);
        let area = (v.at - u.at).perp_dot(w.at - u.at);
        let weights = [
            (v.at - centre).perp_dot(w.at - centre) / area,
            (w.at - centre).perp_dot(u.at - centre) / area,
            (u.at - centre).perp_dot(v.at - centre) / area,
        ];
        if weights.iter().all(|&x| x >= -1.0e-12) {
            return Some(mix([u, v, w], weights.map(|x| x.max(0.0))));
        }
    }
    None
}

/// The segment that passes through the weighted mean of three crossings.
fn mix(crossings: [&Crossing; 3], weights: [f64; 3]) -> (DVec3, DVec3) {
    let (mut p, mut q, mut first, mut second) = (DVec3::ZERO, DVec3::ZERO, 0.0, 0.0);
    for (c, weight) in crossings.iter().zip(weights) {
        let (near, far) = (weight * c.weight, weight * (1.0 - c.weight));
        p += c.ends.0 * near;
        q += c.ends.1 * far;
        first += near;
        second += far;
    }
    (p / first, q / second)
}

fn contains(triangle: &[DVec2; 3], p: DVec2) -> bool {
    (0..3).all(|i| (triangle[(i + 1) % 3] - triangle[i]).perp_dot(p - triangle[i]) >= 0.0)
}

/// The convex hull, counter-clockwise (Andrew's monotone chain).
fn hull_of(crossings: &[Crossing]) -> Vec<Crossing> {
    let mut sorted = crossings.to_vec();
    sorted.sort_by(|p, q| p.at.x.total_cmp(&q.at.x).then(p.at.y.total_cmp(&q.at.y)));
    let mut hull: Vec<Crossing> = Vec::new();
    for pass in 0..2 {
        let floor = hull.len() + 1;
        for c in &sorted {
            while hull.len() > floor.max(1)
                && (hull[hull.len() - 1].at - hull[hull.len() - 2].at)
                    .perp_dot(c.at - hull[hull.len() - 1].at)
                    <= 0.0
            {
                hull.pop();
            }
            hull.push(*c);
        }
        hull.pop();
        if pass == 0 {
            sorted.reverse();
        }
    }
    hull
}

/// The part of a convex polygon on the left of the line from `s` to `t`.
fn clip(polygon: &[DVec2], s: DVec2, t: DVec2) -> Vec<DVec2> {
    let side = |p: DVec2| (t - s).perp_dot(p - s);
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (hp, hq) = (side(p), side(q));
        if hp >= 0.0 {
            kept.push(p);
        }
        if (hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0) {
            kept.push(p + (q - p) * (hp / (hp - hq)));
        }
    }
    kept
}
