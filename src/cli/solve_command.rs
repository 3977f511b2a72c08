//! `certilux solve`: OBJ in; solution, picture and numbers out.

use super::args::SolveCommand;
use super::checkpointing::Checkpointing;
use super::error::CliError;
use super::file_plan::FilePlan;
use super::finished_solve::FinishedSolve;
use super::folder_lock::FolderLock;
use super::logs;
use super::memory_guard::{MemoryGuard, check_estimate};
use super::output_files::{
    RESULTS, asked_outputs, remove_other_outputs, write_outputs, written_names,
};
use super::progress::Progress;
use super::quality::Quality;
use super::result_paths::make_result_folder;
use super::scene_source::{load_scene, prepare};
use super::session::Session;
use super::solve_settings::settings;
use super::summary::print_summary;
use crate::job::MemoryEstimate;
use crate::output::{
    ContentBlock, Fingerprint, HierarchyBlock, OutputError, OutputsBlock, SceneBlock, SecondsBlock,
    SolvedMesh, Staging, StatsFile, file_hash, write_ply,
};
use crate::solve::{
    ClaimCheck, Guarantees, PreparedScene, SolveConfig, Solved, Stop, resume, solve,
};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

/// Solves a scene and writes the results.
pub fn run(session: &Session, command: &SolveCommand) -> Result<(), CliError> {
    let config = command.solve.config()?;
    FilePlan::default()
        .scene("SCENE", &command.scene.scene)
        .writes_into("--out", &command.out, RESULTS)
        .check()?;
    with_threads(command.scene.reading.threads, || {
        solve_and_write(session, command, &config)
    })
}

/// Runs `work` on so many threads; 0 is one a processor.
pub fn with_threads<R: Send>(
    threads: usize,
    work: impl FnOnce() -> Result<R, CliError> + Send,
) -> Result<R, CliError> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .stack_size(WORKER_STACK)
        .build()
        .map_err(|e| CliError::System(format!("cannot start threads: {e}")))?
        .install(work)
}

/// Stack of a worker: the walk recurses once a level of hierarchy and patches on both ends, about half
/// a kilobyte each; a chain of clusters can be thousands deep.
const WORKER_STACK: usize = 64 << 20;

fn solve_and_write(
    session: &Session,
    command: &SolveCommand,
    config: &SolveConfig,
) -> Result<(), CliError> {
    let start = Instant::now();
    let scene = session.stops_at_once(|| load_scene(&command.scene))?;
    let load = start.elapsed().as_secs_f64();
    tracing::info!(
        scene = scene.name,
        polygons = scene.polygons.len(),
        seconds = load,
        "scene loaded"
    );
    let fingerprint = Fingerprint::new(&scene, settings(command, config));
    if command.resume {
        if let Some(finished) = FinishedSolve::find(&command.out, &fingerprint) {
            return finished.complete(session, command);
        }
        if !command.renew {
            FinishedSolve::refuse_another(&command.out, &fingerprint)?;
        }
    }
    let estimate = MemoryEstimate::of(&scene, config, !command.no_view);
    check_estimate(estimate, command.max_memory)?;
    // A folder that cannot be made is better known before the solve than after; an invalid scene makes none.
    make_result_folder(&command.out, &written_names(command))?;
    let _lock = FolderLock::take(&command.out)?;
    let progress = Progress::new(session.quiet, Arc::clone(&session.interrupted), config);
    let prepared = session.stops_at_once(|| {
        prepare(scene, &command.scene.reading, config.seed)
            .map(|p| p.with_guarantees(config.technique, &command.solve.occluders.config()))
    })?;
    tracing::info!(
        facets = prepared.hierarchy.facets.len(),
        occluders = prepared
            .guarantees
            .as_ref()
            .map_or(0, |g| g.occluders.len()),
        "scene prepared"
    );
    let solving = Instant::now();
    let guard = MemoryGuard::new(&progress, command.max_memory);
    let checkpoint = Checkpointing::new(
        &guard,
        &command.out,
        &prepared,
        fingerprint.clone(),
        !command.no_checkpoint && !config.check_claims,
    );
    let (solved, earlier_seconds) =
        solve_or_resume(session, &prepared, config, &checkpoint, command.resume).map_err(
            |error| match guard.exceeded() {
                Some(held) => CliError::System(format!(
                    "after a pass the solve held {held} of memory, more than --max-memory; {error}"
                )),
                None => error,
            },
        )?;
    progress.finish();
    let solve_seconds = solving.elapsed().as_secs_f64() + earlier_seconds;
    for warning in &solved.warnings {
        logs::warn(format_args!("{warning}"));
    }
    let writing = Instant::now();
    let mut staging = Staging::new(&command.out)?;
    let mesh = SolvedMesh::new(&prepared.scene, &solved.solution);
    let solution_path = staging.file("solution.ply")?;
    write_ply(&solution_path, &mesh, &session.interrupted)?;
    write_outputs(session, command, &mesh, &mut staging, |_| true)?;
    let stats_path = staging.file("stats.json")?;
    let mut stats = stats_file(
        session,
        config,
        command.solve.quality.unwrap_or_default(),
        &prepared,
        &solved,
    );
    stats.content = ContentBlock {
        scene: fingerprint.scene.clone(),
        settings: fingerprint.settings_hash(),
        solution: file_hash(&solution_path)
            .map_err(|e| OutputError::io("read", &solution_path, e))?,
    };
    stats.settings = fingerprint.settings;
    stats.outputs = asked_outputs(command);
    // With the black face of each polygon that no light reaches.
    stats.hierarchy.leaves = mesh.faces.len();
    let guaranteed = prepared
        .guarantees
        .as_ref()
        .map_or_else(Default::default, |g| g.seconds);
    stats.seconds = SecondsBlock {
        load,
        cluster: prepared.seconds.cluster,
        occluders: guaranteed.total,
        embree: prepared.seconds.embree,
        solve: solve_seconds,
        output: writing.elapsed().as_secs_f64(),
        cluster_sides: prepared.seconds.sides,
        occluders_rectangles: guaranteed.extraction.rectangles,
        occluders_solids: guaranteed.extraction.solids,
        occluders_empty_boxes: guaranteed.empty_boxes,
    };
    stats.write(&stats_path, &session.interrupted)?;
    let files = staging.publish()?;
    remove_other_outputs(command);
    checkpoint.remove();
    if !session.quiet {
        print_summary(&stats, &files);
    }
    if config.check_claims {
        report_check(session, &solved.check)?;
    }
    Ok(())
}

