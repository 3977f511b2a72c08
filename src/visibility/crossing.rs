//! Can this polygon block any segment of a pair? The slow and sharp test, in f64, for the few
//! polygons that no plane of the shaft has outside.
//!
//! A segment from `p` to `q` is surely blocked by a polygon only if `p` and `q` lie deeper than
//! `tau` on opposite sides of its plane. So only the part of each element that lies so deep counts,
//! and the segments between those parts cross the plane within the hull of where vertex-vertex
//! segments cross it. The polygon is harmless if that hull is empty, for both ways of assigning the
//! sides, or lies beyond one of its edges. This covers with one rule, and without asking whose
//! polygon it is:
//!
//! * the polygons of a planar element itself, and all others in its plane;
//! * polygons that have both elements on one closed side;
//! * polygons of a wall that is flat only up to rounding, whose planes tilt by a few tau far away.

use super::bounds::ElementBounds;
use super::scene_tree::pulled_in;
use super::tolerance::Tolerance;
use glam::{DVec3, Vec3};

/// The part of an element beyond a plane: at most 8 corners and 4 x 4 cuts.
struct Part {
    points: [DVec3; 24],
    count: usize,
}

impl Part {
    /// The part of `corners` with `side * height > depth`, as the corners beyond and the cuts between
    /// any corner beyond and any that is not (more than the hull's edges, the same hull).
    #[inline(always)]
    fn beyond(corners: &[DVec3], heights: &[f64], side: f64, depth: f64) -> Self {
        let mut part = Self {
            points: [DVec3::ZERO; 24],
            count: 0,
        };
        for (p, h) in corners.iter().zip(heights) {
            if side * h > depth {
                part.push(*p);
            }
        }
        if part.count == 0 || part.count == corners.len() {
            return part;
        }
        for (p, h) in corners.iter().zip(heights) {
            if side * h <= depth {
                continue;
            }
            for (q, k) in corners.iter().zip(heights) {
                if side * k <= depth {
                    let t = (side * h - depth) / (side * h - side * k);
                    part.push(*p + (*q - *p) * t);
                }
            }
        }
        part
    }

    #[inline(always)]
    fn push(&mut self, point: DVec3) {
        if self.count < self.points.len() {
            self.points[self.count] = point;
            self.count += 1;
        }
    }

    fn points(&self) -> &[DVec3] {
        &self.points[..self.count]
    }
}

/// Corners in f64, and their signed distances from a plane.
struct Corners {
    points: [DVec3; 8],
    heights: [f64; 8],
    count: usize,
}

impl Corners {
    #[inline(always)]
    fn new(bounds: &ElementBounds, origin: DVec3, normal: DVec3) -> Self {
        let mut corners = Self {
            points: [DVec3::ZERO; 8],
            heights: [0.0; 8],
            count: bounds.corner_count(),
        };
        for i in 0..8 {
            let point = bounds.corner(i).as_dvec3();
            corners.points[i] = point;
            corners.heights[i] = normal.dot(point - origin);
        }
        corners
    }

    fn beyond(&self, side: f64, depth: f64) -> Part {
        Part::beyond(
            &self.points[..self.count],
            &self.heights[..self.count],
            side,
            depth,
        )
    }
}

/// False only if `triangle` surely blocks no segment between `a` and `b`, both grown by
/// [`Tolerance::nesting`]; so also of no pair inside them.
///
/// Error: coordinates are f32 and exact here. The plane's normal has a relative error of
/// `4e-16 * longest^2 / |n|`, below `1e-9` for every triangle whose inscribed circle is not below
/// half of the weld distance (others are never waved through); heights are then right to 2e-9, far
/// inside the `tau - nesting` that is compared with. The crossing test has a quarter of the weld
/// distance to spare, because the polygon is pulled in by only three quarters of it.
pub(super) fn may_block(
    triangle: [Vec3; 3],
    a: &ElementBounds,
    b: &ElementBounds,
    tolerance: &Tolerance,
) -> bool {
    let v @ [v0, ..] = triangle.map(Vec3::as_dvec3);
    let normal = match known_plane(v, tolerance) {
        KnownPlane::Normal(normal) => normal,
        KnownPlane::Noise => return true,
        KnownPlane::Hairline => return false,
    };
    if crosses_centre_segment(v, normal, a, b, tolerance) {
        return true;
    }
    let a = Corners::new(a, v0, normal);
    let b = Corners::new(b, v0, normal);
    let inner = pulled_in(triangle, tolerance.weld);
    let nesting = f64::from(tolerance.nesting);
    let depth = harmless_depth(tolerance);
    [1.0, -1.0].into_iter().any(|side| {
        let from = a.beyond(-side, depth);
        if from.count == 0 {
            return false;
        }
        let to = b.beyond(side, depth);
        to.count != 0
            && (0..3).all(|i| {
                let (start, edge) = (inner[i], (inner[(i + 1) % 3] - inner[i]) * side);
                !all_pass_outside(start, edge, from.points(), to.points(), nesting)
            })
    })
}

