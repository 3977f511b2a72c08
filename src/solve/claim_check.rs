//! The debug mode of a solve: rays of claimed exchanges are cast all the same, and every one that
//! disagrees with its claim is settled in exact arithmetic (truth: "Guarantees").

use super::claims::Claim;
use crate::visibility::exact::{SegmentStanding, judge_segment};
use crate::visibility::{SampleOctet, SceneTree, SegmentTest};
use glam::Vec3;

/// What the rays of claimed exchanges said.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ClaimCheck {
    /// Rays cast.
    pub rays: u64,
    /// Those on which Embree disagrees with the claim.
    pub disagreements: u64,
    /// Those that stand in exact arithmetic: none, or a guarantee is wrong.
    pub contradictions: Vec<Contradiction>,
}

/// A segment that proves a claim false.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contradiction {
    /// The claim.
    pub claim: Claim,
    /// The segment's ends, normalised.
    pub segment: [Vec3; 2],
    /// What is sure of it.
    pub standing: SegmentStanding,
}

impl ClaimCheck {
    /// Adds what another part found.
    pub fn merge(&mut self, other: Self) {
        self.rays += other.rays;
        self.disagreements += other.disagreements;
        self.contradictions.extend(other.contradictions);
    }

    /// Judges the segments of one exchange under `claim`.
    pub fn judge(&mut self, scene: &SceneTree, claim: Claim, segments: &[(Vec3, Vec3, bool)]) {
        let claimed_blocked = claim.occluder.is_some();
        self.rays += segments.len() as u64;
        for &(from, to, blocked) in segments {
            if blocked == claimed_blocked {
                continue;
            }
            self.disagreements += 1;
            let standing = judge_segment(scene, from.as_dvec3(), to.as_dvec3());
            let stands = match standing {
                SegmentStanding::Blocked(_) => !claimed_blocked,
                SegmentStanding::Clear => claimed_blocked,
                SegmentStanding::Between => false,
            };
            if stands {
                self.contradictions.push(Contradiction {
                    claim,
                    segment: [from, to],
                    standing,
                });
            }
        }
    }
}

/// Passes segments on to another test and remembers its answers.
pub struct Recording<'a, T> {
    /// Who answers.
    pub test: T,
    /// Start, end, and whether it was blocked.
    pub segments: &'a mut Vec<(Vec3, Vec3, bool)>,
}

impl<T: SegmentTest> SegmentTest for Recording<'_, T> {
    fn blocked8(&mut self, octet: &SampleOctet, active: u8) -> u8 {
        let blocked = self.test.blocked8(octet, active);
        for lane in (0..8).filter(|lane| active & (1 << lane) != 0) {
            let answer = blocked & (1 << lane) != 0;
            self.segments
                .push((octet.from(lane), octet.to(lane), answer));
        }
        blocked
    }
}
