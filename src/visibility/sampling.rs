//! Sampled visibility: rays between points of two elements, cast by Embree (paper, section 4; the
//! one road for whatever is not proved).
//!
//! The visibility of an exchange is the mean of its samples' visibility weighted with the kernel
//! cos cos / r^2, since it multiplies an unoccluded form factor; sources choose their points by the light that
//! they send, since light and visibility go together. A sample whose kernel is not positive carries no light
//! and casts no ray.
//!
//! No ray excludes a polygon by identity. It is trimmed where its depth below the plane of the
//! sample at either end exceeds tau: t = tau / cos on both sides.

// Lanes of several arrays run in step: an index says so, and is what vectorises.
#![allow(clippy::needless_range_loop)]

use super::blockers::BlockerList;
use super::near_segments::SegmentOctet;
use super::part_visibility::{PartVisibility, PartWeights};
use super::sample_points::Surface;
use super::trimmed::trim;
use crate::embree::{CommittedScene, RayPacket8};
use crate::math::SampleSequence;
use glam::Vec3;
use pulp::{Arch, Simd, WithSimd};

/// Eight sample segments as whoever tests them needs them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleOctet {
    /// The segments from point to point, untrimmed.
    pub segments: SegmentOctet,
    /// Start of the trimmed segment, as a fraction of the whole.
    pub near: [f32; 8],
    /// Its end, likewise.
    pub far: [f32; 8],
}

impl SampleOctet {
    /// Start of a lane's segment.
    pub fn from(&self, lane: usize) -> Vec3 {
        Vec3::from_array(self.segments.from.map(|axis| axis[lane]))
    }

    /// End of a lane's segment.
    pub fn to(&self, lane: usize) -> Vec3 {
        Vec3::from_array(self.segments.to.map(|axis| axis[lane]))
    }
}

/// Whoever says which sample segments are blocked.
pub trait SegmentTest {
    /// Bit per lane of `active`: the segment is blocked.
    fn blocked8(&mut self, octet: &SampleOctet, active: u8) -> u8;
}

/// Embree's answer.
impl SegmentTest for &CommittedScene {
    #[inline(always)]
    fn blocked8(&mut self, octet: &SampleOctet, active: u8) -> u8 {
        let segments = &octet.segments;
        let mut packet = RayPacket8 {
            tnear: octet.near,
            tfar: octet.far,
            ..RayPacket8::default()
        };
        let axes = [
            (&mut packet.org_x, &mut packet.dir_x),
            (&mut packet.org_y, &mut packet.dir_y),
            (&mut packet.org_z, &mut packet.dir_z),
        ];
        for (axis, (origin, direction)) in axes.into_iter().enumerate() {
            for lane in 0..8 {
                origin[lane] = segments.from[axis][lane];
                direction[lane] = segments.to[axis][lane] - segments.from[axis][lane];
            }
        }
        if active.count_ones() <= FEW_RAYS {
            self.occluded8_incoherent(&mut packet, active)
        } else {
            self.occluded8(&mut packet, active)
        }
    }
}

/// Rays of a packet up to which Embree answers them faster one by one: in half to nine tenths of the time (`bench/runs/`,
/// embree_packets).
const FEW_RAYS: u32 = 3;

/// A short list's answer, natively.
impl SegmentTest for &BlockerList {
    fn blocked8(&mut self, octet: &SampleOctet, active: u8) -> u8 {
        BlockerList::blocked8(self, &octet.segments) & active
    }
}

/// Every segment is clear: for pairs that are proved visible, where all that is asked is whether any
/// sample carries light.
#[derive(Clone, Copy, Debug)]
pub struct AllClear;

impl SegmentTest for AllClear {
    fn blocked8(&mut self, _: &SampleOctet, _: u8) -> u8 {
        0
    }
}

