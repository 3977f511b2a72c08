//! Sample segments cut back at both ends by the depth below a surface within which nothing counts, and the light that
//! they carry.

// Lanes of several arrays run in step: an index says so, and is what vectorises.
#![allow(clippy::needless_range_loop)]

use super::sample_points::PointOctet;

/// Least cosine at either end for a sample to carry light. A flatter ray is trimmed by more than a thousand tau, far
/// enough to slip under a wall's edge; what it would carry is a millionth of a hemisphere.
pub const LEAST_COSINE: f32 = 1.0e-3;

/// Eight sample segments, trimmed at both ends.
pub(super) struct Trimmed {
    pub(super) near: [f32; 8],
    pub(super) far: [f32; 8],
    /// The kernel cos cos / r^2 (up to a factor), 0 where no light is carried.
    pub(super) weight: [f32; 8],
    /// Lanes with something left to test.
    pub(super) active: u8,
}

impl Trimmed {
    /// Takes the light of `lanes` away; true where they carried some.
    #[inline(always)]
    pub(super) fn forget(&mut self, lanes: u8) -> bool {
        let mut carried = false;
        if lanes != 0 {
            for l in 0..8 {
                if lanes & (1 << l) != 0 {
                    carried |= self.weight[l] > 0.0;
                    self.weight[l] = 0.0;
                }
            }
            self.active &= !lanes;
        }
        carried
    }
}

/// The rays from `from` (parameter 0) to `to` (parameter 1) in the first `lanes` lanes.
#[inline(always)]
pub(super) fn trim(from: &PointOctet, to: &PointOctet, tau: f32, lanes: u32) -> Trimmed {
    let mut trimmed = Trimmed {
        near: [0.0; 8],
        far: [-1.0; 8],
        weight: [0.0; 8],
        active: 0,
    };
    let (mut depth_from, mut depth_to, mut r2) = ([0.0f32; 8], [0.0f32; 8], [0.0f32; 8]);
    for axis in 0..3 {
        for l in 0..8 {
            let along = to.position[axis][l] - from.position[axis][l];
            // Depths of each end over the other's plane: distance times cosine.
            depth_from[l] += from.normal[axis][l] * along;
            depth_to[l] -= to.normal[axis][l] * along;
            r2[l] += along * along;
        }
    }
    let mut counts = [0u32; 8];
    for l in 0..8 {
        let least = LEAST_COSINE * r2[l].sqrt();
        let carries = (depth_from[l] > least) & (depth_to[l] > least) & ((l as u32) < lanes);
        // Both depths are positive where light is carried, so r2 is.
        let weight = depth_from[l] * depth_to[l] / (r2[l] * r2[l]);
        let carries = carries & (weight > 0.0) & (weight < f32::INFINITY);
        let (near, far) = (tau / depth_from[l], 1.0 - tau / depth_to[l]);
        trimmed.weight[l] = if carries { weight } else { 0.0 };
        trimmed.near[l] = if carries { near } else { 0.0 };
        trimmed.far[l] = if carries { far } else { -1.0 };
        counts[l] = u32::from(carries & (near < far)) << l;
    }
    trimmed.active = counts.iter().sum::<u32>() as u8;
    trimmed
}