/// What a polygon's thickness says about its plane.
pub(super) enum KnownPlane {
    /// Its unit normal.
    Normal(DVec3),
    /// So thin that the plane is noise. It has no interior that could surely block, but a wall may
    /// be made of many such: there is no claim past it.
    Noise,
    /// Thinner than a thirty-second of the weld distance, as the poles of spheres leave them: eight
    /// million side by side would not wall off the scene, and one surely blocks nothing.
    Hairline,
}

/// The plane of a triangle, judged by its inscribed circle.
#[inline(always)]
pub(super) fn known_plane(v: [DVec3; 3], tolerance: &Tolerance) -> KnownPlane {
    let normal = (v[1] - v[0]).cross(v[2] - v[0]);
    let length = normal.length();
    let perimeter = (v[1] - v[0]).length() + (v[2] - v[1]).length() + (v[0] - v[2]).length();
    let weld = f64::from(tolerance.weld);
    if length > 0.5 * weld * perimeter {
        KnownPlane::Normal(normal / length)
    } else if length < weld / 32.0 * perimeter {
        KnownPlane::Hairline
    } else {
        KnownPlane::Noise
    }
}

/// Depth up to which a point of the bounds stands for points that are not deeper than `tau`.
#[inline(always)]
fn harmless_depth(tolerance: &Tolerance) -> f64 {
    f64::from(tolerance.tau) - 1.001 * f64::from(tolerance.nesting)
}

/// False only if no point of `a` and point of `b` lie deeper than `tau` on opposite sides of the
/// triangle's plane, which is one way of surely blocking nothing; the elements grown as above.
pub(super) fn has_depth_on_both_sides(
    triangle: [Vec3; 3],
    a: &ElementBounds,
    b: &ElementBounds,
    tolerance: &Tolerance,
) -> bool {
    let v = triangle.map(Vec3::as_dvec3);
    let normal = match known_plane(v, tolerance) {
        KnownPlane::Normal(normal) => normal,
        KnownPlane::Noise => return true,
        KnownPlane::Hairline => return false,
    };
    let depth = harmless_depth(tolerance);
    let range = |bounds: &ElementBounds| {
        let corners = Corners::new(bounds, v[0], normal);
        corners.heights[..corners.count]
            .iter()
            .fold((0.0_f64, 0.0_f64), |(l, h), &x| (l.min(x), h.max(x)))
    };
    let ((a_low, a_high), (b_low, b_high)) = (range(a), range(b));
    (a_high > depth && b_low < -depth) || (a_low < -depth && b_high > depth)
}

/// True if every segment between the two point sets, both grown by `nesting`, passes on the outer
/// side of the edge: then so do the segments between their hulls, the number being bilinear.
#[inline(always)]
fn all_pass_outside(start: DVec3, edge: DVec3, from: &[DVec3], to: &[DVec3], nesting: f64) -> bool {
    let growth = 1.001 * nesting * edge.length();
    from.iter().all(|&p| {
        let w = edge.cross(p - start);
        let near = (p - start).abs().element_sum() + nesting;
        to.iter().all(|&q| {
            let d = q - start;
            w.dot(d) < -growth * (near + d.abs().element_sum())
        })
    })
}

/// The quick way to a yes: the segment between the centres crosses the polygon, deep on both sides.
#[inline(always)]
fn crosses_centre_segment(
    v: [DVec3; 3],
    normal: DVec3,
    a: &ElementBounds,
    b: &ElementBounds,
    tolerance: &Tolerance,
) -> bool {
    let (p, q) = (a.centre().as_dvec3(), b.centre().as_dvec3());
    let (hp, hq) = (normal.dot(p - v[0]), normal.dot(q - v[0]));
    let deep = 4.0 * f64::from(tolerance.tau);
    if hp.abs() < deep || hq.abs() < deep || (hp > 0.0) == (hq > 0.0) {
        return false;
    }
    let x = p + (q - p) * (hp / (hp - hq));
    (0..3).all(|i| {
        let edge = v[(i + 1) % 3] - v[i];
        edge.cross(x - v[i]).dot(normal) > deep * edge.length()
    })
}
