//! Polygons in one plane: whether another lies in this one's within tau, and how.

use super::model::Scene;
use crate::math::PolygonId;
use glam::{DVec2, DVec3, Vec3};

/// Polygons with a smaller altitude are left alone: in f32 their facing is noise, and their area does
/// not matter to a scene of size 1.
const LEAST_ALTITUDE: f64 = 1e-5;

/// A polygon laid flat into its own plane.
pub(super) struct Flat {
    origin: DVec3,
    pub normal: DVec3,
    u: DVec3,
    v: DVec3,
    pub corners: [DVec2; 3],
}

/// Another polygon in that plane.
pub(super) struct Lying {
    /// Counter-clockwise seen from the front of the first.
    pub corners: [DVec2; 3],
    pub same_way: bool,
}

impl Flat {
    /// `None` for polygons whose normal is noise.
    pub fn new(scene: &Scene, id: PolygonId) -> Option<Self> {
        let [a, b, c] = scene.corners(id).map(Vec3::as_dvec3);
        let doubled = (b - a).cross(c - a);
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        if doubled.length() < LEAST_ALTITUDE * longest {
            return None;
        }
        let normal = doubled.normalize();
        let (u, v) = normal.any_orthonormal_pair();
        let mut flat = Self {
            origin: a,
            normal,
            u,
            v,
            corners: [DVec2::ZERO; 3],
        };
        flat.corners = [a, b, c].map(|p| flat.project(p));
        // Whichever way the pair turns.
        if flat.turn(&flat.corners) < 0.0 {
            std::mem::swap(&mut flat.u, &mut flat.v);
            flat.corners = [a, b, c].map(|p| flat.project(p));
        }
        Some(flat)
    }

    /// Where `p` lies in the plane, seen along the normal.
    pub fn project(&self, p: DVec3) -> DVec2 {
        DVec2::new(self.u.dot(p - self.origin), self.v.dot(p - self.origin))
    }

    /// The point of space at `p` in the plane.
    pub fn lift(&self, p: DVec2) -> DVec3 {
        self.origin + self.u * p.x + self.v * p.y
    }

    fn turn(&self, [a, b, c]: &[DVec2; 3]) -> f64 {
        (b - a).perp_dot(c - a)
    }

    fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p - self.origin).abs()
    }

    /// The other polygon, if it lies within `tau` of this one's plane, or this one of its: a small
    /// polygon's plane says little about where a large one lies.
    pub fn coplanar(&self, scene: &Scene, other: PolygonId, tau: f32) -> Option<Lying> {
        let tau = f64::from(tau);
        let corners = scene.corners(other).map(Vec3::as_dvec3);
        let [a, b, c] = corners;
        let larger = (b - a).cross(c - a).length_squared()
            > (self.corners[1] - self.corners[0])
                .perp_dot(self.corners[2] - self.corners[0])
                .powi(2);
        let within = corners.iter().all(|&p| self.height(p) <= tau)
            || larger && {
                let its = Self::new(scene, other)?;
                its.normal.dot(self.normal).abs() > 0.999
                    && self
                        .corners
                        .iter()
                        .all(|&p| its.height(self.lift(p)) <= tau)
            };
        if !within {
            return None;
        }
        let [a, b, c] = corners.map(|p| self.project(p));
        let turn = self.turn(&[a, b, c]);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        if turn.abs() < LEAST_ALTITUDE * longest {
            return None;
        }
        let same_way = turn > 0.0;
        Some(Lying {
            corners: if same_way { [a, b, c] } else { [a, c, b] },
            same_way,
        })
    }
}

/// Whether an edge of one of two triangles has all of the other beyond it, but for a strip of `tau`: so
/// it is with the neighbours in a mesh, which need no clipping.
pub(super) fn are_apart(a: &[DVec2; 3], b: &[DVec2; 3], tau: f32) -> bool {
    let parts = |a: &[DVec2; 3], b: &[DVec2; 3]| {
        (0..3).any(|i| {
            let (from, along) = (a[i], a[(i + 1) % 3] - a[i]);
            let strip = f64::from(tau) * along.length();
            b.iter().all(|&p| along.perp_dot(p - from) < strip)
        })
    };
    parts(a, b) || parts(b, a)
}