/// What the samples of an exchange said.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SampledVisibility {
    /// What share of the unoccluded light arrives: 1 when every sample is clear, 0 when every one
    /// is blocked or none carries light.
    pub visibility: PartVisibility,
    /// Rays cast.
    pub rays: u32,
    /// Rays blocked.
    pub rays_blocked: u32,
    /// True when every sample that carries light was blocked (or none carries any).
    pub all_blocked: bool,
    /// True when every sample that carries light was clear.
    pub all_clear: bool,
}

/// How often an exchange whose samples all have a zero kernel is sampled afresh: elements that
/// straddle each other's planes; after this many tries the light is below 1 in 4 x rays samples.
pub(super) const TRIES: u32 = 4;

/// Samples the visibility between two elements with `rays` rays; `test` says which are blocked.
///
/// `key` names the exchange: (receiver, source, pass, seed). `tau` is the depth below a surface
/// within which nothing blocks. `arch` is the instruction set to run with; it does not change the answer.
pub fn sample_visibility(
    arch: Arch,
    test: impl SegmentTest,
    source: &impl Surface,
    receiver: &impl Surface,
    rays: u32,
    key: u64,
    tau: f32,
) -> SampledVisibility {
    arch.dispatch(Sampling {
        test,
        source,
        receiver,
        rays,
        key,
        tau,
    })
}

/// One exchange being sampled.
struct Sampling<'a, T, S, R> {
    test: T,
    source: &'a S,
    receiver: &'a R,
    rays: u32,
    key: u64,
    tau: f32,
}

impl<T: SegmentTest, S: Surface, R: Surface> WithSimd for Sampling<'_, T, S, R> {
    type Output = SampledVisibility;

    #[inline(always)]
    fn with_simd<I: Simd>(mut self, _: I) -> SampledVisibility {
        let sequence = SampleSequence::new(self.key);
        let mut result = SampledVisibility::default();
        let mut total_weight = 0.0f32;
        let mut clear_weight = 0.0f32;
        let mut swallowed = false;
        let mut parts = PartWeights::default();
        for attempt in 0..TRIES {
            let mut index = attempt * self.rays;
            let end = index + self.rays;
            while index < end {
                let lanes = (end - index).min(8);
                let [u, v, s, t] = sequence.points(index);
                let (from, to) = (
                    self.source.points(&u, &v, lanes),
                    self.receiver.points(&s, &t, lanes),
                );
                let mut trimmed = trim(&from, &to, self.tau, lanes);
                trimmed.forget(from.absent | to.absent);
                for weight in trimmed.weight {
                    total_weight += weight;
                }
                let unhidden = trimmed.weight;
                swallowed |= trimmed.forget(from.swallowed | to.swallowed);
                let octet = SampleOctet {
                    segments: SegmentOctet {
                        from: from.position,
                        to: to.position,
                    },
                    near: trimmed.near,
                    far: trimmed.far,
                };
                let blocked = match trimmed.active {
                    0 => 0,
                    active => self.test.blocked8(&octet, active),
                };
                result.rays += trimmed.active.count_ones();
                result.rays_blocked += blocked.count_ones();
                for l in 0..8 {
                    if blocked & (1 << l) == 0 {
                        clear_weight += trimmed.weight[l];
                    }
                }
                // One packet that agrees needs no parts.
                if self.rays > 8 || (clear_weight > 0.0 && (blocked != 0 || swallowed)) {
                    parts.add(
                        &self.receiver.parts(&s, &t),
                        &unhidden,
                        &trimmed.weight,
                        blocked,
                    );
                }
                index += lanes;
            }
            if total_weight > 0.0 {
                break;
            }
        }
        result.all_blocked = clear_weight == 0.0;
        result.all_clear = total_weight > 0.0 && result.rays_blocked == 0 && !swallowed;
        result.visibility = if clear_weight == 0.0 {
            // Clear or not: all that can be seen of the source is dark.
            PartVisibility::even(0.0)
        } else if result.all_clear {
            PartVisibility::CLEAR
        } else {
            parts.visibility(clear_weight / total_weight)
        };
        result
    }
}
