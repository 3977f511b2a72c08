//! What is asked of a pair and when, and what was found instead (design, section 7, point 2).

use crate::visibility::SampledVisibility;

/// Which guarantees to ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Queries {
    /// None.
    None,
    /// Full occlusion alone.
    Occlusion,
    /// Full visibility alone.
    Visibility,
    /// Not a proof but a shorter list of what may block.
    Shorten,
    /// Occlusion, then visibility.
    Both,
}

impl Queries {
    /// True where full occlusion is asked.
    pub fn occlusion(self) -> bool {
        matches!(self, Self::Occlusion | Self::Both)
    }

    /// True where the shaft is walked.
    pub fn visibility(self) -> bool {
        matches!(self, Self::Visibility | Self::Shorten | Self::Both)
    }
}

/// When a query is asked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Occasion {
    /// Before a pair is split, with so many packets of eight rays likely to be cast below it.
    Split(f32),
    /// Before an exchange of so many packets.
    Exchange(f32),
}

impl Occasion {
    /// Packets that a proof is likely to save.
    pub fn packets(self) -> f32 {
        match self {
            Self::Split(packets) | Self::Exchange(packets) => packets,
        }
    }
}

/// What an exchange was found to be, by its rays or by proof.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// All blocked.
    Blocked,
    /// All clear.
    Clear,
    /// Some of each.
    Mixed,
    /// None carries light.
    Dark,
}

impl Evidence {
    /// What samples say.
    pub fn of(sampled: &SampledVisibility) -> Self {
        match sampled.rays {
            0 => Self::Dark,
            n if sampled.rays_blocked == n => Self::Blocked,
            _ if sampled.rays_blocked == 0 => Self::Clear,
            _ => Self::Mixed,
        }
    }
}
