//! `certilux bench`: records a baseline of a suite, or checks against one.

use super::args::{BenchCommand, BenchFormat, SuiteArg};
use super::callgrind::count_instructions;
use super::error::CliError;
use super::file_plan::FilePlan;
use super::logs;
use super::scene_source::read_scene;
use super::session::{Session, print_line};
use super::solve_command::with_threads;
use crate::embree::DeviceConfig;
use crate::experiment::{
    Baseline, BaselineKey, BaselineRow, ComparisonConfig, SuiteCase, compare, dearer, regressions,
    suite,
};
use crate::occluder::OccluderConfig;
use crate::output::write_json;
use crate::scene::{LoadConfig, SidesMode};
use crate::solve::{Observer, PreparedScene, SolveConfig, Technique};
use serde_json::json;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Instruction set of every run: bits, and so counts, depend on it.
const ISA: &str = "avx2";

/// How often a suite that was slower is run again, in case other work on the machine was to blame.
const RUNS_AGAIN: u32 = 3;

/// Runs the suite, then records or checks.
pub fn run(session: &Session, command: &BenchCommand) -> Result<(), CliError> {
    (FilePlan::default().writes("--record", &command.record)).check()?;
    // A baseline that cannot be read is better known before the suite has run.
    let baseline = command.check.as_deref().map(read_baseline).transpose()?;
    if let Some(baseline) = &baseline {
        check_suite(baseline, command)?;
    }
    let mut now = with_threads(command.threads, || run_suite(session, command.suite))?;
    if !command.no_instructions {
        now.instructions = count_instructions(session)?;
    }
    report(command.format, &now);
    if let Some(path) = &command.record {
        write_json(path, &now, &session.interrupted)?;
        session.say(format_args!("wrote {}", path.display()));
    }
    let Some(baseline) = baseline else {
        return Ok(());
    };
    for _ in 0..RUNS_AGAIN {
        if !baseline.differs_in_times_only(&now) {
            break;
        }
        session.say(format_args!(
            "slower than the baseline: running the suite again to tell"
        ));
        let again = with_threads(command.threads, || run_suite(session, command.suite))?;
        now.keep_faster(&again);
    }
    let found = regressions(&baseline, &now);
    let key = match baseline.key == now.key {
        true => "the baseline's key: counts exactly, time ratios within tolerance".to_owned(),
        false => format!(
            "a foreign key ({:?} in the baseline, {:?} here): counts within 0.1 %, time ratios within tolerance",
            baseline.key, now.key
        ),
    };
    let key = format!("{key}; {}", instructions_compared(&baseline, &now));
    if found.is_empty() {
        session.say(format_args!("no regression; checked under {key}"));
        return Ok(());
    }
    Err(CliError::CheckFailed(format!(
        "{} regressions, checked under {key}:\n  {}",
        found.len(),
        found.join("\n  ")
    )))
}

/// Whether instructions were compared, or why not.
fn instructions_compared(baseline: &Baseline, now: &Baseline) -> &'static str {
    match (&baseline.instructions, &now.instructions) {
        (None, _) => "no instructions in the baseline",
        (_, None) => "instructions not counted (valgrind is not installed, or they were left out)",
        (Some(old), Some(new)) => match dearer((&baseline.key, old), (&now.key, new)) {
            Some(_) => "instructions within 3 %",
            None => "instructions not compared (another compiler or key)",
        },
    }
}

fn read_baseline(path: &Path) -> Result<Baseline, CliError> {
    let fail = |reason: String| {
        CliError::Argument(format!(
            "{}: not a baseline of this program: {reason}",
            path.display()
        ))
    };
    let bytes = std::fs::read(path)
        .map_err(|e| CliError::Argument(format!("{}: cannot be read: {e}", path.display())))?;
    serde_json::from_slice(&bytes).map_err(|e| fail(e.to_string()))
}

