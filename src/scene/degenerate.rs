//! Polygons that cannot receive light of their own: without area, or exact copies of another.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Least altitude of a polygon in normalised units, 2^-25: rounding to f32 moves a coordinate
/// of the unit cube by up to 2^-26, so below it a polygon's facing is decided by rounding alone.
/// A sliver as long as the scene keeps an aspect of 10^7 (altitude 2^-24 for a length of 1/2).
const LEAST_ALTITUDE: f64 = 1.0 / (1u64 << 25) as f64;

/// Aspect (longest edge to altitude) up to which a triangle has an honest shape, so that losing it
/// is a matter of the scene's size and not of the triangle: thinner ones are lost with less than a
/// thousandth of the area that their edges suggest.
const HONEST_ASPECT: f64 = 1e3;

/// What becomes of a triangle when its corners are rounded to f32.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shape {
    /// Distinct corners and a normal on the side where the unrounded one points.
    Sound,
    /// No area, or none that f32 can hold beside its length.
    Degenerate,
    /// An honest triangle, too small beside the scene for f32.
    Collapsed,
}

/// Judges a triangle of normalised corners by its `exact` (f64) and its `rounded` (f32) form.
pub(super) fn shape_of(exact: [DVec3; 3], rounded: [Vec3; 3]) -> Shape {
    let (normal, longest) = normal_and_longest(exact);
    let altitude = normal.length() / longest;
    // Differences of f32 are exact in f64 and so are their products: only the last subtraction of
    // each component rounds, so that the computed normal is zero only where the true one is.
    let (rounded_normal, _) = normal_and_longest(rounded.map(Vec3::as_dvec3));
    if longest > 0.0 && altitude > LEAST_ALTITUDE && rounded_normal.dot(normal) > 0.0 {
        Shape::Sound
    } else if longest > 0.0 && altitude * HONEST_ASPECT > longest {
        Shape::Collapsed
    } else {
        Shape::Degenerate
    }
}

fn normal_and_longest([a, b, c]: [DVec3; 3]) -> (DVec3, f64) {
    let (ab, bc, ca) = (b - a, c - b, a - c);
    let longest = ab
        .length_squared()
        .max(bc.length_squared())
        .max(ca.length_squared())
        .sqrt();
    (ab.cross(-ca), longest)
}

/// For each position the least index with the same coordinates.
pub(super) fn weld_exact(positions: &[Vec3]) -> Vec<u32> {
    // Adding zero makes -0 and +0 one.
    let key = |i: &u32| {
        (positions[*i as usize] + Vec3::ZERO)
            .to_array()
            .map(f32::to_bits)
    };
    let mut order: Vec<u32> = (0..positions.len() as u32).collect();
    order.par_sort_unstable_by_key(|i| (key(i), *i));
    let mut welded = vec![0; positions.len()];
    for run in order.chunk_by(|a, b| key(a) == key(b)) {
        for &i in run {
            welded[i as usize] = run[0];
        }
    }
    welded
}

/// A ring turned so that it starts at its least vertex: equal for rings that differ in their start
/// only, different for rings that face opposite ways.
pub(super) fn turn_to_least(ring: &mut [u32]) {
    let least = (0..ring.len()).min_by_key(|&i| ring[i]).unwrap_or(0);
    ring.rotate_left(least);
}

/// Indices of keys that occurred before, ascending.
pub(super) fn repeated<K: Ord + Sync>(keys: &[K]) -> Vec<u32> {
    let mut order: Vec<u32> = (0..keys.len() as u32).collect();
    order.par_sort_unstable_by_key(|&i| (&keys[i as usize], i));
    let mut repeated: Vec<u32> = order
        .chunk_by(|&a, &b| keys[a as usize] == keys[b as usize])
        .flat_map(|run| run[1..].iter().copied())
        .collect();
    repeated.par_sort_unstable();
    repeated
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn judge(corners: [DVec3; 3]) -> Shape {
        shape_of(corners, corners.map(|p| p.as_vec3()))
    }

    #[test]
    fn slivers_across_the_scene_survive() {
        for aspect in [1e5, 1e6, 1e7] {
            // A length of 0.8 and an altitude of 0.8 / aspect, askew.
            let along = DVec3::new(0.6, 0.48, 0.24).normalize() * 0.8;
            let up = along.cross(DVec3::Z).normalize() * (0.8 / aspect);
            let start = DVec3::splat(-0.3);
            let corners = [start, start + along, start + along * 0.4 + up];
            assert_eq!(judge(corners), Shape::Sound, "{aspect}");
        }
    }

    #[test]
    fn points_lines_and_specks_do_not() {
        let third = DVec3::new(0.1, 0.1, 0.1);
        assert_eq!(judge([third; 3]), Shape::Degenerate);
        assert_eq!(judge([DVec3::ZERO, third, third * 3.0]), Shape::Degenerate);
        let speck = [
            DVec3::X * 0.4,
            DVec3::X * (0.4 + 1e-9),
            DVec3::new(0.4, 1e-9, 0.0),
        ];
        assert_eq!(judge(speck), Shape::Collapsed);
    }

    proptest! {
        #[test]
        fn a_sound_triangle_has_distinct_corners_and_a_normal(
            corners in prop::array::uniform3(prop::array::uniform3(-0.5..0.5f64)),
            shrink in -40..1i32,
        ) {
            let [a, b, c] = corners.map(DVec3::from);
            // Squeezes the third corner towards the first edge.
            let squeezed = a + (b - a) * 0.3 + (c - a) * 2f64.powi(shrink);
            let exact = [a, b, squeezed];
            let rounded = exact.map(|p| p.as_vec3());
            if shape_of(exact, rounded) == Shape::Sound {
                prop_assert!(rounded[0] != rounded[1] && rounded[1] != rounded[2] && rounded[2] != rounded[0]);
                prop_assert!(normal_and_longest(rounded.map(Vec3::as_dvec3)).0.length() > 0.0);
            } else {
                prop_assert!(normal_and_longest(exact).0.length() < 1e-7, "an area was given up");
            }
        }
    }

    #[test]
    fn welding_joins_equal_positions_only() {
        let p = |x: f32| Vec3::new(x, 0.0, 1.0);
        let positions = [p(1.0), p(0.0), p(1.0), p(-0.0), p(1.0f32.next_up())];
        assert_eq!(weld_exact(&positions), [0, 1, 0, 1, 4]);
    }

    #[test]
    fn copies_face_the_same_way() {
        let mut keys = [[2, 0, 1], [1, 2, 0], [0, 2, 1], [0, 1, 2]];
        keys.iter_mut().for_each(|k| turn_to_least(k));
        assert_eq!(repeated(&keys), [1, 3]);
    }
}
