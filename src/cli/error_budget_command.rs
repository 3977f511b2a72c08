//! `certilux error-budget`: where the error of a solve comes from.

use super::error::CliError;
use super::error_budget_args::ErrorBudgetCommand;
use super::file_head::FileHead;
use super::file_plan::FilePlan;
use super::progress::Progress;
use super::scene_source::{load_scene, prepare};
use super::session::{Session, print_line};
use super::solve_command::with_threads;
use super::sweep_command::check_faces;
use crate::experiment::{BudgetedError, ErrorBudget, error_budget};
use crate::output::{read_reference, true_faces, write_json};
use crate::solve::SolveConfig;
use serde::Serialize;
use std::sync::Arc;

/// Prints the table.
pub fn run(session: &Session, command: &ErrorBudgetCommand) -> Result<(), CliError> {
    let config = command.solve.config()?;
    FilePlan::default()
        .scene("SCENE", &command.scene.scene)
        .reads("--reference", [&command.reference])
        .writes("--json", &command.json)
        .check()?;
    with_threads(command.scene.reading.threads, || {
        budget(session, command, &config)
    })
}

/// What `--json` writes.
#[derive(Serialize)]
struct BudgetFile<'a> {
    #[serde(flatten)]
    head: FileHead<'a>,
    scene: &'a str,
    #[serde(flatten)]
    budget: &'a ErrorBudget,
}

fn budget(
    session: &Session,
    command: &ErrorBudgetCommand,
    config: &SolveConfig,
) -> Result<(), CliError> {
    let records = read_reference(&command.reference)
        .map_err(CliError::Solution)?
        .faces;
    let scene = session.stops_at_once(|| load_scene(&command.scene))?;
    check_faces(&records, &scene)?;
    let truth = true_faces(&records, Some(&scene))?;
    let prepared = prepare(scene, &command.scene.reading, config.seed)?
        .with_guarantees(config.technique, &command.solve.occluders.config());
    let progress = Progress::new(session.quiet, Arc::clone(&session.interrupted), config);
    let budget = error_budget(&prepared, &truth, config, command.seeds, &progress)?;
    drop(progress);
    print_budget(&prepared.scene.name, &budget);
    if let Some(path) = &command.json {
        let file = BudgetFile {
            head: FileHead::new(session, prepared.embree_version),
            scene: &prepared.scene.name,
            budget: &budget,
        };
        write_json(path, &file, &session.interrupted)?;
    }
    Ok(())
}

/// The table is the result, not progress: `--quiet` leaves it.
fn print_budget(scene: &str, budget: &ErrorBudget) {
    let line = |what: &str, error: &BudgetedError, removed: &str| {
        print_line(format_args!(
            "| {what:36} | {:>8.3} | {:>+8.3} | {removed:>10} | {:>9.2} |",
            100.0 * error.relative_rms,
            100.0 * error.bias,
            error.processor_seconds
        ));
    };
    print_line(format_args!(
        "{scene}: noise of the reference {:.3} %, taken off; {:.0} % of the squared error is chance ({} seeds)",
        100.0 * budget.reference_noise,
        100.0 * budget.chance,
        budget.seeds
    ));
    print_line(format_args!(
        "| {:36} | {:>8} | {:>8} | {:>10} | {:>9} |",
        "made nearly exact", "error %", "bias %", "removed %", "seconds"
    ));
    print_line(format_args!("|---|---|---|---|---|"));
    line("nothing", &budget.error, "");
    for row in &budget.lines {
        let removed = format!("{:.0}", 100.0 * row.removed);
        line(row.approximation.change(), &row.error, &removed);
    }
}
