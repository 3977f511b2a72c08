//! A segment against a whole scene, by the definitions of [`Tolerance`], by brute force: what settles
//! a ray that contradicts a claim.

use super::segment::{is_off, surely_blocked, surely_clear_of};
use crate::math::{Aabb, PolygonId};
use crate::visibility::{SceneTree, Tolerance};
use glam::{DVec3, Vec3};

/// What is sure of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SegmentStanding {
    /// This polygon surely blocks it.
    Blocked(PolygonId),
    /// It is surely clear of every polygon that neither of its ends lies on, within `tau`.
    Clear,
    /// Neither: it grazes, passes a shared edge or a welded crack.
    Between,
}

/// Judges a segment exactly. Linear in the number of polygons.
///
/// A segment between surfaces starts on a polygon, and cut back by `tau` it is still within `weld` of
/// it, both being the same length: by the letter of the definition none would ever be clear. So the
/// polygons that an end lies on do not count. No occlusion claim rests on one of those: what blocks
/// a claimed pair lies in a slab that both elements are beyond by more than `tau`.
pub fn judge_segment(scene: &SceneTree, p: DVec3, q: DVec3) -> SegmentStanding {
    let tolerance = scene.tolerance();
    let near = near_segment(scene, p, q, tolerance);
    if let Some(&(id, _)) = near
        .iter()
        .find(|(_, corners)| surely_blocked(p, q, *corners, tolerance))
    {
        return SegmentStanding::Blocked(id);
    }
    let clear = (q - p).length() > 3.0 * f64::from(tolerance.tau)
        && near.iter().all(|(_, corners)| {
            surely_clear_of(p, q, *corners, tolerance)
                || !is_off(p, *corners, tolerance.tau)
                || !is_off(q, *corners, tolerance.tau)
        });
    if clear {
        SegmentStanding::Clear
    } else {
        SegmentStanding::Between
    }
}

/// Polygons whose boxes come within two weld distances of the segment's box: the others are surely
/// missed by more than one.
fn near_segment(
    scene: &SceneTree,
    p: DVec3,
    q: DVec3,
    tolerance: &Tolerance,
) -> Vec<(PolygonId, [Vec3; 3])> {
    let margin = Vec3::splat(2.0 * tolerance.weld);
    let tight = Aabb::from_points([p.as_vec3(), q.as_vec3()]);
    let (low, high) = (tight.min - margin, tight.max + margin);
    scene
        .polygons()
        .filter(|(_, corners)| {
            let bounds = Aabb::from_points(*corners);
            bounds.min.cmple(high).all() && bounds.max.cmpge(low).all()
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two squares of side 1 at z = 0 and z = 1, the second half as wide.
    fn sheets() -> SceneTree {
        let square = |z: f32, half: f32| {
            let corner = |x: f32, y: f32| Vec3::new(x * half, y * half, z);
            let (a, b, c, d) = (
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            );
            [[a, b, c], [a, c, d]]
        };
        let triangles = [square(0.0, 0.5), square(1.0, 0.25)].concat();
        let bounds = Aabb::from_points(triangles.iter().flatten().copied());
        SceneTree::over_triangles(&triangles, Tolerance::of_scene(bounds))
    }

    #[test]
    fn segments_are_blocked_clear_or_between() {
        let scene = sheets();
        let judge = |p: [f64; 3], q: [f64; 3]| judge_segment(&scene, p.into(), q.into());
        assert_eq!(
            judge([0.1, 0.05, 0.2], [0.1, 0.05, -0.2]),
            SegmentStanding::Blocked(PolygonId(0))
        );
        assert_eq!(
            judge([0.4, 0.4, 0.2], [0.4, 0.4, 1.2]),
            SegmentStanding::Clear
        );
        // From one sheet past the other, and from one sheet to the other.
        assert_eq!(
            judge([0.45, 0.45, 0.0], [0.3, 0.4, 1.2]),
            SegmentStanding::Clear
        );
        assert_eq!(
            judge([0.1, 0.05, 0.0], [0.1, 0.05, 1.0]),
            SegmentStanding::Clear
        );
        // Through the border, and through the seam of the two triangles.
        assert_eq!(
            judge([0.5, 0.1, 0.2], [0.5, 0.1, -0.2]),
            SegmentStanding::Between
        );
        assert_eq!(
            judge([0.1, 0.1, 0.2], [0.1, 0.1, -0.2]),
            SegmentStanding::Between
        );
    }
}
