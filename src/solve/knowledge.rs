//! What is known of a pair by proofs, and what pairs below it inherit (paper, section 5.3).

use super::claims::HiddenBy;
use crate::visibility::Verdict;

/// What is known of a pair by the pairs above it.
#[derive(Clone, Copy, Debug)]
pub struct Knowledge {
    /// Proved for a pair above, or for this one.
    pub verdict: Verdict,
    /// By a box of air, which is no query.
    pub(super) by_air: bool,
    /// How many splits lie above.
    pub(super) level: u32,
    /// Which of the task's lists holds what may block.
    pub(super) list: u32,
    /// Packets of rays that a proof could have saved below the pair that was last asked about.
    pub(super) asked_at: f32,
}

impl Knowledge {
    /// The same, but visible since a box of air holds the pair.
    #[must_use]
    pub fn in_air(self) -> Self {
        Self {
            verdict: Verdict::Visible,
            by_air: true,
            ..self
        }
    }

    /// Of the topmost pair.
    pub const NOTHING: Self = Self {
        verdict: Verdict::Unknown,
        by_air: false,
        level: 0,
        list: 0,
        asked_at: f32::INFINITY,
    };
}

/// What a query found.
#[derive(Clone, Copy, Debug)]
pub struct Proof {
    /// What is known now.
    pub knowledge: Knowledge,
    /// What hides the pair.
    pub hiding: Hiding,
}

/// What hides a pair.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hiding {
    /// What was proved to hide it.
    pub by: Option<HiddenBy>,
    /// Something crosses the segment between the centres, so several things may hide what none hides alone.
    pub may_hide: bool,
}

impl Proof {
    /// Nothing new.
    pub fn none(knowledge: Knowledge) -> Self {
        Self {
            knowledge,
            hiding: Hiding::default(),
        }
    }
}
