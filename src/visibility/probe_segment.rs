//! A segment between two points of a pair, which finds the occluders that come into question.

use super::wide_tree::WideNode;
use glam::Vec3;

/// A segment between two points of a pair.
pub(super) struct ProbeSegment {
    pub origin: Vec3,
    pub along: Vec3,
}

impl ProbeSegment {
    #[inline(always)]
    pub fn new(from: Vec3, to: Vec3) -> Self {
        Self {
            origin: from,
            along: to - from,
        }
    }

    /// One over the components of its direction; large but finite where one vanishes, so that no
    /// product is NaN.
    #[inline(always)]
    pub fn inverse(&self) -> Vec3 {
        let inverse = |d: f32| {
            if d.abs() > 1.0e-12 {
                1.0 / d
            } else {
                1.0e12_f32.copysign(d)
            }
        };
        Vec3::new(
            inverse(self.along.x),
            inverse(self.along.y),
            inverse(self.along.z),
        )
    }

    /// Bit per lane: the segment meets the box.
    #[inline(always)]
    pub fn meets_boxes(&self, inverse: Vec3, node: &WideNode) -> u32 {
        let mut enter = [0.0_f32; 8];
        let mut leave = [1.0_f32; 8];
        for axis in 0..3 {
            let (o, inverse) = (self.origin[axis], inverse[axis]);
            let (near, far) = if inverse >= 0.0 {
                (&node.boxes.min[axis], &node.boxes.max[axis])
            } else {
                (&node.boxes.max[axis], &node.boxes.min[axis])
            };
            for l in 0..8 {
                let (t0, t1) = ((near[l] - o) * inverse, (far[l] - o) * inverse);
                enter[l] = if t0 > enter[l] { t0 } else { enter[l] };
                leave[l] = if t1 < leave[l] { t1 } else { leave[l] };
            }
        }
        let mut bits = [0_u32; 8];
        for l in 0..8 {
            bits[l] = if enter[l] <= leave[l] { 1 << l } else { 0 };
        }
        bits.iter().fold(0, |mask, bit| mask | bit)
    }
}
