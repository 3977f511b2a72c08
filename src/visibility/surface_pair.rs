//! Two elements as a surface between them meets them: what is clear of both, and what lies beside their shaft.

use super::bounds::{BoundsShape, ElementBounds};
use super::shaft::Shaft;
use super::shaft_planes::push_planes;
use super::stored_polygon::{PlaneKnown, StoredPolygon};
use super::tolerance::Tolerance;
use glam::{DVec3, Vec3};

/// A pair of elements.
pub(super) struct SurfacePair {
    ends: [SurfaceEnd; 2],
    shaft: Shaft,
    /// How far a surface has to stay from an element.
    depth: f64,
    weld: f64,
    nesting: f64,
}

/// One of them.
struct SurfaceEnd {
    corners: Vec<DVec3>,
    inner: DVec3,
    low: DVec3,
    high: DVec3,
    /// A point and the unit normal of a triangle that is no sliver.
    plane: Option<(DVec3, DVec3)>,
}

impl SurfaceEnd {
    fn new(bounds: &ElementBounds, tolerance: &Tolerance) -> Self {
        let corners: Vec<DVec3> = bounds.corners().map(|c| c.as_dvec3()).collect();
        // A triangle's, by the rule for those of the scene: the plane of a sliver is noise.
        let is_triangle = bounds.shape() == BoundsShape::Polygon && corners.len() == 3;
        let plane = is_triangle
            .then(|| {
                let own = [0, 1, 2].map(|i| bounds.corner(i));
                StoredPolygon::new(own, StoredPolygon::NONE.id, tolerance)
            })
            .filter(|own| matches!(own.known, PlaneKnown::Broad | PlaneKnown::Narrow))
            .map(|own| (corners[0], own.normal));
        Self {
            inner: inner_point(bounds).as_dvec3(),
            low: bounds.aabb().min.as_dvec3(),
            high: bounds.aabb().max.as_dvec3(),
            plane,
            corners,
        }
    }

    /// True only if a plane parts the element from the polygon by more than `depth`: the polygon's, its own, or one across
    /// an axis.
    fn is_apart(&self, polygon: &StoredPolygon, depth: f64) -> bool {
        let corners = polygon.corners.map(|c| c.as_dvec3());
        let on_one_side = |points: &[DVec3], origin: DVec3, normal: DVec3| {
            let height = |p: &DVec3| normal.dot(*p - origin);
            points.iter().all(|p| height(p) > depth) || points.iter().all(|p| height(p) < -depth)
        };
        let low = corners[0].min(corners[1]).min(corners[2]);
        let high = corners[0].max(corners[1]).max(corners[2]);
        (low.cmpgt(self.high + depth) | high.cmplt(self.low - depth)).any()
            || (matches!(polygon.known, PlaneKnown::Broad | PlaneKnown::Narrow)
                && on_one_side(&self.corners, corners[0], polygon.normal))
            || self
                .plane
                .is_some_and(|(origin, normal)| on_one_side(&corners, origin, normal))
    }
}

impl SurfacePair {
    pub(super) fn new(a: &ElementBounds, b: &ElementBounds, tolerance: &Tolerance) -> Self {
        let mut shaft = Shaft::new(a, b, tolerance);
        push_planes(&mut shaft, a, b, tolerance);
        Self {
            ends: [a, b].map(|end| SurfaceEnd::new(end, tolerance)),
            shaft,
            // Heights are right to 2e-9 (`StoredPolygon::new`), over a polygon's plane as over an element's own.
            depth: f64::from(tolerance.tau) + 1.001 * f64::from(tolerance.nesting) + 4.0e-9,
            weld: f64::from(tolerance.weld),
            nesting: f64::from(tolerance.nesting),
        }
    }

    /// The segment by which crossings are counted.
    pub(super) fn probe(&self) -> [DVec3; 2] {
        [self.ends[0].inner, self.ends[1].inner]
    }

    /// True where both elements lie in the triangle's plane up to rounding, as far as can be told: segments between them
    /// run along it, and on which side each end of one is says nothing.
    pub(super) fn lies_in_plane_of(&self, [u, v, w]: [DVec3; 3]) -> bool {
        let normal = (v - u).cross(w - u);
        let margin = self.nesting * normal.length();
        let mut corners = self.ends.iter().flat_map(|end| &end.corners);
        corners.all(|c| normal.dot(*c - u).abs() <= margin)
    }

    /// True only if neither element, grown by [`Tolerance::nesting`], comes within tau of the polygon.
    pub(super) fn is_apart_from(&self, polygon: &StoredPolygon) -> bool {
        self.ends
            .iter()
            .all(|end| end.is_apart(polygon, self.depth))
    }

    /// True only if no segment of the pair comes within the weld distance of the edge.
    pub(super) fn passes_beside(&self, [u, v]: [DVec3; 2]) -> bool {
        self.shaft.planes_before(u, v, self.weld).next().is_some() || self.passes_on_one_side(u, v)
    }

    /// A step of less than the weld distance that brings the edge beyond a plane of the shaft, along the plane's normal:
    /// `chosen` if there is one already.
    pub(super) fn step_out(&self, [u, v]: [DVec3; 2], chosen: Option<DVec3>) -> Option<DVec3> {
        let length = OVERHANG * self.weld;
        let mut steps = self
            .shaft
            .planes_before(u, v, -0.99 * length)
            .map(|plane| self.shaft.unit_normal(plane) * length);
        match chosen {
            Some(step) => steps.find(|s| *s == step),
            None => steps.next(),
        }
    }

    /// True only if all segments pass the line through `u` and `v` on one side, farther than the weld distance.
    ///
    /// With `e` along the line the number `e . ((a - u) x (b - u))` is linear in `a` and in `b`. It is wrong by less than
    /// 1e-15 of `|e| |a - u| |b - u|` (a dozen roundings of 1.1e-16), and moving `a`, `b` and the line by `m` together
    /// changes it by less than `|e| m (|a - u| + |b - u| + m)`.
    fn passes_on_one_side(&self, u: DVec3, v: DVec3) -> bool {
        let along = v - u;
        let length = along.length();
        let m = 1.01 * (self.weld + self.nesting);
        let mut sign = 0.0;
        for p in &self.ends[0].corners {
            let from = *p - u;
            let across = along.cross(from);
            let near = from.length();
            for q in &self.ends[1].corners {
                let to = *q - u;
                let far = to.length();
                let g = across.dot(to);
                let margin = length * (m * (near + far + m) + 2.0e-15 * near * far);
                // Also false for NaN.
                let clear = g.abs() > margin;
                if !clear || g * sign < 0.0 {
                    return false;
                }
                sign = g;
            }
        }
        true
    }
}

/// A point of an element, up to rounding, that lies on none of its axes of symmetry: segments between such points seldom
/// meet edges of a regular mesh.
pub(super) fn inner_point(bounds: &ElementBounds) -> Vec3 {
    let (centre, last) = (bounds.centre(), bounds.corner_count() - 1);
    // Another share for each axis of a box.
    let shares = [0.11, 0.23, 0.05].into_iter().enumerate();
    shares.fold(centre, |point, (i, share)| {
        point + (bounds.corner(i.min(last)) - centre) * share
    })
}

/// How far a surface may stick out at a border, in weld distances: less than one, so that what passes the overhang comes
/// within the weld distance of a polygon and is not surely clear; more than the half that the shaft's own margins are.
const OVERHANG: f64 = 0.7;
