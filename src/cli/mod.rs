//! Arguments as typed, then as needed, then the work.

mod args;
mod error;
mod generate_command;
mod interrupt;
mod progress;
mod run;
mod scene_source;
mod solve_args;
mod solve_command;
mod summary;

pub use error::CliError;
pub use run::run;
