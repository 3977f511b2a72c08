//! Empty boxes: axis-aligned boxes of air into which nothing reaches. Whatever lies in one sees all else that does.
//!
//! A box is convex, so every segment between two of its points stays inside. A pair whose joint box lies in an empty
//! one is fully visible, and seeing that takes some twenty comparisons where a shaft takes thousands of instructions.
//! What proves a box empty ([`super::box_growth`]) holds for all its points with the margins that pairs have, so for
//! every pair inside.

use super::box_growth::BoxGrower;
use super::scene_tree::SceneTree;
use super::wide_tree::BoxOctet;
use crate::math::Aabb;
use glam::Vec3;
use rayon::prelude::*;

/// Seeds grown at a time, whatever the number of threads, since each sees only the boxes of the batches before.
const BATCH: usize = 32;

/// Sights that a box must be the first to hold. Table scenes d, e and f: a quarter more boxes from 2 find 3 % more
/// pairs, and eight of the best are all that is looked at.
const LEAST_GAIN: usize = 4;

/// Batches in a row that may bring less than one box each before the search ends: in large scenes few sights fall
/// on each room.
const POOR_BATCHES: u32 = 4;

/// Empty boxes of a scene, those that hold the most sights first.
#[derive(Clone, Debug, Default)]
pub struct EmptyBoxes {
    boxes: Vec<Aabb>,
}

impl EmptyBoxes {
    /// Boxes that hold many of `sights`, which are pairs of points that see each other. Each sight that no box holds
    /// yet seeds one, if the box of its two points is empty.
    pub fn build(scene: &SceneTree, sights: &[[Vec3; 2]]) -> Self {
        let grower = BoxGrower::new(scene);
        let slack = 4.0 * scene.tolerance().tau;
        let mut boxes: Vec<(usize, Aabb)> = Vec::new();
        let mut open = vec![true; sights.len()];
        let mut next = 0;
        let mut poor = 0;
        while next < sights.len() && poor < POOR_BATCHES {
            let mut seeds = Vec::with_capacity(BATCH);
            while next < sights.len() && seeds.len() < BATCH {
                if open[next] {
                    seeds.push(Aabb::from_points(sights[next]));
                }
                next += 1;
            }
            let grown: Vec<Option<Aabb>> = seeds
                .par_iter()
                .map_init(|| grower.clone(), |grower, &seed| grower.grow(seed))
                .collect();
            let before = boxes.len();
            for found in grown.into_iter().flatten() {
                let loose = Aabb {
                    min: found.min - slack,
                    max: found.max + slack,
                };
                let held: Vec<usize> = (0..sights.len())
                    .filter(|&i| open[i] && sights[i].iter().all(|&p| loose.contains(p)))
                    .collect();
                if held.len() >= LEAST_GAIN {
                    boxes.push((held.len(), found));
                    held.into_iter().for_each(|i| open[i] = false);
                }
            }
            poor = if boxes.len() > before { 0 } else { poor + 1 };
        }
        boxes.sort_by_key(|&(gain, _)| std::cmp::Reverse(gain));
        Self {
            boxes: boxes.into_iter().map(|(_, b)| b).collect(),
        }
    }

    /// These boxes, empty or not.
    #[cfg(test)]
    pub fn planted(boxes: Vec<Aabb>) -> Self {
        Self { boxes }
    }

    /// The boxes, those that hold the most sights first.
    pub fn boxes(&self) -> &[Aabb] {
        &self.boxes
    }

    /// The best of the boxes that reach `receivers`.
    pub fn near(&self, receivers: Aabb) -> NearbyBoxes {
        let mut octet = BoxOctet::EMPTY;
        let near = self
            .boxes
            .iter()
            .filter(|b| b.distance(receivers) <= 0.0)
            .take(8);
        let mut count = 0;
        for (lane, &found) in near.enumerate() {
            octet.set(lane, found);
            count = lane + 1;
        }
        NearbyBoxes {
            octet: (count > 0).then_some(octet),
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        size_of_val(self.boxes.as_slice())
    }
}

/// Up to eight empty boxes, the best near some receivers: more find no more (table scenes d, e and f: 16 and 32
/// boxes prove under 1 % more pairs than 8).
#[derive(Clone, Debug, Default)]
pub struct NearbyBoxes {
    octet: Option<BoxOctet>,
}

impl NearbyBoxes {
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
}
