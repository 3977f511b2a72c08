//! `certilux error`: how far a solution is from a reference.

use super::error::CliError;
use super::file_plan::FilePlan;
use super::logs;
use super::reference_args::ErrorCommand;
use super::scene_source::read_scene;
use super::session::{Session, print_line};
use super::solved_scene::scene_of_solution;
use crate::output::{
    HashText, read_ply, read_reference, scene_hash, solved_lights, true_faces, write_json,
};
use crate::reference::{FaceError, SolutionError, SolvedLights, TrueFace, solution_error};
use crate::scene::{LoadConfig, Scene, Side};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Faces that are listed one by one.
const WORST: usize = 10;

/// By how much of itself a face's area may differ in the reference of another program, which may keep it in single
/// precision with few digits.
const AREA_TOLERANCE: f64 = 1.0e-3;

/// Prints the figures; fails where the error is above `--max`.
pub fn run(session: &Session, command: &ErrorCommand) -> Result<(), CliError> {
    let path = if command.solution.is_dir() {
        command.solution.join("solution.ply")
    } else {
        command.solution.clone()
    };
    plan(command, &path).check()?;
    let reference = read_reference(&command.reference).map_err(CliError::Solution)?;
    let mesh = read_ply(&path).map_err(CliError::Solution)?;
    let load = LoadConfig {
        clamp_reflectance: true,
        ..LoadConfig::default()
    };
    let scene = command
        .scene
        .as_ref()
        .map(|source| read_scene(source, &load))
        .transpose()?;
    check_scenes(command, &reference.scene_hash, &path, scene.as_ref())?;
    let truth = true_faces(&reference.faces, scene.as_ref())?;
    let lights = solved_lights(&mesh);
    let error = solution_error(&truth, &lights)?;
    if !error.missing.is_empty() {
        logs::warn(format_args!(
            "{} of {} faces are not in the solution and count as black: {}",
            error.missing.len(),
            error.faces.len(),
            names(&error.missing)
        ));
    }
    let other = other_areas(&truth, &lights);
    if !other.is_empty() {
        logs::warn(format_args!(
            "{} of {} faces have another area in the solution than in the reference: are both of the same scene? {}",
            other.len(),
            error.faces.len(),
            names(&other)
        ));
    }
    // The figures are the result, not progress: --quiet leaves them.
    print_figures(&error);
    if let Some(path) = &command.json {
        write_json(path, &ErrorFile::new(&error), &session.interrupted)?;
    }
    match command.max {
        Some(max) if error.relative_rms > max => Err(CliError::Check(format!(
            "the relative RMS error {:.6} is above {max}",
            error.relative_rms
        ))),
        _ => Ok(()),
    }
}

fn plan(command: &ErrorCommand, solution: &PathBuf) -> FilePlan {
    let plan = match &command.scene {
        Some(scene) => FilePlan::default().scene("--scene", scene),
        None => FilePlan::default(),
    };
    plan.reads(
        "the solution",
        [solution, &solution.with_file_name("stats.json")],
    )
    .reads("the reference", [&command.reference])
    .writes("--json", &command.json)
}

/// Refuses a scene that is not that of the reference or of the solution, where they say which was theirs, and a check of a
/// solution by the reference of another scene; without a check that is worth a warning.
fn check_scenes(
    command: &ErrorCommand,
    of_reference: &Option<HashText>,
    solution: &Path,
    scene: Option<&Scene>,
) -> Result<(), CliError> {
    let of_solution = scene_of_solution(solution);
    if let (Some(scene), Some(source)) = (scene, &command.scene) {
        let hash = scene_hash(scene);
        for (known, path, was) in [
            (of_reference, command.reference.as_path(), "measured"),
            (&of_solution, solution, "solved"),
        ] {
            if known.as_ref().is_some_and(|known| *known != hash) {
                return Err(CliError::Argument(format!(
                    "--scene: {} is not the scene that {} was {was} from: its content differs",
                    source.to_string_lossy(),
                    path.display()
                )));
            }
        }
    }
    match (of_reference, &of_solution) {
        (Some(reference), Some(solved)) if reference != solved => {
            let text = format!(
                "{} was measured from another scene than {} was solved from: their contents differ",
                command.reference.display(),
                solution.display()
            );
            if command.max.is_some() {
                return Err(CliError::Argument(format!("--max: {text}")));
            }
            logs::warn(format_args!("{text}"));
        }
        _ => {}
    }
    Ok(())
}

