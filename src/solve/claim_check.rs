//! The debug mode of a solve: rays of claimed exchanges, and those that were tested natively, are cast through Embree all the
//! same, and every one that disagrees is settled in exact arithmetic (truth: "Guarantees"; design, section 7, point 4).

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
    /// Rays that were tested natively, and then cast.
    pub native_rays: u64,
    /// Those on which Embree disagrees with the native answer.
    pub native_disagreements: u64,
    /// Those of them that the native test has wrong, as segments with what is sure of them: none, or the test or the list is
    /// wrong.
    pub native_errors: Vec<([Vec3; 2], SegmentStanding)>,
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
        self.native_rays += other.native_rays;
        self.native_disagreements += other.native_disagreements;
        self.native_errors.extend(other.native_errors);
    }

    /// True if every disagreement was settled in favour of the engine.
    pub fn holds(&self) -> bool {
        self.contradictions.is_empty() && self.native_errors.is_empty()
    }

    /// Judges the segments of one exchange that were tested natively, where Embree says otherwise. `cast` holds the same
    /// segments in the same order; `answered` of them were not left to Embree in the first place.
    pub fn judge_native(
        &mut self,
        scene: &SceneTree,
        answered: u32,
        native: &[(Vec3, Vec3, bool)],
        cast: &[(Vec3, Vec3, bool)],
    ) {
        let ends = |&(from, to, _): &(Vec3, Vec3, bool)| (from, to);
        assert!(
            native.iter().map(ends).eq(cast.iter().map(ends)),
            "the same samples are tested twice"
        );
        self.native_rays += u64::from(answered);
        for (&(from, to, blocked), _) in native
            .iter()
            .zip(cast)
            .filter(|((.., native), (.., cast))| native != cast)
        {
            self.native_disagreements += 1;
            let standing = judge_segment(scene, from.as_dvec3(), to.as_dvec3());
            if refutes(standing, blocked) {
                self.native_errors.push(([from, to], standing));
            }
        }
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
            if refutes(standing, claimed_blocked) {
                self.contradictions.push(Contradiction {
                    claim,
                    segment: [from, to],
                    standing,
                });
            }
        }
    }
}

/// True if what is sure of a segment is the opposite of what was said of it.
fn refutes(standing: SegmentStanding, said_blocked: bool) -> bool {
    match standing {
        SegmentStanding::Blocked(_) => !said_blocked,
        SegmentStanding::Clear => said_blocked,
        SegmentStanding::Between => false,
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
