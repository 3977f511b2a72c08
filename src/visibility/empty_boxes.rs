//! Empty boxes: axis-aligned boxes of air into which nothing reaches. Whatever lies in one sees all else that does.
//!
//! A box is convex, so every segment between two of its points stays inside. A pair whose joint box lies in an empty
//! one is fully visible, and seeing that takes some twenty comparisons where a shaft takes thousands of instructions.
//! What proves a box empty ([`super::box_growth`]) holds for all its points with the margins that pairs have, so for
//! every pair inside.

use super::box_growth::BoxGrower;
use super::near_segments::SegmentOctet;
use super::scene_tree::SceneTree;
use super::wide_tree::BoxOctet;
use crate::math::Aabb;
use glam::Vec3;
use rayon::prelude::*;

/// Seeds grown at a time, whatever the number of threads, since each sees only the boxes of the batches before.
const BATCH: usize = 32;

/// Sights that a box must be the first to hold. Boxes that hold only the sight they were grown from say little of others.
const LEAST_GAIN: usize = 2;

/// Batches in a row that may bring less than one box each before the search ends: in large scenes few sights fall
/// on each room.
const POOR_BATCHES: u32 = 4;

/// Empty boxes of a scene, those that hold the most sights first.
#[derive(Clone, Debug, Default)]
pub struct EmptyBoxes {
    boxes: Vec<EmptyBox>,
}

#[derive(Clone, Debug)]
struct EmptyBox {
    bounds: Aabb,
    /// The sights that no earlier box holds.
    sights: Vec<[Vec3; 2]>,
}

impl EmptyBoxes {
    /// Boxes that hold many of `sights`, which are pairs of points that see each other. Each sight that no box holds
    /// yet seeds one, if the box of its two points is empty.
    pub fn build(scene: &SceneTree, sights: &[[Vec3; 2]]) -> Self {
        let grower = BoxGrower::new(scene);
        let slack = 4.0 * scene.tolerance().tau;
        let mut boxes: Vec<EmptyBox> = Vec::new();
        // Sights that no box holds yet, and how many of them have been seeds.
        let mut open = OpenSights::new(sights);
        let mut tried = 0;
        let mut poor = 0;
        while tried < open.sights.len() && poor < POOR_BATCHES {
            let seeds = &open.sights[tried..open.sights.len().min(tried + BATCH)];
            let grow = |grower: &mut BoxGrower, &seed: &[Vec3; 2]| {
                let found = grower.grow(Aabb::from_points(seed))?;
                let loose = Aabb {
                    min: found.min - slack,
                    max: found.max + slack,
                };
                Some((found, open.held_by(loose)))
            };
            let grown: Vec<Option<(Aabb, Vec<usize>)>> =
                seeds.par_iter().map_init(|| grower.clone(), grow).collect();
            let before = boxes.len();
            let mut is_open = vec![true; open.sights.len()];
            for (found, mut held) in grown.into_iter().flatten() {
                held.retain(|&at| is_open[at]);
                if held.len() >= LEAST_GAIN {
                    held.iter().for_each(|&at| is_open[at] = false);
                    boxes.push(EmptyBox {
                        bounds: found,
                        sights: held.into_iter().map(|at| open.sights[at]).collect(),
                    });
                }
            }
            poor = if boxes.len() > before { 0 } else { poor + 1 };
            tried = (0..tried + seeds.len()).filter(|&at| is_open[at]).count();
            if boxes.len() > before {
                let mut kept = is_open.iter();
                open.sights.retain(|_| kept.next() == Some(&true));
                open = OpenSights::new(&open.sights);
            }
        }
        boxes.sort_by_key(|found| std::cmp::Reverse(found.sights.len()));
        Self { boxes }
    }

    /// These boxes, empty or not.
    #[cfg(test)]
    pub fn planted(boxes: Vec<Aabb>) -> Self {
        let empty = |bounds| EmptyBox {
            bounds,
            sights: Vec::new(),
        };
        Self {
            boxes: boxes.into_iter().map(empty).collect(),
        }
    }

    /// The boxes, those that hold the most sights first.
    pub fn boxes(&self) -> Vec<Aabb> {
        self.boxes.iter().map(|found| found.bounds).collect()
    }

    /// The boxes that hold the most sights of `receivers`.
    pub fn near(&self, receivers: Aabb) -> NearbyBoxes {
        let near = self
            .boxes
            .iter()
            .filter(|found| found.bounds.distance(receivers) <= 0.0);
        let mut near: Vec<&EmptyBox> = near.collect();
        // Where all have room nothing hangs on their order.
        if near.len() > 8 {
            near.sort_by_cached_key(|found| {
                let ends = |sight: &&[Vec3; 2]| sight.iter().any(|&p| receivers.contains(p));
                std::cmp::Reverse(found.sights.iter().filter(ends).count())
            });
        }
        let mut octet = BoxOctet::EMPTY;
        for (lane, found) in near.iter().take(8).enumerate() {
            octet.set(lane, found.bounds);
        }
        NearbyBoxes {
            octet: (!near.is_empty()).then_some(octet),
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let sights: usize = self.boxes.iter().map(|b| b.sights.len()).sum();
        size_of_val(self.boxes.as_slice()) + sights * size_of::<[Vec3; 2]>()
    }
}

/// Sights that no box holds yet, and the boxes around them with a coordinate an array: every box that has been grown is
/// held against all of them.
struct OpenSights {
    sights: Vec<[Vec3; 2]>,
    low: [Vec<f32>; 3],
    high: [Vec<f32>; 3],
}

impl OpenSights {
    fn new(sights: &[[Vec3; 2]]) -> Self {
        let along = |of: fn(Vec3, Vec3) -> Vec3, axis: usize| {
            sights.iter().map(|&[p, q]| of(p, q)[axis]).collect()
        };
        Self {
            sights: sights.to_vec(),
            low: [0, 1, 2].map(|axis| along(Vec3::min, axis)),
            high: [0, 1, 2].map(|axis| along(Vec3::max, axis)),
        }
    }

