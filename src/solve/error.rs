//! Why a solve ended without a result.

use super::config::ConfigError;
use super::snapshot::SnapshotError;

/// Past validation a solve can only be interrupted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// A setting outside its range.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The state to go on from is of another solve.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
    /// The observer asked to stop.
    #[error("interrupted in pass {pass} after {completed} completed passes; nothing was written")]
    Interrupted {
        /// The pass that was under way.
        pass: u32,
        /// Passes completed before it.
        completed: u32,
    },
}
