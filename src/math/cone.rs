//! Cones of directions, conservative: they may be too wide, never too narrow.

use glam::Vec3;

/// All unit directions within `half_angle` of `axis`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone {
    /// Unit axis.
    pub axis: Vec3,
    /// Half-angle in radians, in [0, pi]; pi is every direction.
    pub half_angle: f32,
}

impl Cone {
    /// Rounding of one f32 angle or normalisation, added wherever a cone is widened.
    const ROUNDING: f32 = 4.0e-7;

    /// Every direction.
    pub const EVERYTHING: Self = Self {
        axis: Vec3::Z,
        half_angle: std::f32::consts::PI,
    };

    /// The cone of one unit direction, no wider than rounding asks.
    pub fn from_direction(axis: Vec3) -> Self {
        Self {
            axis,
            half_angle: 0.0,
        }
    }

    /// A cone containing both; not always the smallest.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let (wide, narrow) = if self.half_angle >= other.half_angle {
            (self, other)
        } else {
            (other, self)
        };
        let between = angle_between(wide.axis, narrow.axis);
        if between + narrow.half_angle <= wide.half_angle {
            return wide;
        }
        if between <= Self::ROUNDING {
            return Self {
                axis: wide.axis,
                half_angle: (between + wide.half_angle.max(narrow.half_angle) + Self::ROUNDING)
                    .min(std::f32::consts::PI),
            };
        }
        let half_angle = 0.5 * (between + wide.half_angle + narrow.half_angle) + Self::ROUNDING;
        if half_angle >= std::f32::consts::PI {
            return Self::EVERYTHING;
        }
        // Turn the wider cone's axis towards the narrower one's by what the half-angle grew.
        let turn = half_angle - wide.half_angle;
        let ortho = narrow.axis - wide.axis * wide.axis.dot(narrow.axis);
        let Some(ortho) = ortho.try_normalize() else {
            return Self::EVERYTHING;
        };
        let axis = (wide.axis * turn.cos() + ortho * turn.sin()).normalize();
        Self {
            axis,
            half_angle: (half_angle + Self::ROUNDING).min(std::f32::consts::PI),
        }
    }

    /// True when `direction` (unit) lies inside, up to rounding.
    pub fn contains(self, direction: Vec3) -> bool {
        angle_between(self.axis, direction) <= self.half_angle + Self::ROUNDING
    }
}

/// Angle between unit vectors in radians, accurate near 0 and pi where `acos(dot)` is not.
fn angle_between(a: Vec3, b: Vec3) -> f32 {
    2.0 * (a - b).length().atan2((a + b).length())
}
