//! A ray, or a segment of one.

use glam::Vec3;

/// The points `origin + t * direction` with `tnear <= t <= tfar`. `direction` need not have unit
/// length: `t` counts in its lengths.
///
/// The layout is that of `certilux_ray` in `ffi/`, so that slices cross without a copy.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where `t` is 0.
    pub origin: Vec3,
    /// Start, at least 0.
    pub tnear: f32,
    /// Direction, of any length but 0.
    pub direction: Vec3,
    /// End; may be infinite.
    pub tfar: f32,
}

impl Ray {
    /// The segment from `from` (at `t` = 0) to `to` (at `t` = 1).
    pub fn segment(from: Vec3, to: Vec3) -> Self {
        Self {
            origin: from,
            tnear: 0.0,
            direction: to - from,
            tfar: 1.0,
        }
    }

    /// The half-line from `origin` in `direction`, without its first `tnear`.
    pub fn half_line(origin: Vec3, direction: Vec3, tnear: f32) -> Self {
        Self {
            origin,
            tnear,
            direction,
            tfar: f32::INFINITY,
        }
    }

    /// The point at `t`.
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + self.direction * t
    }
}

impl From<Ray> for embree4_sys::RTCRay {
    #[inline]
    fn from(ray: Ray) -> Self {
        Self {
            org_x: ray.origin.x,
            org_y: ray.origin.y,
            org_z: ray.origin.z,
            tnear: ray.tnear,
            dir_x: ray.direction.x,
            dir_y: ray.direction.y,
            dir_z: ray.direction.z,
            time: 0.0,
            tfar: ray.tfar,
            mask: u32::MAX,
            id: 0,
            flags: 0,
        }
    }
}
