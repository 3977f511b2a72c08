//! Convex bounds of an element: what both guaranteed tests know of it.
//!
//! Design, section 5: planar elements and flat clusters use their corners, a much tighter bound
//! than their axis-aligned boxes.

use crate::math::Aabb;
use glam::Vec3;

/// How the corners of [`ElementBounds`] hang together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoundsShape {
    /// An axis-aligned box; the corners are those of [`Aabb::corners`].
    Box,
    /// A planar convex polygon; the corners run around it.
    Polygon,
    /// Two parallel faces of four corners each: a flat cluster with its thickness. Corners 0..4 run
    /// around one face, 4..8 around the other in the same sense.
    Slab,
}

/// A convex set that contains an element (up to [`super::Tolerance::nesting`]), as 1 to 8 corners
/// in structure-of-arrays form.
#[derive(Clone, Copy, Debug)]
pub struct ElementBounds {
    pub(super) x: [f32; 8],
    pub(super) y: [f32; 8],
    pub(super) z: [f32; 8],
    pub(super) aabb: Aabb,
    /// Centre and half-extents of `aabb`, rounded outwards.
    pub(super) box_centre: Vec3,
    pub(super) half: Vec3,
    centre: Vec3,
    count: u32,
    shape: BoundsShape,
}

impl ElementBounds {
    /// An axis-aligned box (not empty), which may be flat.
    #[inline]
    pub fn from_box(aabb: Aabb) -> Self {
        debug_assert!(!aabb.is_empty(), "an element has points");
        Self::with_corners(&aabb.corners(), aabb, BoundsShape::Box)
    }

    /// A triangle whose axis-aligned box is known.
    #[inline]
    pub fn from_triangle([p, q, r]: [Vec3; 3], aabb: Aabb) -> Self {
        let lanes = |p: f32, q: f32, r: f32| [p, q, r, r, r, r, r, r];
        Self {
            x: lanes(p.x, q.x, r.x),
            y: lanes(p.y, q.y, r.y),
            z: lanes(p.z, q.z, r.z),
            aabb,
            box_centre: aabb.centre(),
            half: aabb.half_extent(),
            centre: (p + q + r) / 3.0,
            count: 3,
            shape: BoundsShape::Polygon,
        }
    }

    /// The convex planar polygon with these 3 to 8 corners, in order around it.
    ///
    /// # Panics
    /// If there are no corners or more than 8.
    #[inline]
    pub fn from_polygon(corners: &[Vec3]) -> Self {
        let aabb = Aabb::from_points(corners.iter().copied());
        Self::with_corners(corners, aabb, BoundsShape::Polygon)
    }

    /// The prism over `face` (a parallelogram, in order around it) that reaches `thickness` to
    /// either side: the oriented box of a flat cluster. `thickness` is along the face's normal and
    /// as long as the cluster's deviation and its margin together.
    pub fn from_slab(face: [Vec3; 4], thickness: Vec3) -> Self {
        let corners: [Vec3; 8] = std::array::from_fn(|i| {
            if i < 4 {
                face[i] - thickness
            } else {
                face[i - 4] + thickness
            }
        });
        let aabb = Aabb::from_points(corners);
        Self::with_corners(&corners, aabb, BoundsShape::Slab)
    }

    #[inline]
    fn with_corners(corners: &[Vec3], aabb: Aabb, shape: BoundsShape) -> Self {
        assert!(
            (1..=8).contains(&corners.len()),
            "an element's bound has 1 to 8 corners"
        );
        // Lanes beyond the count repeat the last corner: harmless to every minimum and maximum.
        let last = corners[corners.len() - 1];
        let (mut x, mut y, mut z) = ([last.x; 8], [last.y; 8], [last.z; 8]);
        for (i, corner) in corners.iter().enumerate() {
            (x[i], y[i], z[i]) = (corner.x, corner.y, corner.z);
        }
        Self {
            x,
            y,
            z,
            aabb,
            box_centre: aabb.centre(),
            half: aabb.half_extent(),
            centre: match shape {
                BoundsShape::Box => aabb.centre(),
                _ => corners.iter().sum::<Vec3>() / corners.len() as f32,
            },
            count: corners.len() as u32,
            shape,
        }
    }

    /// The axis-aligned box of the corners.
    pub fn aabb(&self) -> Aabb {
        self.aabb
    }

    /// Mean of the corners, up to rounding: a point of the set itself, which the midpoint of its
    /// box need not be.
    pub fn centre(&self) -> Vec3 {
        self.centre
    }

    /// How the corners hang together.
    pub fn shape(&self) -> BoundsShape {
        self.shape
    }

    /// Number of corners.
    pub fn corner_count(&self) -> usize {
        self.count as usize
    }

    /// Corner `i`, below [`Self::corner_count`].
    pub fn corner(&self, i: usize) -> Vec3 {
        Vec3::new(self.x[i], self.y[i], self.z[i])
    }

    /// All corners.
    pub fn corners(&self) -> impl Iterator<Item = Vec3> + '_ {
        (0..self.corner_count()).map(|i| self.corner(i))
    }

    /// Successor of corner `i` around its face; meaningless for boxes.
    pub(super) fn next_corner(&self, i: usize) -> usize {
        match self.shape {
            BoundsShape::Polygon => (i + 1) % self.corner_count(),
            BoundsShape::Slab | BoundsShape::Box => (i & 4) | ((i + 1) & 3),
        }
    }
}
