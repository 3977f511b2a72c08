//! `certilux sweep`: speed against accuracy.

use super::error::CliError;
use super::file_plan::FilePlan;
use super::logs;
use super::reference_command::measure_scene;
use super::result_paths::make_result_folder;
use super::scene_source::{load_scene, prepare};
use super::session::Session;
use super::solve_command::with_threads;
use super::sweep_args::{SweepCommand, presets};
use super::sweep_progress::SweepProgress;
use crate::experiment::{Sweep, SweepRow, SweepSettings, error_at_cost, sweep_fronts};
use crate::output::{
    OutputError, ReferenceFace, ReferenceRequest, SweepCost, SweepKey, SweepMeta, read_reference,
    read_sweep, scene_hash, sweep_csv, true_faces, write_reference, write_sweep, write_sweep_plot,
    write_text,
};
use crate::reference::{ReferenceError, SolvedLights, TrueFace, solution_error};
use crate::scene::Scene;
use crate::solve::PreparedScene;
use clap::ValueEnum;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// The reference that a sweep measures itself.
const REFERENCE: &str = "reference.json";
/// The rows, as `--resume` reads them.
const TABLE: &str = "sweep.json";

/// The results.
const FILES: [&str; 6] = [
    "sweep.csv",
    TABLE,
    "error-seconds.svg",
    "error-seconds.png",
    "error-rays.svg",
    "error-rays.png",
];

/// Solves the grid and writes table and plots.
pub fn run(session: &Session, command: &SweepCommand) -> Result<(), CliError> {
    let points = command.points()?;
    let base = command.base();
    for point in &points {
        point.solve_config(&base).validate()?;
    }
    command
        .reference_config()
        .validate()
        .map_err(ReferenceError::from)?;
    FilePlan::default()
        .scene("SCENE", &command.scene.scene)
        .reads("--reference", &command.reference)
        .writes_into("--out", &command.out, names(command))
        .check()?;
    with_threads(command.scene.reading.threads, || {
        sweep_and_write(session, command, &points)
    })
}

/// What a sweep writes into its folder.
fn names(command: &SweepCommand) -> Vec<&'static str> {
    let own_reference = command.reference.is_none().then_some(REFERENCE);
    FILES.into_iter().chain(own_reference).collect()
}

fn sweep_and_write(
    session: &Session,
    command: &SweepCommand,
    points: &[SweepSettings],
) -> Result<(), CliError> {
    // What was named is looked at before anything is written.
    let named = (command.reference.as_deref())
        .map(|path| read_reference(path).map_err(CliError::Solution))
        .transpose()?
        .map(|reference| reference.faces);
    let scene = session.stops_at_once(|| load_scene(&command.scene))?;
    if let Some(records) = &named {
        check_faces(records, &scene)?;
    }
    make_result_folder(&command.out, &names(command))?;
    let (reference, records) = match named {
        Some(records) => (command.reference.clone().unwrap_or_default(), records),
        None => (
            PathBuf::from(REFERENCE),
            own_reference(session, command, &scene)?,
        ),
    };
    let truth = true_faces(&records, Some(&scene))?;
    let mean = solution_error(&truth, &SolvedLights::new())?.mean;
    let start = Instant::now();
    let base = command.base();
    let mut prepared = prepare(scene, &command.scene.reading, base.seed)?;
    let meta = SweepMeta {
        key: SweepKey {
            format: SweepKey::FORMAT,
            certilux: env!("CARGO_PKG_VERSION").to_owned(),
            embree: prepared.embree_version.to_string(),
            scene_hash: scene_hash(&prepared.scene),
            sides: sides_name(command),
            seed: base.seed,
            normalise: base.normalise,
            threads: rayon::current_num_threads(),
            reference_faces: truth.len(),
            reference_mean: mean,
        },
        command: session.words.clone(),
        scene: prepared.scene.name.clone(),
        polygons: prepared.scene.polygons.len(),
        reference: reference.display().to_string(),
        prepare_seconds: start.elapsed().as_secs_f64(),
        repeats: command.repeats(),
    };
    let rows = rows_to_solve(command, points, &meta.key)?;
    let table = Table {
        session,
        folder: &command.out,
        meta: &meta,
    };
    let rows = solve_all(&mut prepared, &truth, rows, command, &table)?;
    table.write(&rows)?;
    table.plot(&rows)?;
    table.say(&rows);
    Ok(())
}

