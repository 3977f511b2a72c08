//! A polygon of the scene with what the slow tests want to know of its plane, worked out once.

use super::tolerance::Tolerance;
use crate::math::PolygonId;
use glam::{DVec3, Vec3};

/// Share of the weld distance by which polygons are pulled in. The rest, a quarter of 1e-6 of the
/// diagonal, is more than rounding the pulled-in corners to f32 can move them (5.2e-8 of it).
pub(super) const PULL: f64 = 0.75;

/// What a polygon's thickness, judged by its inscribed circle, says about its plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PlaneKnown {
    /// The normal is right; the polygon may be pulled in.
    Broad,
    /// The normal is right, but many such slivers side by side are a wall that pulling them in
    /// would open.
    Narrow,
    /// So thin that the plane is noise. It has no interior that could surely block, but a wall may
    /// be made of many such: there is no claim past it.
    Noise,
    /// Thinner than a thirty-second of the weld distance, as the poles of spheres leave them: eight
    /// million side by side would not wall off the scene, and one surely blocks nothing.
    Hairline,
}

/// Polygons whose inscribed circle is smaller than this many weld distances are narrow.
const NARROW: f64 = 16.0;

/// A polygon of a leaf.
#[derive(Clone, Copy, Debug)]
pub(super) struct StoredPolygon {
    pub corners: [Vec3; 3],
    pub id: PolygonId,
    pub known: PlaneKnown,
    /// Unit normal; meaningless for noise and hairlines.
    pub normal: DVec3,
}

impl StoredPolygon {
    /// An unused lane.
    pub(super) const NONE: Self = Self {
        corners: [Vec3::ZERO; 3],
        id: PolygonId(u32::MAX),
        known: PlaneKnown::Hairline,
        normal: DVec3::ZERO,
    };

    /// Error of the normal where it is known: coordinates are f32 and exact here, so it is
    /// `4e-16 * longest^2 / |n|`, below 1e-9 for every triangle whose inscribed circle is not below
    /// half of the weld distance.
    pub(super) fn new(corners: [Vec3; 3], id: PolygonId, tolerance: &Tolerance) -> Self {
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a);
        let length = normal.length();
        let perimeter = (b - a).length() + (c - b).length() + (a - c).length();
        let weld = f64::from(tolerance.weld);
        // Twice the area is the perimeter times the radius of the inscribed circle.
        let known = if length > NARROW * weld * perimeter {
            PlaneKnown::Broad
        } else if length > 0.5 * weld * perimeter {
            PlaneKnown::Narrow
        } else if length < weld / 32.0 * perimeter {
            PlaneKnown::Hairline
        } else {
            PlaneKnown::Noise
        };
        Self {
            corners,
            id,
            known,
            normal: normal / length,
        }
    }

    /// Whether it may block, where its shape alone says so.
    #[inline(always)]
    pub(super) fn may_block_by_shape(&self) -> Option<bool> {
        match self.known {
            PlaneKnown::Broad | PlaneKnown::Narrow => None,
            PlaneKnown::Noise => Some(true),
            PlaneKnown::Hairline => Some(false),
        }
    }

    /// How far the tests pull the polygon's border in: [`PULL`] weld distances or nothing.
    pub(super) fn pull(&self, tolerance: &Tolerance) -> f64 {
        match self.known {
            PlaneKnown::Broad => PULL * f64::from(tolerance.weld),
            _ => 0.0,
        }
    }

    /// The corners pulled in: the triangle shrunk about the centre of its inscribed circle.
    pub(super) fn pulled_in(&self, tolerance: &Tolerance) -> [DVec3; 3] {
        let [a, b, c] = self.corners.map(Vec3::as_dvec3);
        let pull = self.pull(tolerance);
        if pull == 0.0 {
            return [a, b, c];
        }
        let (la, lb, lc) = ((b - c).length(), (c - a).length(), (a - b).length());
        let perimeter = la + lb + lc;
        let inradius = (b - a).cross(c - a).length() / perimeter;
        let incentre = (a * la + b * lb + c * lc) / perimeter;
        let keep = 1.0 - pull / inradius;
        [a, b, c].map(|p| incentre + (p - incentre) * keep)
    }
}
