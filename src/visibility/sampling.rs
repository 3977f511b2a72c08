//! Sampled visibility: rays between points of two elements, cast by Embree (paper, section 4; the
//! one road for whatever is not proved).
//!
//! The visibility of an exchange is the mean of its samples' visibility weighted with the kernel
//! cos cos / r^2, since it multiplies an unoccluded form factor, times the light at the source's
//! point over the source's mean, since light and visibility go together: so it can exceed 1 where the bright
//! part is the visible one. A sample whose kernel is not positive carries no light and casts no ray.
//!
//! No ray excludes a polygon by identity. It is trimmed where its depth below the plane of the
//! sample at either end exceeds tau: t = tau / cos on both sides.

use super::blockers::{BlockerList, SegmentOctet};
use crate::embree::{CommittedScene, RayPacket8};
use crate::math::SampleSequence;
use glam::Vec3;

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
    const EMPTY: Self = Self {
        segments: SegmentOctet {
            from: [[0.0; 8]; 3],
            to: [[0.0; 8]; 3],
        },
        near: [0.0; 8],
        far: [-1.0; 8],
    };

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
        self.occluded8(&mut packet, active)
    }
}

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

/// A point of an element with the unit normal of the facet that it lies on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Normalised position.
    pub position: Vec3,
    /// Unit normal of its facet, on the facet's side.
    pub normal: Vec3,
    /// Light that it sends, over its element's mean; 1 for receivers.
    pub light: f32,
}

/// An element that can be sampled uniformly by area.
pub trait Surface {
    /// The point at `(u, v)` in [0,1)^2; uniform in gives uniform out.
    fn point(&self, u: f32, v: f32) -> SurfacePoint;
}

/// What the samples of an exchange said.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SampledVisibility {
    /// What share of the unoccluded light arrives: 1 when every sample is clear, 0 when every one
    /// is blocked or none carries light; else it may exceed 1.
    pub visibility: f32,
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
const RETRIES: u32 = 4;

/// Least cosine at either end for a sample to carry light. A flatter ray is trimmed by more than a thousand tau, far
/// enough to slip under a wall's edge; what it would carry is a millionth of a hemisphere.
pub const LEAST_COSINE: f32 = 1.0e-3;

/// Samples the visibility between two elements with `rays` rays; `test` says which are blocked.
///
/// `key` names the exchange: (receiver, source, pass, seed). `tau` is the depth below a surface
/// within which nothing blocks.
pub fn sample_visibility(
    mut test: impl SegmentTest,
    source: &impl Surface,
    receiver: &impl Surface,
    rays: u32,
    key: u64,
    tau: f32,
) -> SampledVisibility {
    let sequence = SampleSequence::new(key);
    let mut result = SampledVisibility::default();
    let mut total_weight = 0.0f32;
    let mut clear_weight = 0.0f32;
    for attempt in 0..RETRIES {
        let mut index = attempt * rays;
        let end = index + rays;
        while index < end {
            let lanes = (end - index).min(8);
            let mut octet = SampleOctet::EMPTY;
            let mut active = 0u8;
            let mut weights = [0.0f32; 8];
            for (lane, weight) in weights.iter_mut().enumerate().take(lanes as usize) {
                let [u, v, s, t] = sequence.point(index + lane as u32);
                let from = source.point(u, v);
                let to = receiver.point(s, t);
                let Some(segment) = trim(from, to, tau) else {
                    continue;
                };
                *weight = segment.weight * from.light;
                total_weight += segment.weight;
                if segment.near < segment.far {
                    for axis in 0..3 {
                        octet.segments.from[axis][lane] = from.position[axis];
                        octet.segments.to[axis][lane] = to.position[axis];
                    }
                    octet.near[lane] = segment.near;
                    octet.far[lane] = segment.far;
                    active |= 1 << lane;
                }
            }
            let blocked = if active == 0 {
                0
            } else {
                test.blocked8(&octet, active)
            };
            result.rays += active.count_ones();
            result.rays_blocked += blocked.count_ones();
            for (lane, weight) in weights.iter().enumerate() {
                if blocked & (1 << lane) == 0 {
                    clear_weight += weight;
                }
            }
            index += lanes;
        }
        if total_weight > 0.0 {
            break;
        }
    }
    result.all_blocked = clear_weight == 0.0;
    result.all_clear = total_weight > 0.0 && result.rays_blocked == 0;
    result.visibility = if result.all_clear {
        1.0
    } else if total_weight > 0.0 {
        clear_weight / total_weight
    } else {
        0.0
    };
    result
}

/// A sample segment, trimmed at both ends.
struct Segment {
    near: f32,
    far: f32,
    weight: f32,
}

/// The ray from `from` (parameter 0) to `to` (parameter 1), or `None` where it carries no light.
fn trim(from: SurfacePoint, to: SurfacePoint, tau: f32) -> Option<Segment> {
    let direction = to.position - from.position;
    // Depths of each end over the other's plane: distance times cosine.
    let depth_from = from.normal.dot(direction);
    let depth_to = -to.normal.dot(direction);
    let r2 = direction.length_squared();
    let least = LEAST_COSINE * r2.sqrt();
    if depth_from <= least || depth_to <= least {
        return None;
    }
    let weight = depth_from * depth_to / (r2 * r2);
    (weight > 0.0 && weight.is_finite()).then_some(Segment {
        near: tau / depth_from,
        far: 1.0 - tau / depth_to,
        weight,
    })
}
