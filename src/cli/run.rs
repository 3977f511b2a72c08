//! Chooses the command.

use super::args::{Cli, Command};
use super::defaults::{self, Filled};
use super::error::CliError;
use super::session::{Session, check_printed};
use super::{
    audit_command, batch_child, batch_command, bench_command, clusters_command, compare_command,
    error_budget_command, error_command, generate_command, interrupt, logs, manual_commands,
    occluders_command, reference_command, report_command, solve_command, sweep_command,
    view_command,
};
use std::ffi::OsString;

/// Runs the program on its arguments, the program's name first.
///
/// # Errors
/// Whatever the command meets; see [`CliError::exit_code`].
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> Result<(), CliError> {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    batch_child::end_with_batch();
    let Filled {
        cli,
        sources,
        warnings,
    } = match defaults::parse(&arguments) {
        Ok(filled) => filled,
        Err(error) => {
            // Whoever reads lines of JSON is told in JSON what was wrong with the rest.
            logs::install(arguments.iter().any(|a| a == "--json-logs"))?;
            return Err(error);
        }
    };
    logs::install(cli.json_logs)?;
    for warning in &warnings {
        logs::warn(format_args!("{warning}"));
    }
    let rest = arguments.iter().skip(1);
    interrupt::survive_size_limits();
    let interrupt = interrupt::install()?;
    let session = Session {
        quiet: cli.quiet,
        words: std::iter::once("certilux".to_owned())
            .chain(rest.map(|a| a.to_string_lossy().into_owned()))
            .collect(),
        interrupted: interrupt.raised,
        idle: interrupt.idle,
    };
    let done = dispatch(&session, &cli).and_then(|()| check_printed());
    done.map_err(|error| match error {
        // Whoever did not type the flag is told who did.
        CliError::Config(error) => match sources.get(error.flag.trim_start_matches('-')) {
            Some(source) => CliError::Argument(format!("{source}: {error}")),
            None => error.into(),
        },
        other => other,
    })
}

fn dispatch(session: &Session, cli: &Cli) -> Result<(), CliError> {
    match &cli.command {
        Command::Solve(command) => solve_command::run(session, command),
        Command::Batch(command) => batch_command::run(session, command, cli.no_config),
        Command::View(command) => view_command::run(session, command),
        Command::Clusters(command) => clusters_command::run(session, command),
        Command::Bench(command) => bench_command::run(session, command),
        Command::Compare(command) => compare_command::run(session, command),
        Command::Occluders(command) => occluders_command::run(session, command),
        Command::Reference(command) => reference_command::run(session, command),
        Command::Error(command) => error_command::run(session, command),
        Command::Audit(command) => audit_command::run(session, command),
        Command::ErrorBudget(command) => error_budget_command::run(session, command),
        Command::Report(command) => report_command::run(session, command),
        Command::Sweep(command) => sweep_command::run(session, command),
        Command::Generate(command) => generate_command::run(session, command),
        Command::Completions(command) => manual_commands::completions(command),
        Command::Man(command) => manual_commands::man(session, command),
    }
}
