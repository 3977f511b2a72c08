//! `certilux reference`: unbiased radiosity of every source face, with error bars.

use super::error::CliError;
use super::file_plan::FilePlan;
use super::logs;
use super::reference_args::ReferenceCommand;
use super::reference_progress::ReferenceProgress;
use super::scene_source::load_scene;
use super::session::Session;
use super::solve_args::SceneArgs;
use super::solve_command::with_threads;
use crate::embree::DeviceConfig;
use crate::output::{ReferenceMeta, mean_radiosity, noise_of_faces, scene_hash, write_reference};
use crate::reference::{Reference, ReferenceConfig, ReferenceError, TracedScene, measure};
use crate::scene::Scene;
use crate::solve::SolveConfig;
use clap::ValueEnum;
use std::sync::Arc;

/// Measures a scene and writes REF.json.
pub fn run(session: &Session, command: &ReferenceCommand) -> Result<(), CliError> {
    let config = ReferenceConfig {
        error: command.error,
        max_seconds: command.max_seconds,
        faces: command.faces,
        seed: command.seed,
    };
    config.validate().map_err(ReferenceError::from)?;
    FilePlan::default()
        .scene("SCENE", &command.scene.scene)
        .writes("--out", [&command.out])
        .check()?;
    with_threads(command.scene.reading.threads, || {
        measure_and_write(session, command, &config)
    })
}

fn measure_and_write(
    session: &Session,
    command: &ReferenceCommand,
    config: &ReferenceConfig,
) -> Result<(), CliError> {
    let scene = load_scene(&command.scene)?;
    let (meta, reference) = measure_scene(session, scene, &command.scene, config)?;
    write_reference(&command.out, &meta, &reference, &session.interrupted)?;
    session.say(format_args!("wrote {}", command.out.display()));
    Ok(())
}

/// Measures a scene with the sides that `arguments` ask for, and says how well it is known.
pub fn measure_scene(
    session: &Session,
    scene: Scene,
    arguments: &SceneArgs,
    config: &ReferenceConfig,
) -> Result<(ReferenceMeta, Reference), CliError> {
    let traced = TracedScene::new(
        scene,
        arguments.reading.sides_mode(),
        // The sides of a solve, whatever the seed of the paths.
        SolveConfig::default().seed,
        &DeviceConfig::default(),
    )?;
    let progress = ReferenceProgress::new(
        session.quiet || logs::as_json(),
        Arc::clone(&session.interrupted),
    );
    let reference = measure(&traced, config, &progress)?;
    drop(progress);
    let [radiosity, stderr] = mean_radiosity(&reference.faces);
    let relative = if radiosity > 0.0 {
        stderr / radiosity
    } else {
        0.0
    };
    let noise = noise_of_faces(&reference.faces);
    let sides = arguments.reading.sides.to_possible_value();
    let meta = ReferenceMeta {
        format: ReferenceMeta::FORMAT,
        certilux: env!("CARGO_PKG_VERSION").to_owned(),
        embree: traced.embree_version.to_string(),
        command: session.words.clone(),
        scene: traced.scene.name.clone(),
        scene_hash: scene_hash(&traced.scene),
        sides: sides.map_or_else(String::new, |v| v.get_name().to_owned()),
        seed: config.seed,
        threads: rayon::current_num_threads(),
        error: config.error,
        max_seconds: config.max_seconds,
        faces: config.faces,
        reached: reference.reached,
        rounds: reference.rounds,
        paths: reference.paths,
        rays: reference.rays,
        seconds: reference.seconds,
        mean_stderr: stderr,
        mean_stderr_relative: relative,
        noise: noise.map_or(0.0, |n| n.relative_rms),
        bias_noise: noise.map_or(0.0, |n| n.bias),
    };
    session.say(format_args!(
        "{}: {} faces and sides, {} paths, {} rays, {} round(s), {:.2} s",
        meta.scene,
        reference.faces.len(),
        meta.paths,
        meta.rays,
        meta.rounds,
        meta.seconds
    ));
    session.say(format_args!(
        "mean radiosity {radiosity:.6} W/m2; noise {:.4} % of RMS error, {:.4} % of bias{}",
        100.0 * meta.noise,
        100.0 * meta.bias_noise,
        if meta.reached {
            ""
        } else {
            "; time was up before the asked error was reached"
        }
    ));
    Ok((meta, reference))
}