/// A baseline of another suite has nothing that the run could be compared with.
fn check_suite(baseline: &Baseline, command: &BenchCommand) -> Result<(), CliError> {
    let asked = command.suite.name();
    if baseline.suite == asked && baseline.format == Baseline::FORMAT {
        return Ok(());
    }
    Err(CliError::Argument(format!(
        "--check: the baseline is of --suite {}, format {}; --suite {asked}, format {} was to be run",
        baseline.suite,
        baseline.format,
        Baseline::FORMAT
    )))
}

fn run_suite(session: &Session, which: SuiteArg) -> Result<Baseline, CliError> {
    let name = which.name();
    let cases = suite(name).unwrap_or_default();
    let mut now = Baseline {
        format: Baseline::FORMAT,
        suite: name.to_owned(),
        key: BaselineKey::here(String::new(), ISA),
        occluders: Vec::new(),
        rows: Vec::new(),
        instructions: None,
    };
    for case in cases {
        if !session.quiet {
            logs::note(format_args!("{}", case.scene));
        }
        run_case(session, case, &mut now)?;
    }
    Ok(now)
}

/// Tells a solve nothing but whether it is to stop.
struct Stoppable<'a>(&'a AtomicBool);

impl Observer for Stoppable<'_> {
    fn interrupted(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

fn run_case(session: &Session, case: &SuiteCase, now: &mut Baseline) -> Result<(), CliError> {
    let config = SolveConfig {
        epsilon: case.epsilon,
        rays: case.rays,
        ..SolveConfig::default()
    };
    let scene = read_scene(
        std::ffi::OsStr::new(&format!("builtin:{}", case.scene)),
        &LoadConfig::default(),
    )?;
    let device = DeviceConfig {
        isa: Some(ISA),
        ..DeviceConfig::default()
    };
    let prepared = session.stops_at_once(|| {
        PreparedScene::new(scene, SidesMode::Auto, config.seed, &device)
            .map(|p| p.with_guarantees(Technique::Blockers, &OccluderConfig::default()))
    })?;
    let rows = compare(
        &prepared,
        &config,
        &ComparisonConfig {
            techniques: vec![Technique::Occlusion, Technique::Blockers],
            passes: case.passes,
            repeat: case.repeat,
        },
        &Stoppable(&session.interrupted),
    )?;
    now.key.embree = prepared.embree_version.to_string();
    let occluders = prepared.guarantees.as_ref().map(|g| g.occluders.len());
    now.occluders.push(occluders.unwrap_or_default());
    now.rows.extend(BaselineRow::of_comparison(&rows));
    Ok(())
}

/// The run on standard output.
fn report(format: BenchFormat, now: &Baseline) {
    match format {
        BenchFormat::Text => {
            for row in &now.rows {
                print_line(format_args!(
                    "{:28} pass {} {:11} {:10} exchanges {:11} rays {:9} shafts  {:8.4} s  {:.3} of normal (+- {:.3})",
                    row.scene,
                    row.pass,
                    row.technique,
                    row.counts.exchanges,
                    row.counts.rays,
                    row.counts.shafts,
                    row.seconds,
                    row.ratio,
                    row.ratio * row.spread
                ));
            }
            for (technique, instructions) in now.instructions.iter().flat_map(|i| &i.by_technique) {
                print_line(format_args!(
                    "{technique:11} {instructions:13} instructions"
                ));
            }
        }
        BenchFormat::Json => print_line(format_args!("{}", json!(now))),
        BenchFormat::Bmf => {
            let mut metrics: serde_json::Map<String, serde_json::Value> = (now.rows.iter())
                .map(|row| {
                    let name = format!("{}/pass{}/{}", row.scene, row.pass, row.technique);
                    let value = json!({
                        "latency": { "value": row.seconds * 1.0e9 },
                        "ratio-to-normal": { "value": row.ratio },
                        "rays": { "value": row.counts.rays },
                        "exchanges": { "value": row.counts.exchanges },
                    });
                    (name, value)
                })
                .collect();
            for (technique, &value) in now.instructions.iter().flat_map(|i| &i.by_technique) {
                let name = format!("instructions/{technique}");
                metrics.insert(name, json!({ "instructions": { "value": value } }));
            }
            print_line(format_args!("{}", json!(metrics)));
        }
    }
}