/// Faces of both whose areas are not the same: of another scene, most likely.
fn other_areas(truth: &[TrueFace], lights: &SolvedLights) -> Vec<(u32, Side)> {
    let differs = |face: &&TrueFace| {
        let area = lights.get(&(face.face, face.side)).map(|light| light.area);
        area.is_some_and(|area| (area - face.area).abs() > AREA_TOLERANCE * face.area)
    };
    (truth.iter().filter(differs))
        .map(|face| (face.face, face.side))
        .collect()
}

fn print_figures(error: &SolutionError) {
    let percent = |x: f64| 100.0 * x;
    print_line(format_args!(
        "relative RMS error {:.4} %, bias {:+.4} %",
        percent(error.relative_rms),
        percent(error.bias)
    ));
    print_line(format_args!(
        "noise of the reference: {:.4} % of RMS error, {:.4} % of bias; {} faces, mean reflected radiosity {:.6} W/m2",
        percent(error.noise),
        percent(error.bias_noise),
        error.faces.len(),
        error.mean
    ));
    print_line(format_args!(
        "{:>8} {:>5} {:>12} {:>12} {:>12} {:>10} {:>9}",
        "face", "side", "area", "solution", "reference", "+-", "of error"
    ));
    for face in error.faces.iter().take(WORST) {
        print_line(format_args!(
            "{:>8} {:>5} {:>12.5e} {:>12.5e} {:>12.5e} {:>10.1e} {:>7.2} %",
            face.face,
            side_name(face.side),
            face.area,
            face.solution,
            face.reference,
            face.standard_error,
            percent(face.share)
        ));
    }
}

fn side_name(side: Side) -> &'static str {
    match side {
        Side::Front => "front",
        Side::Back => "back",
    }
}

/// The first hundred by name: a line that no terminal shows helps nobody.
fn names(faces: &[(u32, Side)]) -> String {
    const SHOWN: usize = 100;
    let mut names: Vec<String> = faces
        .iter()
        .take(SHOWN)
        .map(|&(face, side)| match side {
            Side::Front => face.to_string(),
            Side::Back => format!("{face} (back)"),
        })
        .collect();
    if faces.len() > SHOWN {
        names.push(format!("and {} more", faces.len() - SHOWN));
    }
    names.join(", ")
}

/// What `--json` writes.
#[derive(Serialize)]
struct ErrorFile {
    relative_rms: f64,
    bias: f64,
    noise: f64,
    bias_noise: f64,
    mean: f64,
    missing: Vec<ErrorPlace>,
    faces: Vec<ErrorRecord>,
}

#[derive(Serialize)]
struct ErrorPlace {
    face_index: u32,
    side: u8,
}

#[derive(Serialize)]
struct ErrorRecord {
    face_index: u32,
    side: u8,
    area: f64,
    solution: f64,
    reference: f64,
    stderr: f64,
    share: f64,
}

impl ErrorFile {
    fn new(error: &SolutionError) -> Self {
        Self {
            relative_rms: error.relative_rms,
            bias: error.bias,
            noise: error.noise,
            bias_noise: error.bias_noise,
            mean: error.mean,
            missing: (error.missing.iter())
                .map(|&(face_index, side)| ErrorPlace {
                    face_index,
                    side: u8::from(side == Side::Back),
                })
                .collect(),
            faces: error.faces.iter().map(ErrorRecord::new).collect(),
        }
    }
}

impl ErrorRecord {
    fn new(face: &FaceError) -> Self {
        Self {
            face_index: face.face,
            side: u8::from(face.side == Side::Back),
            area: face.area,
            solution: face.solution,
            reference: face.reference,
            stderr: face.standard_error,
            share: face.share,
        }
    }
}