/// A reference of another scene is better refused than compared with.
pub fn check_faces(records: &[ReferenceFace], scene: &Scene) -> Result<(), CliError> {
    let stranger = records
        .iter()
        .find(|record| record.face_index >= scene.source_faces);
    match stranger {
        None => Ok(()),
        Some(record) => Err(CliError::Argument(format!(
            "--reference: face {} is not in the scene, which has {} faces",
            record.face_index, scene.source_faces
        ))),
    }
}

/// The reference in the folder of the results: that of the sweep that is taken up again, or a new one.
fn own_reference(
    session: &Session,
    command: &SweepCommand,
    scene: &Scene,
) -> Result<Vec<ReferenceFace>, CliError> {
    let path = command.out.join(REFERENCE);
    let config = command.reference_config();
    if !(command.resume && keeps_reference(&path, command, scene)) {
        let (meta, reference) = measure_scene(session, scene.clone(), &command.scene, &config)?;
        write_reference(&path, &meta, &reference, &session.interrupted)?;
    }
    let records = read_reference(&path).map_err(CliError::Solution)?.faces;
    check_faces(&records, scene)?;
    Ok(records)
}

/// Whether the reference that stands at `path` serves: it is the one asked for, or rows were compared with it.
fn keeps_reference(path: &Path, command: &SweepCommand, scene: &Scene) -> bool {
    let config = command.reference_config();
    let asked = ReferenceRequest {
        scene_hash: scene_hash(scene),
        sides: sides_name(command),
        error: config.error,
        max_seconds: config.max_seconds,
    };
    let found = ReferenceRequest::of_file(path);
    if found.as_ref() == Some(&asked) {
        return true;
    }
    let has_rows = path.exists() && path.with_file_name(TABLE).exists();
    if let Some(found) = found.filter(|_| has_rows) {
        let text = |request: &ReferenceRequest| {
            let limit = request.max_seconds;
            let limit = limit.map_or_else(String::new, |s| format!(" in {s} s at most"));
            format!("a standard error of {}{limit}", request.error)
        };
        // Another scene or other sides: the rows tell, and are refused.
        if (found.error, found.max_seconds) != (asked.error, asked.max_seconds) {
            logs::warn(format_args!(
                "{} is kept, since rows were compared with it; it was measured for {}, not {}",
                path.display(),
                text(&found),
                text(&asked)
            ));
        }
    }
    has_rows
}

/// `--sides`, as the flag calls it.
fn sides_name(command: &SweepCommand) -> String {
    let sides = command.scene.reading.sides.to_possible_value();
    sides.map_or_else(String::new, |v| v.get_name().to_owned())
}

/// A row a point, with what an earlier sweep found of it; rows of points that are not asked for now
/// come last and stay in the table.
fn rows_to_solve(
    command: &SweepCommand,
    points: &[SweepSettings],
    key: &SweepKey,
) -> Result<Vec<SweepRow>, CliError> {
    let path = command.out.join(TABLE);
    let mut kept = match command.resume && path.exists() {
        true => read_sweep(&path, key).map_err(CliError::Solution)?,
        false => Vec::new(),
    };
    let mut rows: Vec<SweepRow> = Vec::with_capacity(points.len());
    for point in points {
        let found = kept.iter().position(|row| row.settings == *point);
        rows.push(match found {
            Some(at) => kept.remove(at),
            None => SweepRow::new(*point),
        });
    }
    rows.extend(kept);
    Ok(rows)
}

