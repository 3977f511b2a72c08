//! The plane of a flat cluster as a coordinate frame, in f64.

use glam::{DVec2, DVec3};

/// An orthonormal right-handed frame: `u` and `v` span the plane, `n` is its normal.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlaneFrame {
    pub origin: DVec3,
    pub u: DVec3,
    pub v: DVec3,
    pub n: DVec3,
}

impl PlaneFrame {
    /// The frame at the area-weighted centroid of `triangles`, its normal their mean by area; `None`
    /// where their normals cancel. Slivers weigh next to nothing, as they should.
    pub fn fit(triangles: impl Iterator<Item = [DVec3; 3]>) -> Option<Self> {
        let mut normal = DVec3::ZERO;
        let mut moment = DVec3::ZERO;
        let mut area = 0.0;
        for [a, b, c] in triangles {
            let cross = (b - a).cross(c - a);
            let weight = cross.length();
            normal += cross;
            moment += weight * (a + b + c) / 3.0;
            area += weight;
        }
        // Normals that cancel to a thousandth of their sum say nothing about a plane.
        if area.is_nan() || area <= 0.0 || normal.length() < 1.0e-3 * area {
            return None;
        }
        let n = normal.normalize();
        let (u, v) = n.any_orthonormal_pair();
        Some(Self {
            origin: moment / area,
            u,
            v,
            n,
        })
    }

    /// Coordinates of `point` along `u`, `v` and `n`.
    pub fn project(&self, point: DVec3) -> DVec3 {
        let d = point - self.origin;
        DVec3::new(self.u.dot(d), self.v.dot(d), self.n.dot(d))
    }

    /// The point with coordinates `p`: the inverse of [`Self::project`].
    pub fn lift(&self, p: DVec3) -> DVec3 {
        self.origin + self.u * p.x + self.v * p.y + self.n * p.z
    }

    /// This frame moved along its normal.
    #[must_use]
    pub fn raised(&self, height: f64) -> Self {
        Self {
            origin: self.origin + self.n * height,
            ..*self
        }
    }

    /// This frame turned within its plane so that its `u` is `axis` (unit, in its coordinates).
    #[must_use]
    pub fn turned(&self, axis: DVec2) -> Self {
        Self {
            u: self.u * axis.x + self.v * axis.y,
            v: self.v * axis.x - self.u * axis.y,
            ..*self
        }
    }
}
