//! Cluster hierarchical radiosity without links (paper, section 4).

mod config;
mod element;
mod error;
#[cfg(test)]
mod fixture;
mod form_factor;
mod ledger;
mod observer;
mod oracle;
mod ownership;
mod pass;
mod prepared;
mod push_pull;
mod radiosity;
mod sampled_element;
mod solution;
#[allow(clippy::module_inception, reason = "the solve of the solve stage")]
mod solve;
#[cfg(test)]
mod solve_tests;
mod statistics;

pub use config::{ConfigError, Normalise, SolveConfig, Stop, Technique};
pub use error::SolveError;
pub use observer::{Observer, Silent};
pub use prepared::{PreparedScene, StageSeconds};
pub use solution::{PatchPath, Solution, SolvedPatch, split_triangle};
pub use solve::{Solved, solve};
pub use statistics::{PassStatistics, PowerLedger};
