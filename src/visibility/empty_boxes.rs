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
                    held.iter().for_each(|&i| open[i] = false);
                    boxes.push(EmptyBox {
                        bounds: found,
                        sights: held.into_iter().map(|i| sights[i]).collect(),
                    });
                }
            }
            poor = if boxes.len() > before { 0 } else { poor + 1 };
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
        let mut ranked: Vec<(usize, Aabb)> = near
            .map(|found| {
                let ends = |sight: &&[Vec3; 2]| sight.iter().any(|&p| receivers.contains(p));
                (found.sights.iter().filter(ends).count(), found.bounds)
            })
            .collect();
        ranked.sort_by_key(|&(here, _)| std::cmp::Reverse(here));
        let mut octet = BoxOctet::EMPTY;
        for (lane, &(_, bounds)) in ranked.iter().take(8).enumerate() {
            octet.set(lane, bounds);
        }
        NearbyBoxes {
            octet: (!ranked.is_empty()).then_some(octet),
        }
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let sights: usize = self.boxes.iter().map(|b| b.sights.len()).sum();
        size_of_val(self.boxes.as_slice()) + sights * size_of::<[Vec3; 2]>()
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
}