/// Solves from the start, or from the checkpoint; with the seconds that its passes took.
fn solve_or_resume(
    session: &Session,
    prepared: &PreparedScene,
    config: &SolveConfig,
    checkpoint: &Checkpointing<'_>,
    wanted: bool,
) -> Result<(Solved, f64), CliError> {
    let explain = |error| checkpoint.explain(error);
    let Some(state) = checkpoint.state(wanted)? else {
        if wanted {
            session.say(format_args!(
                "no checkpoint: the solve starts at its beginning"
            ));
        }
        return Ok((solve(prepared, config, checkpoint).map_err(explain)?, 0.0));
    };
    let solved = resume(prepared, config, checkpoint, &state).map_err(explain)?;
    let earlier = solved.passes.len().saturating_sub(checkpoint.passes_made());
    session.say(format_args!("went on after pass {earlier}"));
    let seconds = solved.passes[..earlier].iter().map(|p| p.seconds).sum();
    Ok((solved, seconds))
}

/// Says what the rays of proved exchanges found; an error if a claim is wrong.
fn report_check(session: &Session, check: &ClaimCheck) -> Result<(), CliError> {
    session.say(format_args!(
        "claims checked: {} rays, {} disagree with Embree, {} contradictions stand",
        check.rays,
        check.disagreements,
        check.contradictions.len()
    ));
    if check.native_rays > 0 {
        session.say(format_args!(
            "native tests checked: {} rays, {} disagree with Embree, {} are wrong",
            check.native_rays,
            check.native_disagreements,
            check.native_errors.len()
        ));
    }
    if let Some(first) = check.native_errors.first() {
        return Err(CliError::CheckFailed(format!(
            "{} native tests of rays are wrong; the first: {first:?}",
            check.native_errors.len()
        )));
    }
    match check.contradictions.first() {
        None => Ok(()),
        Some(first) => Err(CliError::CheckFailed(format!(
            "{} rays prove claims wrong; the first: {first:?}",
            check.contradictions.len()
        ))),
    }
}

fn stats_file(
    session: &Session,
    config: &SolveConfig,
    quality: Quality,
    prepared: &PreparedScene,
    solved: &Solved,
) -> StatsFile {
    let hierarchy = &prepared.hierarchy;
    let guarantees = prepared.guarantees.as_ref();
    let count = |kind| hierarchy.nodes.iter().filter(|n| n.kind == kind).count();
    let mut scene = SceneBlock::new(&prepared.scene);
    scene.warnings.extend(solved.warnings.iter().cloned());
    StatsFile {
        format: StatsFile::FORMAT,
        certilux: env!("CARGO_PKG_VERSION").to_owned(),
        embree: prepared.embree_version.to_string(),
        command: session.words.clone(),
        seed: config.seed,
        threads: rayon::current_num_threads(),
        technique: config.technique.name().to_owned(),
        epsilon: config.epsilon,
        rays_per_exchange: config.rays,
        quality: quality.name().to_owned(),
        converge: match config.stop {
            Stop::Converged(x) => Some(x),
            Stop::Passes(_) => None,
        },
        settings: BTreeMap::new(),
        content: ContentBlock::default(),
        outputs: OutputsBlock::new(),
        scene,
        hierarchy: HierarchyBlock {
            face_clusters: count(crate::cluster::NodeKind::FaceCluster),
            volume_clusters: count(crate::cluster::NodeKind::Volume),
            occluders: guarantees.map_or(0, |g| g.occluders.len()),
            leaves: solved.leaves,
            bytes: hierarchy.bytes() + solved.bytes + guarantees.map_or(0, Guarantees::bytes),
        },
        passes: solved.passes.clone(),
        seconds: SecondsBlock::default(),
        power: solved.power,
        row_scales: solved.normalised.clone(),
    }
}
