//! A rectangle thickened to a slab: what an occluder promises, and all that the visibility tests
//! need to know of one (paper, section 3.2; the thickness is ours).

use glam::{DVec3, Vec3};

/// A rectangle with a thickness that is certainly covered by opaque surface: every segment that
/// crosses the slab from face to face inside the rectangle crosses that surface.
///
/// The exact meaning, for proofs: the two faces are the quadrilaterals of [`Self::face_corners`].
/// `half_thickness` covers the deviation of the surface, the rounding of the four corners and a
/// numerical margin, so it is never zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlabRectangle {
    /// Corners in the middle plane, counter-clockwise about `normal`.
    pub corners: [Vec3; 4],
    /// Unit normal of the middle plane.
    pub normal: Vec3,
    /// Distance from the middle plane to each face, in normalised units; positive.
    pub half_thickness: f32,
}

impl SlabRectangle {
    /// The rectangle `centre +- half_u +- half_v`. `half_u` and `half_v` are orthogonal and
    /// `normal` points along `half_u x half_v`.
    pub fn new(
        centre: Vec3,
        half_u: Vec3,
        half_v: Vec3,
        normal: Vec3,
        half_thickness: f32,
    ) -> Self {
        Self {
            corners: [
                centre - half_u - half_v,
                centre + half_u - half_v,
                centre + half_u + half_v,
                centre - half_u + half_v,
            ],
            normal,
            half_thickness,
        }
    }

    /// The corners of the face at `side * half_thickness` along the normal, `side` being 1 or -1,
    /// in the order of [`Self::corners`]. These f64 points *define* the faces; their rounding,
    /// 1e-16, is far inside the margin that `half_thickness` carries.
    pub fn face_corners(&self, side: f64) -> [DVec3; 4] {
        let shift = self.normal.as_dvec3() * (side * f64::from(self.half_thickness));
        self.corners.map(|c| c.as_dvec3() + shift)
    }

    /// Area of the rectangle.
    pub fn area(&self) -> f32 {
        let [a, b, _, d] = self.corners;
        (b - a).length() * (d - a).length()
    }
}
