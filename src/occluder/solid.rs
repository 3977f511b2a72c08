//! A box of which opaque surface covers two faces or more: an occluder with a volume.
//!
//! Where a pair looks past the edge of a table top or the corner of a cupboard, part of its segments crosses one face and
//! the rest another, and no rectangle holds them all; the solid between the faces does. (The paper's conclusion names
//! volume occluders as the next step.)

use crate::math::Aabb;
use glam::{DVec3, Vec3};

/// A box, not along the axes in general, some of whose faces are covered.
///
/// # Exact meaning
///
/// Let K be the convex hull of [`Self::corners`]. Every point of a covered face is within w (the weld distance, 1e-6 of the
/// scene's diagonal) of some polygon. Take a segment whose ends both lie outside of K, farther than tau, and that meets K. It
/// comes in through a face beyond whose plane one end lies, and leaves through one beyond whose plane the other does. If
/// the faces are covered beyond which the one end lies, or those beyond which the other does, the segment passes a covered
/// face farther than tau from both its ends, so it is never *surely clear*.
///
/// # Why eight by eight segments are enough
///
/// For one point `a` outside of K, the points `x` for which the segment from `a` to `x` meets K are convex: they are
/// `a + t (k - a)` with `k` in K and `t >= 1`, and two such are joined by others. So if the segments from `a` to all
/// corners of a convex `B` meet K, those to all points of `B` do; and the same with the ends exchanged. If all segments
/// between corners of `A` and corners of `B` meet K, then all segments between the two do.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Its middle.
    pub centre: Vec3,
    /// From the middle to the middles of three of its faces; orthogonal up to rounding.
    pub halves: [Vec3; 3],
    /// Which faces are covered, by axis: the one against the axis' half and the one along it.
    pub covered: [[bool; 2]; 3],
}

impl Solid {
    /// The corner on these sides of the middle, each 1 or -1. These f64 points *define* the solid.
    pub fn corner(&self, sides: [f64; 3]) -> DVec3 {
        (0..3).fold(self.centre.as_dvec3(), |at, i| {
            at + self.halves[i].as_dvec3() * sides[i]
        })
    }

    /// All corners: bit `i` of a corner's place says on which side of `halves[i]` it lies.
    pub fn corners(&self) -> [DVec3; 8] {
        std::array::from_fn(|at| {
            self.corner(std::array::from_fn(|i| match at >> i & 1 {
                0 => -1.0,
                _ => 1.0,
            }))
        })
    }

    /// The corners of the face at `side` (1 or -1) of `axis` (0, 1, 2), around it, counter-clockwise seen from outside
    /// where the halves are right-handed.
    pub fn face(&self, axis: usize, side: f64) -> [DVec3; 4] {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let at = |su: f64, sv: f64| {
            let mut sides = [side; 3];
            (sides[u], sides[v]) = (su, sv * side);
            self.corner(sides)
        };
        [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)]
    }

    /// Its axis-aligned box, rounded outwards.
    pub fn bounds(&self) -> Aabb {
        let corners = self.corners();
        let low = corners.iter().fold(corners[0], |m, &c| m.min(c)).as_vec3();
        let high = corners.iter().fold(corners[0], |m, &c| m.max(c)).as_vec3();
        let out = |v: Vec3, up: bool| {
            Vec3::from_array(v.to_array().map(|x| match up {
                true => x.next_up(),
                false => x.next_down(),
            }))
        };
        Aabb {
            min: out(low, false),
            max: out(high, true),
        }
    }

    /// True if `other` lies inside, up to `slack`, with its faces parallel to this one's, and none of them covered that is
    /// open here: what it hides, this one hides too.
    pub(super) fn replaces(&self, other: &Self, slack: f64) -> bool {
        let from = other.centre.as_dvec3() - self.centre.as_dvec3();
        (0..3).all(|i| {
            let mine = self.halves[i].as_dvec3();
            let (length, out) = (mine.length(), mine.normalize());
            let along = |j: usize| other.halves[j].as_dvec3().normalize().dot(out);
            let parallel = (0..3).find(|&j| along(j).abs() > 1.0 - 1.0e-9);
            parallel.is_some_and(|j| {
                let turned = along(j) < 0.0;
                let reach = other.halves[j].as_dvec3().length();
                let at = from.dot(out);
                let covers = |face: usize| {
                    self.covered[i][face] || !other.covered[j][face ^ usize::from(turned)]
                };
                at.abs() + reach <= length + slack && covers(0) && covers(1)
            })
        })
    }

    /// Volume.
    pub fn volume(&self) -> f32 {
        let [a, b, c] = self.halves;
        8.0 * a.cross(b).dot(c).abs()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn faces_run_counter_clockwise_seen_from_outside() {
        let solid = Solid {
            centre: Vec3::new(0.1, -0.2, 0.3),
            halves: [Vec3::X * 0.1, Vec3::Y * 0.2, Vec3::Z * 0.05],
            covered: [[true; 2]; 3],
        };
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let [a, b, c, d] = solid.face(axis, side);
                let outwards = solid.halves[axis].as_dvec3() * side;
                assert!((b - a).cross(c - b).dot(outwards) > 0.0);
                assert!((a + c - b - d).length() < 1e-15);
                let middle = 0.25 * (a + b + c + d) - solid.centre.as_dvec3();
                assert!((middle - outwards).length() < 1e-15);
            }
        }
        let all = solid.corners();
        assert!(all.iter().all(|c| solid.bounds().contains(c.as_vec3())));
        assert!((solid.volume() - 0.008).abs() < 1e-8);
    }
}
