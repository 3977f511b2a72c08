//! Chooses the command.

use super::args::{Cli, Command};
use super::error::CliError;
use super::session::Session;
use super::{
    audit_command, bench_command, clusters_command, compare_command, error_command,
    generate_command, interrupt, occluders_command, reference_command, solve_command,
    sweep_command, view_command,
};
use clap::Parser;
use std::ffi::OsString;

/// Runs the program on its arguments, the program's name first.
///
/// # Errors
/// Whatever the command meets; see [`CliError::exit_code`].
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> Result<(), CliError> {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let cli = Cli::try_parse_from(&arguments)?;
    let rest = arguments.iter().skip(1);
    let interrupt = interrupt::install()?;
    let session = Session {
        quiet: cli.quiet,
        words: std::iter::once("certilux".to_owned())
            .chain(rest.map(|a| a.to_string_lossy().into_owned()))
            .collect(),
        interrupted: interrupt.raised,
        idle: interrupt.idle,
    };
    match cli.command {
        Command::Solve(command) => solve_command::run(&session, &command),
        Command::View(command) => view_command::run(&session, &command),
        Command::Clusters(command) => clusters_command::run(&session, &command),
        Command::Bench(command) => bench_command::run(&session, &command),
        Command::Compare(command) => compare_command::run(&session, &command),
        Command::Occluders(command) => occluders_command::run(&session, &command),
        Command::Reference(command) => reference_command::run(&session, &command),
        Command::Error(command) => error_command::run(&session, &command),
        Command::Audit(command) => audit_command::run(&session, &command),
        Command::Sweep(command) => sweep_command::run(&session, &command),
        Command::Generate(command) => generate_command::run(&session, &command),
    }
}
