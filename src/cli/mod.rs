//! Arguments as typed, then as needed, then the work.

mod args;
mod audit_command;
mod bench_command;
mod clusters_command;
mod compare_command;
mod error;
mod error_command;
mod generate_command;
mod interrupt;
mod occluders_command;
mod progress;
mod quality;
mod reference_args;
mod reference_command;
mod reference_progress;
mod render;
mod run;
mod scene_source;
mod session;
mod solve_args;
mod solve_command;
mod summary;
mod sweep_args;
mod sweep_command;
mod sweep_progress;
mod typed_number;
mod view_command;

pub use error::CliError;
pub use run::run;