    /// Places of the sights both of whose points lie within `bounds`, ascending.
    fn held_by(&self, bounds: Aabb) -> Vec<usize> {
        let mut is_held = vec![1_u8; self.sights.len()];
        for axis in 0..3 {
            let (min, max) = (bounds.min[axis], bounds.max[axis]);
            let ends = self.low[axis].iter().zip(&self.high[axis]);
            for (is_held, (&low, &high)) in is_held.iter_mut().zip(ends) {
                *is_held &= u8::from(low >= min) & u8::from(high <= max);
            }
        }
        let places = is_held.iter().enumerate();
        places
            .filter_map(|(at, &held)| (held == 1).then_some(at))
            .collect()
    }
}

/// Up to eight empty boxes, the best near some receivers: twice as many prove under 3 % more exchanges in table scenes a
/// to e.
#[derive(Clone, Debug, Default)]
pub struct NearbyBoxes {
    octet: Option<BoxOctet>,
}

impl NearbyBoxes {
    /// True if there is a box at all.
    pub fn any(&self) -> bool {
        self.octet.is_some()
    }

    /// True if one of the boxes holds both, which therefore see each other fully.
    // Lanes of several arrays run in step: an index says so, and is what vectorises.
    #[allow(clippy::needless_range_loop)]
    #[inline]
    pub fn hold(&self, a: Aabb, b: Aabb) -> bool {
        let Some(octet) = &self.octet else {
            return false;
        };
        let joint = a.union(b);
        let mut sticks_out = [0_u32; 8];
        for axis in 0..3 {
            let (low, high) = (joint.min[axis], joint.max[axis]);
            for l in 0..8 {
                sticks_out[l] |=
                    u32::from(octet.min[axis][l] > low) | u32::from(octet.max[axis][l] < high);
            }
        }
        sticks_out.contains(&0)
    }

    /// The boxes that reach to both ends of a pair, if there are any.
    // Lanes of several arrays run in step: an index says so, and is what vectorises.
    #[allow(clippy::needless_range_loop)]
    #[inline]
    pub fn between(&self, a: Aabb, b: Aabb) -> Option<AirBetween<'_>> {
        let octet = self.octet.as_ref()?;
        let mut apart = [0_u32; 8];
        for axis in 0..3 {
            // Both ends begin below the lower of their upper limits, and end above the higher of their lower ones.
            let (low, high) = (a.max[axis].min(b.max[axis]), a.min[axis].max(b.min[axis]));
            for l in 0..8 {
                apart[l] |=
                    u32::from(octet.min[axis][l] > low) | u32::from(octet.max[axis][l] < high);
            }
        }
        let boxes = (0..8).fold(0, |bits, l| bits | u8::from(apart[l] == 0) << l);
        (boxes != 0).then_some(AirBetween { octet, boxes })
    }
}

/// Empty boxes that reach to both ends of a pair, which none of them need hold.
#[derive(Clone, Copy, Debug)]
pub struct AirBetween<'a> {
    octet: &'a BoxOctet,
    /// Bit per box.
    boxes: u8,
}

impl AirBetween<'_> {
    /// Bit per lane: one of the boxes holds the whole segment, which nothing blocks therefore.
    // Lanes of several arrays run in step: an index says so, and is what vectorises.
    #[allow(clippy::needless_range_loop)]
    #[inline(always)]
    pub(super) fn hold8(&self, segments: &SegmentOctet) -> u8 {
        let (mut boxes, mut held) = (self.boxes, 0);
        while boxes != 0 {
            let at = boxes.trailing_zeros() as usize;
            boxes &= boxes - 1;
            let mut sticks_out = [0_u32; 8];
            for axis in 0..3 {
                let (min, max) = (self.octet.min[axis][at], self.octet.max[axis][at]);
                let (p, q) = (&segments.from[axis], &segments.to[axis]);
                for l in 0..8 {
                    sticks_out[l] |= u32::from(p[l] < min)
                        | u32::from(q[l] < min)
                        | u32::from(p[l] > max)
                        | u32::from(q[l] > max);
                }
            }
            for l in 0..8 {
                held |= u8::from(sticks_out[l] == 0) << l;
            }
        }
        held
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::SampleSequence;

    /// Against each point on its own; some points lie on the box's border.
    #[test]
    fn a_box_holds_the_sights_both_of_whose_points_lie_in_it() {
        let sequence = SampleSequence::new(7);
        // On a grid of eighths.
        let point = |index: u32| {
            let [x, y, z, _] = sequence.point(index);
            (Vec3::new(x, y, z) * 8.0).floor() / 8.0
        };
        let sights: Vec<[Vec3; 2]> = (0..1003)
            .map(|i| [point(2 * i), point(2 * i + 1)])
            .collect();
        let open = OpenSights::new(&sights);
        for bounds in (5000..5064).map(|i| Aabb::from_points([point(2 * i), point(2 * i + 1)])) {
            let expected: Vec<usize> = (0..sights.len())
                .filter(|&at| sights[at].iter().all(|&p| bounds.contains(p)))
                .collect();
            assert_eq!(open.held_by(bounds), expected);
        }
        let all = Aabb {
            min: Vec3::ZERO,
            max: Vec3::ONE,
        };
        assert_eq!(open.held_by(all).len(), sights.len());
    }
}
