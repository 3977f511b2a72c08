//! Planes in Hesse normal form.

use glam::Vec3;

/// The plane of points `x` with `normal . x = offset`; `normal` has unit length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Unit normal.
    pub normal: Vec3,
    /// Signed distance of the plane from the origin along the normal.
    pub offset: f32,
}

impl Plane {
    /// The plane through `point` with unit `normal`.
    pub fn through(point: Vec3, normal: Vec3) -> Self {
        Self {
            normal,
            offset: normal.dot(point),
        }
    }

    /// Signed distance of `point`, positive on the normal's side.
    pub fn distance(self, point: Vec3) -> f32 {
        self.normal.dot(point) - self.offset
    }
}
