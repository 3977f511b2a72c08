//! The proof of an occlusion claim that rests on a surface of any shape, replayed from the chain alone
//! ([`CuttingSurface`]): that it touches neither element, that no segment meets its border, and that it is crossed.

use super::dyadic::{Dyadic, DyadicVector};
use super::occlusion_claim::{OcclusionFlaw, determinant};
use super::visibility_claim::hull_is_separated;
use crate::visibility::{BoundsShape, CuttingSurface, ElementBounds, Tolerance};
use glam::DVec3;
use std::collections::HashMap;

/// A corner, to the bit.
type Place = [u64; 3];

/// Checks in exact arithmetic that every segment between `a` and `b` crosses `surface` or, within the weld distance of
/// its polygons, what it is taken to stick out by.
///
/// # Errors
/// What does not hold.
pub fn replay_surface_occlusion(
    surface: &CuttingSurface,
    a: &ElementBounds,
    b: &ElementBounds,
    tolerance: &Tolerance,
) -> Result<(), OcclusionFlaw> {
    let ends = [a, b].map(|bounds| bounds.corners().map(|c| c.as_dvec3()).collect::<Vec<_>>());
    let clear_of = |polygon: &[DVec3; 3]| {
        is_apart(polygon, &ends[0], a.shape(), tolerance)
            && is_apart(polygon, &ends[1], b.shape(), tolerance)
    };
    if !surface.polygons.iter().all(clear_of) {
        return Err(OcclusionFlaw::TouchesSurface);
    }
    let hangs = |overhang: &[DVec3; 3]| is_near_one(overhang, &surface.polygons, tolerance);
    if !surface.overhangs.iter().all(hangs) {
        return Err(OcclusionFlaw::LongOverhang);
    }
    let chain: Vec<[DVec3; 3]> = [surface.polygons.as_slice(), &surface.overhangs].concat();
    let hull: Vec<DVec3> = ends.iter().flatten().copied().collect();
    if let Some([u, v]) = border_of(&chain)
        .into_iter()
        .find(|edge| !is_beside(*edge, &ends, &hull))
    {
        return Err(OcclusionFlaw::OpenBorder { from: u, to: v });
    }
    // All segments cross it equally often: the first that touches no border says how often.
    let points = ends.each_ref().map(|corners| points_of(corners));
    let pairs = points[0]
        .iter()
        .flat_map(|p| points[1].iter().map(move |q| (*p, *q)));
    let crossings = pairs
        .filter_map(|(p, q)| {
            chain
                .iter()
                .map(|t| crossing(*t, p, q))
                .sum::<Option<i32>>()
        })
        .next();
    match crossings {
        Some(0) | None => Err(OcclusionFlaw::NotCrossed),
        Some(_) => Ok(()),
    }
}

/// Points of an element: some inside, and its corners, between which segments of regular meshes often run along edges. The
/// shares are sixteenths, so that mixing f32 coordinates of like size rounds nothing.
fn points_of(corners: &[DVec3]) -> Vec<DVec3> {
    let count = corners.len();
    let mixed = (0..count).map(|i| {
        let corner = |k: usize| corners[(i + k) % count];
        corner(0) * 0.5 + corner(1) * 0.3125 + corner(2) * 0.1875
    });
    mixed.chain(corners.iter().copied()).collect()
}

/// True only if a plane parts the element from the polygon by more than tau: the polygon's, the element's own, or one
/// across an axis.
fn is_apart(
    polygon: &[DVec3; 3],
    corners: &[DVec3],
    shape: BoundsShape,
    tolerance: &Tolerance,
) -> bool {
    let tau = f64::from(tolerance.tau);
    // Differences of f32 numbers of like size are exact in f64.
    let along_axis = (0..3).any(|axis| {
        corners
            .iter()
            .all(|c| polygon.iter().all(|p| c[axis] - p[axis] > tau))
            || corners
                .iter()
                .all(|c| polygon.iter().all(|p| p[axis] - c[axis] > tau))
    });
    along_axis
        || parts(polygon, corners, tolerance)
        || (shape == BoundsShape::Polygon
            && parts(&[corners[0], corners[1], corners[2]], polygon, tolerance))
}

