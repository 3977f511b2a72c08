//! The scene behind a solved folder, or behind its solution, and the settings that it was solved with.

use super::args::{Cli, Command, SolveCommand};
use super::error::CliError;
use super::scene_source::read_scene;
use crate::output::{HashText, file_hash, scene_hash};
use crate::scene::Scene;
use clap::Parser;
use serde_json::Value;
use std::ffi::{OsStr, OsString};
use std::path::Path;

/// What a folder was solved from.
pub struct SolvedScene {
    /// The scene, whose content is that of the solve.
    pub scene: Scene,
    /// A command that solves it alike.
    pub command: SolveCommand,
    /// Seconds that the solve took.
    pub seconds: f64,
}

impl SolvedScene {
    /// Finds the scene of `folder` by its `stats.json`, or reads `named`; refuses one whose content has changed.
    pub fn find(folder: &Path, named: Option<&OsStr>) -> Result<Self, CliError> {
        let path = folder.join("stats.json");
        let stats: Value = std::fs::read(&path)
            .map_err(|e| {
                CliError::Argument(format!(
                    "cannot read {}: {e}; it is needed to find the scene",
                    path.display()
                ))
            })
            .and_then(|text| {
                serde_json::from_slice(&text)
                    .map_err(|e| CliError::Argument(format!("{} is not JSON: {e}", path.display())))
            })?;
        let missing =
            |key: &str| CliError::Argument(format!("{} has no \"{key}\"", path.display()));
        let source = match named {
            Some(named) => named.to_owned(),
            None => {
                let text = stats["scene"]["path"].as_str();
                OsString::from(text.ok_or_else(|| missing("scene.path"))?)
            }
        };
        let settings = stats["settings"].as_object();
        let settings = settings.ok_or_else(|| missing("settings"))?;
        let command = solve_command(&source, settings).ok_or_else(|| {
            CliError::Argument(format!(
                "{} has settings that this version does not know",
                path.display()
            ))
        })?;
        // A scene that was solved without clamping has nothing to clamp.
        let mut load = command.scene.reading.load_config();
        load.clamp_reflectance = true;
        let scene = read_scene(&source, &load).map_err(|error| match named {
            Some(_) => error,
            None => CliError::Argument(format!(
                "{} was solved from {}, which cannot be read from here ({error}); name it with --scene",
                folder.display(),
                source.to_string_lossy()
            )),
        })?;
        let expected = stats["content"]["scene"].as_str();
        if scene_hash(&scene) != expected.ok_or_else(|| missing("content.scene"))? {
            return Err(CliError::Argument(format!(
                "{} is not the scene that {} was solved from: its content differs",
                source.to_string_lossy(),
                folder.display()
            )));
        }
        Ok(Self {
            command,
            seconds: stats["seconds"]["solve"].as_f64().unwrap_or(0.0),
            scene,
        })
    }
}

/// Hash of the scene of a `solution.ply`; nothing where no `stats.json` beside it is of these bytes.
pub fn scene_of_solution(solution: &Path) -> Option<HashText> {
    let stats = std::fs::read(solution.with_file_name("stats.json")).ok()?;
    let stats: Value = serde_json::from_slice(&stats).ok()?;
    let content = &stats["content"];
    let scene = content["scene"].as_str()?;
    let hash = file_hash(solution).ok()?;
    (content["solution"] == hash).then(|| scene.to_owned())
}

/// The command line that `settings` stand for.
fn solve_command(
    source: &OsStr,
    settings: &serde_json::Map<String, Value>,
) -> Option<SolveCommand> {
    let mut words: Vec<OsString> = ["certilux", "solve", "--out", "."]
        .map(OsString::from)
        .into();
    for (name, value) in settings {
        words.push(OsString::from(format!("--{name}={}", value.as_str()?)));
    }
    words.push("--".into());
    words.push(source.to_owned());
    match Cli::try_parse_from(words).ok()?.command {
        Command::Solve(command) => Some(command),
        _ => None,
    }
}
