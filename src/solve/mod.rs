//! Cluster hierarchical radiosity without links (paper, section 4).

mod arrival;
mod claim_check;
mod claims;
mod cluster_light;
#[cfg(test)]
mod cluster_tests;
mod composite_rule;
mod config;
mod deposit;
#[cfg(test)]
mod deposit_tests;
mod element;
mod element_name;
mod element_vector;
#[cfg(test)]
mod element_vector_tests;
mod error;
mod exchange;
mod facet_choice;
mod facet_frame;
mod facet_table;
#[cfg(test)]
mod fixture;
mod flux_tree;
mod form_factor_bound;
mod form_factor_estimate;
mod guarantees;
mod harvest;
mod hidden_parts;
mod irradiance_kernel;
#[cfg(test)]
mod irradiance_tests;
mod knowledge;
mod ledger;
mod observer;
mod oracle;
mod ownership;
mod pair;
mod pass;
mod pass_context;
mod patch_split;
#[cfg(feature = "plant-regressions")]
mod planted;
mod prepared;
mod prover;
mod push_pull;
mod queries;
mod query_record;
mod query_schedule;
#[cfg(test)]
mod query_schedule_tests;
mod radiosity;
mod ray_sampling;
mod receiver_spread;
#[cfg(test)]
mod roulette_tests;
mod sampled_element;
mod sights;
mod snapshot;
#[cfg(test)]
mod snapshot_tests;
mod solution;
#[allow(clippy::module_inception, reason = "the solve of the solve stage")]
mod solve;
#[cfg(test)]
mod solve_tests;
mod solver;
mod statistics;
mod tail;
mod task;
mod triangle_vector;
mod uneven_source;
mod walk;

pub use claim_check::{ClaimCheck, Contradiction};
pub use claims::{Claim, ClaimSample, HiddenBy, ProvedPair};
pub use config::{ConfigError, Normalise, SolveConfig, Stop, Stride, Technique};
pub use element::{Element, Shape};
pub use element_name::ElementName;
pub use error::SolveError;
pub use guarantees::Guarantees;
pub use observer::{Observer, Silent};
#[cfg(feature = "plant-regressions")]
pub use planted::{Regression, plant};
pub use prepared::{PreparedScene, StageSeconds};
pub use snapshot::{Snapshot, SnapshotError};
pub use solution::{PatchPath, Solution, SolvedPatch, split_triangle};
pub use solve::{Solved, resume, solve};
pub use solver::Solver;
pub use statistics::{PassStatistics, PowerLedger};
pub use task::PassOutcome;
