//! Cluster hierarchical radiosity without links (paper, section 4).

mod solution;
mod statistics;

pub use solution::{PatchPath, Solution, SolvedPatch};
pub use statistics::{PassStatistics, PowerLedger};
