//! Which axis of a scene is up.

use glam::DVec3;

/// An axis that points upwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpAxis {
    /// +x.
    X,
    /// +y: the custom of OBJ files, and the rule of glTF.
    Y,
    /// +z: the custom of buildings and of Blender's own scenes.
    Z,
}

impl UpAxis {
    /// The axis that a direction is closest to, upwards or downwards.
    pub fn nearest(direction: DVec3) -> Self {
        let [x, y, z] = direction.abs().to_array();
        match (x > y && x > z, z > y) {
            (true, _) => Self::X,
            (false, true) => Self::Z,
            (false, false) => Self::Y,
        }
    }

    /// Its direction.
    pub fn direction(self) -> DVec3 {
        match self {
            Self::X => DVec3::X,
            Self::Y => DVec3::Y,
            Self::Z => DVec3::Z,
        }
    }

    /// Two horizontal directions; with this one they are right-handed, this one last.
    pub(super) fn level(self) -> [DVec3; 2] {
        let first = match self {
            Self::X => DVec3::Y,
            Self::Y | Self::Z => DVec3::X,
        };
        [first, self.direction().cross(first)]
    }

    /// The point turned so that up is +y: a rotation by right angles, which rounds nothing.
    pub(super) fn turned_to_y(self, p: DVec3) -> DVec3 {
        match self {
            Self::X => DVec3::new(-p.y, p.x, p.z),
            Self::Y => p,
            Self::Z => DVec3::new(p.x, p.z, -p.y),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turning_is_a_rotation_that_brings_up_to_y() {
        for up in [UpAxis::X, UpAxis::Y, UpAxis::Z] {
            assert_eq!(up.turned_to_y(up.direction()), DVec3::Y);
            let [a, b, c] = DVec3::AXES.map(|axis| up.turned_to_y(axis));
            assert_eq!(a.cross(b), c, "{up:?} is mirrored");
            let [first, second] = up.level();
            assert_eq!(first.cross(second), up.direction());
            assert_eq!(UpAxis::nearest(up.direction() + 0.4 * first), up);
            assert_eq!(UpAxis::nearest(-up.direction() - 0.4 * second), up);
        }
    }
}
