//! Presets of the solver: how good, and so how dear.
//!
//! Chosen from the grid of epsilon, rays and convergence on cornell, d and f, not by taste (`bench/runs/`, sweep/linear): `draft`
//! stands on the Pareto front of error against processor time in all three, `high` on it or next to it.

use crate::solve::{SolveConfig, Stop};
use clap::ValueEnum;

/// `--quality`
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Quality {
    /// A first look.
    Draft,
    /// The defaults.
    #[default]
    Normal,
    /// For publication.
    High,
}

impl Quality {
    /// All of them, the fastest first.
    pub const ALL: [Self; 3] = [Self::Draft, Self::Normal, Self::High];

    /// The name used on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Draft => "draft",
            Self::Normal => "normal",
            Self::High => "high",
        }
    }

    /// The settings that it stands for.
    pub fn config(self) -> SolveConfig {
        let normal = SolveConfig::default();
        match self {
            Self::Draft => SolveConfig {
                epsilon: 1.0e-4,
                stop: Stop::Converged(1.0e-2),
                ..normal
            },
            Self::Normal => normal,
            Self::High => SolveConfig {
                epsilon: 1.0e-6,
                stop: Stop::Converged(1.0e-4),
                ..normal
            },
        }
    }
}
