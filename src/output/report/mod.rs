//! The report: one self-contained HTML page over solves, comparisons and sweeps.

mod charts;
mod comparison_section;
mod html;
mod page;
mod solve_section;
mod sweep_section;

pub use page::{ReportError, write_report};