/// True exactly if all points lie deeper than tau on one side of the triangle's plane.
fn parts(triangle: &[DVec3; 3], points: &[DVec3], tolerance: &Tolerance) -> bool {
    let v = triangle.map(DyadicVector::from);
    let normal = v[1].minus(&v[0]).cross(&v[2].minus(&v[0]));
    let least = &Dyadic::from(tolerance.tau).square() * &normal.length_squared();
    let side = |p: &DVec3| {
        let height = normal.dot(&DyadicVector::from(*p).minus(&v[0]));
        let deep = height.square() > least;
        if deep { height.signum() } else { 0 }
    };
    let first = side(&points[0]);
    first != 0 && points[1..].iter().all(|p| side(p) == first)
}

/// True exactly if each corner of the overhang is within the weld distance of a corner of one polygon: then so is each
/// point of it of a point of that polygon, mixed alike.
fn is_near_one(overhang: &[DVec3; 3], polygons: &[[DVec3; 3]], tolerance: &Tolerance) -> bool {
    let weld = Dyadic::from(tolerance.weld).square();
    let near = |p: DVec3, q: DVec3| {
        let apart = DyadicVector::from(p).minus(&DyadicVector::from(q));
        apart.length_squared() < weld
    };
    polygons.iter().any(|polygon| {
        overhang
            .iter()
            .all(|c| polygon.iter().any(|p| near(*c, *p)))
    })
}

/// The edges of a chain that do not cancel, each once.
fn border_of(chain: &[[DVec3; 3]]) -> Vec<[DVec3; 2]> {
    // Adding zero makes one zero of the two.
    let place = |p: DVec3| -> Place { (p + DVec3::ZERO).to_array().map(f64::to_bits) };
    let mut times: HashMap<[Place; 2], (i32, [DVec3; 2])> = HashMap::new();
    for triangle in chain {
        for i in 0..3 {
            let (u, v) = (triangle[i], triangle[(i + 1) % 3]);
            let (forwards, key) = match place(u) < place(v) {
                true => (1, [place(u), place(v)]),
                false => (-1, [place(v), place(u)]),
            };
            times.entry(key).or_insert((0, [u, v])).0 += forwards;
        }
    }
    times
        .into_values()
        .filter(|(times, _)| *times != 0)
        .map(|(_, edge)| edge)
        .collect()
}

/// True only if no segment of the pair crosses the edge: it lies beside the pair's box, all segments pass its line on one
/// side, or a plane parts it from the hull. Exactly.
fn is_beside([u, v]: [DVec3; 2], ends: &[Vec<DVec3>; 2], hull: &[DVec3]) -> bool {
    let beside_box = (0..3).any(|axis| {
        let (low, high) = (u[axis].min(v[axis]), u[axis].max(v[axis]));
        hull.iter().all(|p| p[axis] < low) || hull.iter().all(|p| p[axis] > high)
    });
    if beside_box {
        return true;
    }
    let mut signs = ends[0]
        .iter()
        .flat_map(|p| ends[1].iter().map(|q| determinant(u, v, *p, *q)));
    let first = signs.next().unwrap_or(0.0);
    (first != 0.0 && signs.all(|sign| sign * first > 0.0)) || hull_is_separated(hull, &[u, v])
}

/// 1 or -1 where the segment from `p` to `q`, whose ends are off the triangle, crosses it, by its sense, 0 where it does
/// not, `None` where it touches its border or runs along its plane.
fn crossing([u, v, w]: [DVec3; 3], p: DVec3, q: DVec3) -> Option<i32> {
    let [from, to] = [p, q].map(|end| determinant(u, v, w, end));
    if from == 0.0 && to == 0.0 {
        return None;
    }
    // An end in the plane is off the triangle, and so is all of the segment that leaves it.
    if from == 0.0 || to == 0.0 || (from > 0.0) == (to > 0.0) {
        return Some(0);
    }
    let around = [(u, v), (v, w), (w, u)].map(|(s, t)| determinant(s, t, p, q));
    let (any_left, any_right) = (
        around.iter().any(|s| *s > 0.0),
        around.iter().any(|s| *s < 0.0),
    );
    if any_left && any_right {
        return Some(0);
    }
    let touches = around.contains(&0.0);
    (!touches).then_some(if from > 0.0 { 1 } else { -1 })
}
