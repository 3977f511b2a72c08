//! Why a solve ended without a result.

use super::config::ConfigError;

/// Past validation a solve can only be interrupted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SolveError {
    /// A setting outside its range.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The observer asked to stop.
    #[error("interrupted in pass {pass} after {completed} completed passes; nothing was written")]
    Interrupted {
        /// The pass that was under way.
        pass: u32,
        /// Passes completed before it.
        completed: u32,
    },
}
