//! Everything that can go wrong on the command line, and its exit code.

use super::logs::{self, BadFilter};
use crate::embree::EmbreeError;
use crate::experiment::{AuditError, SweepError, TooManyPoints};
use crate::job::TomlError;
use crate::output::{CameraError, CheckpointError, ComparisonError, OutputError, ReportError};
use crate::reference::{NothingToCompare, ReferenceError};
use crate::scene::LoadError;
use crate::scene::generate::UnknownScene;
use crate::solve::{ConfigError, SolveError};
use std::path::PathBuf;

/// An error of a command.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CliError {
    /// The arguments are wrong, or help was asked for.
    #[error(transparent)]
    Arguments(#[from] clap::Error),
    /// The scene is invalid.
    #[error(transparent)]
    Load(#[from] LoadError),
    /// No such built-in scene.
    #[error(transparent)]
    UnknownScene(#[from] UnknownScene),
    /// A setting is out of range.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The solve ended without a result.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The solve was stopped and can go on from a checkpoint.
    #[error(
        "interrupted in pass {pass}; {} holds the state after pass {completed}: the same command with --resume goes on from there",
        checkpoint.display()
    )]
    Suspended {
        /// The pass that was under way.
        pass: u32,
        /// Passes completed before it.
        completed: u32,
        /// The file.
        checkpoint: PathBuf,
    },
    /// The batch was stopped.
    #[error("{0}")]
    Stopped(String),
    /// A job list or a configuration file cannot be used.
    #[error(transparent)]
    Toml(#[from] TomlError),
    /// The filter of the logs cannot be used.
    #[error(transparent)]
    Filter(#[from] BadFilter),
    /// The checkpoint cannot be used.
    #[error(transparent)]
    Checkpoint(#[from] CheckpointError),
    /// Embree failed.
    #[error(transparent)]
    Embree(#[from] EmbreeError),
    /// A file could not be written or read.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// The solution to work on is missing or is none.
    #[error(transparent)]
    Solution(OutputError),
    /// The measurement ended without a result.
    #[error(transparent)]
    Reference(#[from] ReferenceError),
    /// The reference and the solution do not go together.
    #[error(transparent)]
    Comparison(#[from] ComparisonError),
    /// The reference has nothing to compare with.
    #[error(transparent)]
    NothingToCompare(#[from] NothingToCompare),
    /// A check failed.
    #[error("{0}")]
    Check(String),
    /// The camera sees nothing.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// An argument that the parser cannot check.
    #[error("{0}")]
    Argument(String),
    /// A check that the command was asked to make has failed.
    #[error("{0}")]
    CheckFailed(String),
    /// Ctrl-C.
    #[error("interrupted; nothing was left half-written")]
    Interrupted,
    /// There is nothing to report, or the page cannot be written.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// The system refused something.
    #[error("{0}")]
    System(String),
}

impl From<AuditError> for CliError {
    fn from(error: AuditError) -> Self {
        match error {
            AuditError::Solve(error) => Self::Solve(error),
            AuditError::Interrupted => Self::Interrupted,
        }
    }
}

impl From<SweepError> for CliError {
    fn from(error: SweepError) -> Self {
        match error {
            SweepError::Config(error) => Self::Config(error),
            SweepError::Solve(SolveError::Interrupted { .. }) => Self::Interrupted,
            SweepError::Solve(error) => Self::Solve(error),
            SweepError::NothingToCompare(error) => Self::NothingToCompare(error),
            error @ SweepError::NotRepeatable { .. } => Self::Argument(error.to_string()),
        }
    }
}

impl From<TooManyPoints> for CliError {
    fn from(error: TooManyPoints) -> Self {
        Self::Argument(error.to_string())
    }
}

impl CliError {
    /// 1 for a failed check, 2 for wrong arguments or input, 130 for an interruption, 3 for anything else.
    pub fn exit_code(&self) -> u8 {
        match self {
            Self::Arguments(error) => u8::try_from(error.exit_code()).unwrap_or(2),
            Self::Check(_) => 1,
            Self::Load(_)
            | Self::UnknownScene(_)
            | Self::Config(_)
            | Self::Camera(_)
            | Self::Solution(_)
            | Self::Argument(_)
            | Self::Checkpoint(_)
            | Self::Toml(_)
            | Self::Filter(_)
            | Self::Comparison(_)
            | Self::NothingToCompare(_)
            | Self::Reference(ReferenceError::Config(_))
            | Self::Solve(SolveError::Config(_) | SolveError::Snapshot(_)) => 2,
            Self::CheckFailed(_) => 1,
            Self::Interrupted
            | Self::Suspended { .. }
            | Self::Stopped(_)
            | Self::Reference(ReferenceError::Interrupted)
            | Self::Solve(SolveError::Interrupted { .. })
            | Self::Output(OutputError::Interrupted { .. }) => 130,
            Self::Report(ReportError::Output(_)) => 3,
            Self::Report(_) => 2,
            Self::Embree(_) | Self::Output(_) | Self::System(_) => 3,
        }
    }

    /// Says what went wrong: help and versions on standard output, errors on standard error.
    pub fn report(&self) {
        match self {
            Self::Arguments(error) if logs::as_json() && error.use_stderr() => {
                let text = error.render().to_string();
                logs::error(format_args!("{}", text.trim()), self.exit_code());
            }
            Self::Arguments(error) => {
                // A closed pipe is no reason to fail while failing.
                let _ = error.print();
            }
            other => logs::error(format_args!("{other}"), other.exit_code()),
        }
    }
}
