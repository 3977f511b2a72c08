//! Experiments on the engine: the audit of its guarantees, and what they detect.

mod audit;
#[cfg(test)]
mod audit_tests;
mod comparison;
mod continuous_surface;
mod detection;
mod dice;
mod element_points;
mod flat_polygon;
mod polygon_boxes;
mod ray_attack;
mod regression;
mod shaft_replay;
mod surface_chain;
mod table_one;

pub use audit::{AuditConfig, AuditError, AuditReport, Flaw, audit};
pub use comparison::{
    ComparisonConfig, ComparisonRow, ComparisonSummary, Times, compare, summarise,
};
pub use detection::{Detection, DetectionConfig, detection};
pub use regression::{
    Baseline, BaselineCounts, BaselineKey, BaselineRow, SuiteCase, regressions, suite,
};
pub use table_one::{
    PaperRow, PaperShares, TableSettings, paper_row, paper_shares, table_settings,
};
