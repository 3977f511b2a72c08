//! Experiments on the engine: the audit of its guarantees and what they detect, techniques side by side, speed against
//! accuracy.

mod audit;
mod audit_report;
#[cfg(test)]
mod audit_tests;
mod baseline_key;
mod claimed_occluder;
mod comparison;
mod continuous_surface;
mod detection;
mod dice;
mod element_points;
mod error_budget;
mod flat_polygon;
mod instruction_counts;
mod pareto;
mod parts_cover;
mod polygon_boxes;
mod processor_time;
mod ray_attack;
mod regression;
mod shaft_replay;
mod surface_chain;
mod sweep;
mod sweep_settings;
mod table_one;

pub use audit::{AuditConfig, AuditError, audit};
pub use audit_report::{AuditReport, ClaimRecord, ElementRecord, Flaw};
pub use baseline_key::{BaselineKey, COMPILER};
pub use comparison::{
    ComparisonConfig, ComparisonRow, ComparisonSummary, Times, compare, summarise,
};
pub use detection::{Detection, DetectionConfig, detection};
pub use error_budget::{Approximation, BudgetLine, BudgetedError, ErrorBudget, error_budget};
pub use instruction_counts::{InstructionCounts, dearer};
pub use pareto::pareto_front;
pub use processor_time::processor_seconds;
pub use regression::{Baseline, BaselineCounts, BaselineRow, SuiteCase, regressions, suite};
pub use sweep::{
    Sweep, SweepError, SweepOutcome, SweepRow, SweepTiming, error_at_cost, sweep_fronts,
};
pub use sweep_settings::{MAX_POINTS, SweepLists, SweepSettings, TooManyPoints, stride_name};
pub use table_one::{
    PaperRow, PaperShares, TableSettings, paper_row, paper_shares, table_settings,
};
