//! Axis-aligned boxes of f32, rounded outwards where anything is rounded.

use glam::Vec3;

/// A closed axis-aligned box; empty when some `min > max`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Least corner.
    pub min: Vec3,
    /// Greatest corner.
    pub max: Vec3,
}

impl Aabb {
    /// The box that contains nothing.
    pub const EMPTY: Self = Self {
        min: Vec3::INFINITY,
        max: Vec3::NEG_INFINITY,
    };

    /// The smallest box around `points`.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::with_point)
    }

    /// The smallest box around a triangle with finite corners: by comparisons, where `f32::min` would look for NaN too.
    #[inline]
    pub fn of_triangle([a, b, c]: [Vec3; 3]) -> Self {
        let least = |a: f32, b: f32| if a < b { a } else { b };
        let greatest = |a: f32, b: f32| if a > b { a } else { b };
        let fold = |by: fn(f32, f32) -> f32| {
            Vec3::new(
                by(by(a.x, b.x), c.x),
                by(by(a.y, b.y), c.y),
                by(by(a.z, b.z), c.z),
            )
        };
        Self {
            min: fold(least),
            max: fold(greatest),
        }
    }

    /// This box grown to contain `point`.
    #[must_use]
    pub fn with_point(self, point: Vec3) -> Self {
        Self {
            min: self.min.min(point),
            max: self.max.max(point),
        }
    }

    /// The smallest box around both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            min: self.min.min(other.min),
            max: self.max.max(other.max),
        }
    }

    /// True when no point is inside.
    pub fn is_empty(self) -> bool {
        self.min.cmpgt(self.max).any()
    }

    /// Midpoint, rounded to nearest.
    pub fn centre(self) -> Vec3 {
        (self.min + self.max) * 0.5
    }

    /// Half-extents about the *rounded* [`Self::centre`], rounded so that `centre +- half` always
    /// contains the box (computed naively it misses the true box about half the time).
    pub fn half_extent(self) -> Vec3 {
        let centre = self.centre();
        let half = (self.max - centre).max(centre - self.min);
        // One rounding in each difference: a relative 2^-24 each; next_up covers it.
        Vec3::new(half.x.next_up(), half.y.next_up(), half.z.next_up())
    }

    /// Length of the diagonal.
    pub fn diagonal(self) -> f32 {
        (self.max - self.min).length()
    }

    /// Area of the six sides; zero for an empty box.
    pub fn surface_area(self) -> f32 {
        if self.is_empty() {
            return 0.0;
        }
        let e = self.max - self.min;
        2.0 * (e.x * e.y + e.y * e.z + e.z * e.x)
    }

    /// True when `point` is inside or on the border.
    pub fn contains(self, point: Vec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// True when `other` lies wholly inside (an empty box lies in every box).
    pub fn contains_box(self, other: Self) -> bool {
        other.is_empty() || (self.min.cmple(other.min).all() && other.max.cmple(self.max).all())
    }

    /// Distance between the closest points of two boxes, zero when they meet.
    pub fn distance(self, other: Self) -> f32 {
        (other.min - self.max)
            .max(self.min - other.max)
            .max(Vec3::ZERO)
            .length()
    }

    /// The eight corners; bit 0, 1, 2 of the index choose the greater x, y, z.
    pub fn corners(self) -> [Vec3; 8] {
        std::array::from_fn(|i| {
            Vec3::new(
                if i & 1 == 0 { self.min.x } else { self.max.x },
                if i & 2 == 0 { self.min.y } else { self.max.y },
                if i & 4 == 0 { self.min.z } else { self.max.z },
            )
        })
    }
}