/// Solves until every row has its repeats; the table is written after each solve.
fn solve_all(
    prepared: &mut PreparedScene,
    truth: &[TrueFace],
    rows: Vec<SweepRow>,
    command: &SweepCommand,
    table: &Table<'_>,
) -> Result<Vec<SweepRow>, CliError> {
    let session = table.session;
    let mut sweep = Sweep::new(prepared, truth, command.base(), rows)?;
    let solves = sweep.left(command.repeats());
    let progress = SweepProgress::new(session.quiet, Arc::clone(&session.interrupted), solves);
    while let Some(index) = sweep.next(command.repeats()) {
        progress.begins(&sweep.rows[index].settings);
        let run = sweep.run(index, &progress).map_err(CliError::from);
        run.and_then(|()| {
            table.write(&sweep.rows).map_err(|error| match error {
                // The solve stays unwritten, the table before it stands.
                CliError::Output(OutputError::Interrupted { .. }) => CliError::Interrupted,
                error => error,
            })
        })
        .inspect_err(|error| {
            if matches!(error, CliError::Interrupted) {
                let done = solves - sweep.left(command.repeats());
                eprintln!(
                    "certilux: {done} of {solves} solves are in {}; --resume goes on from there",
                    table.folder.join(TABLE).display()
                );
            }
        })?;
        progress.ends();
    }
    Ok(sweep.rows)
}

/// The results of a sweep and where they go.
struct Table<'a> {
    session: &'a Session,
    folder: &'a Path,
    meta: &'a SweepMeta,
}

impl Table<'_> {
    /// Writes `sweep.csv` and `sweep.json`.
    fn write(&self, rows: &[SweepRow]) -> Result<(), CliError> {
        let names = presets();
        let interrupted = &self.session.interrupted;
        let csv = sweep_csv(&self.meta.scene, rows, &names);
        write_text(&self.folder.join("sweep.csv"), &csv, interrupted)?;
        let json = self.folder.join(TABLE);
        write_sweep(&json, self.meta, rows, &names, interrupted)?;
        Ok(())
    }

    /// Writes the plots.
    fn plot(&self, rows: &[SweepRow]) -> Result<(), CliError> {
        let plots = [
            ("error-seconds", SweepCost::Seconds),
            ("error-rays", SweepCost::Rays),
        ];
        for (name, cost) in plots {
            write_sweep_plot(
                &self.folder.join(name),
                &self.meta.scene,
                rows,
                &presets(),
                cost,
                &self.session.interrupted,
            )?;
        }
        Ok(())
    }

    /// The front, and what time buys on it, on standard output.
    fn say(&self, rows: &[SweepRow]) {
        let say = |line: std::fmt::Arguments<'_>| self.session.say(line);
        say(format_args!(
            "{}: {} rows; on the front of error against processor time:",
            self.meta.scene,
            rows.len()
        ));
        let mut front: Vec<(f64, &SweepRow)> = rows
            .iter()
            .zip(sweep_fronts(rows))
            .filter_map(|(row, [on, _])| {
                Some((row.processor_seconds().filter(|_| on)?.median, row))
            })
            .collect();
        front.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (seconds, row) in &front {
            let (s, Some(outcome)) = (&row.settings, &row.outcome) else {
                continue;
            };
            say(format_args!(
                "{seconds:>10.3} s {:>8.3} % {:>12} rays  {} --epsilon {:e} --rays {} --converge {:e}",
                100.0 * outcome.relative_rms,
                outcome.rays,
                s.technique.name(),
                s.epsilon,
                s.rays,
                s.converge
            ));
        }
        let [_, (_, defaults), _] = presets();
        let at = rows.iter().find(|row| row.settings == defaults);
        if let Some(seconds) = at.and_then(SweepRow::processor_seconds) {
            for (share, words) in [
                (0.25, "a quarter of"),
                (0.5, "half"),
                (1.0, "all"),
                (2.0, "twice"),
            ] {
                if let Some(error) = error_at_cost(rows, share * seconds.median) {
                    say(format_args!(
                        "{words} the processor time of the defaults buys an error of {:.3} %",
                        100.0 * error
                    ));
                }
            }
        }
        for file in FILES {
            say(format_args!("wrote {}", self.folder.join(file).display()));
        }
    }
}
