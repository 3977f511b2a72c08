//! `certilux compare`: the paper's Table 1 against Embree.

use super::args::CompareCommand;
use super::error::CliError;
use super::file_head::FileHead;
use super::file_plan::FilePlan;
use super::logs;
use super::progress::Progress;
use super::scene_source::{load_named, prepare};
use super::session::{Session, print_line};
use super::solve_command::with_threads;
use crate::experiment::{
    ComparisonConfig, ComparisonRow, ComparisonSummary, TableSettings, compare, summarise,
    table_settings,
};
use crate::output::{comparison_csv, comparison_markdown, write_json, write_text};
use crate::solve::{SolveConfig, Technique};
use serde::Serialize;
use std::sync::Arc;

/// Passes where neither the command line nor the table says.
const PASSES: u32 = 3;

/// What the JSON holds.
#[derive(Serialize)]
struct ComparisonFile<'a> {
    #[serde(flatten)]
    head: FileHead<'a>,
    threads: usize,
    repeats: u32,
    scenes: Vec<SceneSettings>,
    summary: &'a [ComparisonSummary],
    rows: &'a [ComparisonRow],
}

/// How one scene was solved.
#[derive(Serialize)]
struct SceneSettings {
    scene: String,
    polygons: usize,
    occluders: usize,
    epsilon: f64,
    rays: u32,
    passes: u32,
}

/// Runs the comparison and writes what was asked for; the table goes to standard output.
pub fn run(session: &Session, command: &CompareCommand) -> Result<(), CliError> {
    // What it measures are times; a check in between would be most of them.
    if command.solve.check_claims {
        return Err(CliError::Argument(
            "--check-claims: compare measures times; solve and audit check claims".to_owned(),
        ));
    }
    let config = command.solve.config()?;
    if config.technique != SolveConfig::default().technique {
        logs::warn(format_args!(
            "--technique is not used: --techniques says what is put beside normal"
        ));
    }
    if command.solve.converge.is_some() {
        logs::warn(format_args!(
            "--converge is not used: compare runs a fixed number of passes, --passes"
        ));
    }
    let scenes = command.scenes.iter();
    scenes
        .fold(FilePlan::default(), |plan, scene| {
            plan.scene("SCENE", scene.as_ref())
        })
        .writes("--csv", &command.csv)
        .writes("--json", &command.json)
        .writes("--markdown", &command.markdown)
        .check()?;
    with_threads(command.reading.threads, || {
        compare_all(session, command, &config)
    })
}

fn compare_all(
    session: &Session,
    command: &CompareCommand,
    config: &SolveConfig,
) -> Result<(), CliError> {
    let techniques: Vec<Technique> = command.techniques.iter().map(|&t| t.into()).collect();
    let mut rows = Vec::new();
    let mut scenes = Vec::new();
    let mut embree = String::new();
    // A scene that cannot be read is better known before the first is solved than after the last but one.
    let read = |name: &String| load_named(name.as_ref(), &command.reading);
    let loaded = session
        .stops_at_once(|| (command.scenes.iter().map(read)).collect::<Result<Vec<_>, _>>())?;
    for (name, scene) in command.scenes.iter().zip(loaded) {
        let table = name.strip_prefix("builtin:").and_then(table_settings);
        let scene_config = settings_for(command, config, table);
        let prepared = session.stops_at_once(|| {
            prepare(scene, &command.reading, config.seed)
                .map(|p| p.with_guarantees(Technique::Blockers, &command.solve.occluders.config()))
        })?;
        let passes = command
            .solve
            .passes
            .or(table.map(|t| t.passes))
            .unwrap_or(PASSES);
        let progress = Progress::new(
            session.quiet,
            Arc::clone(&session.interrupted),
            &scene_config,
        );
        rows.extend(compare(
            &prepared,
            &scene_config,
            &ComparisonConfig {
                techniques: techniques.clone(),
                passes,
                repeat: command.repeat,
            },
            &progress,
        )?);
        progress.finish();
        embree = prepared.embree_version.to_string();
        scenes.push(SceneSettings {
            scene: name.clone(),
            polygons: prepared.scene.polygons.len(),
            occluders: prepared
                .guarantees
                .as_ref()
                .map_or(0, |g| g.occluders.len()),
            epsilon: scene_config.epsilon,
            rays: scene_config.rays,
            passes,
        });
    }
    let summary = summarise(&rows);
    let about = format!(
        "certilux {}, Embree {embree}, {} thread(s), {} repeat(s), {}.",
        env!("CARGO_PKG_VERSION"),
        rayon::current_num_threads(),
        command.repeat,
        scenes
            .iter()
            .map(|s| format!(
                "{} at epsilon {:e} with {} rays",
                s.scene, s.epsilon, s.rays
            ))
            .collect::<Vec<_>>()
            .join(", ")
    );
    let markdown = comparison_markdown(&rows, &summary, &about);
    if let Some(path) = &command.csv {
        write_text(path, &comparison_csv(&rows), &session.interrupted)?;
    }
    if let Some(path) = &command.markdown {
        write_text(path, &markdown, &session.interrupted)?;
    }
    if let Some(path) = &command.json {
        let file = ComparisonFile {
            head: FileHead::new(session, embree),
            threads: rayon::current_num_threads(),
            repeats: command.repeat,
            scenes,
            summary: &summary,
            rows: &rows,
        };
        write_json(path, &file, &session.interrupted)?;
    }
    // The table is the result, not progress: --quiet leaves it.
    print_line(format_args!("{markdown}"));
    Ok(())
}

/// The table's settings for its scenes, unless the command line says otherwise.
fn settings_for(
    command: &CompareCommand,
    config: &SolveConfig,
    table: Option<TableSettings>,
) -> SolveConfig {
    // A preset that is asked for is the reader's word, not the table's.
    let Some(table) = table.filter(|_| command.solve.quality.is_none()) else {
        return config.clone();
    };
    SolveConfig {
        epsilon: command.solve.epsilon.unwrap_or(table.epsilon),
        rays: command.solve.rays.unwrap_or(table.rays),
        ..config.clone()
    }
}
