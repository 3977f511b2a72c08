//! Where a scene comes from: an OBJ file, or `builtin:NAME`.

use super::error::CliError;
use super::logs;
use super::solve_args::{ReadingArgs, SceneArgs};
use crate::embree::{DeviceConfig, EmbreeError};
use crate::scene::generate::generate;
use crate::scene::{LoadConfig, Scene, load_file, load_text};
use crate::solve::PreparedScene;
use std::ffi::OsStr;
use std::path::Path;

/// What stands before the name of a built-in scene.
const BUILTIN: &str = "builtin:";

/// The OBJ file that `source` names; none of a built-in scene.
pub fn scene_path(source: &OsStr) -> Option<&Path> {
    let is_builtin = source.to_str().is_some_and(|s| s.starts_with(BUILTIN));
    (!is_builtin).then(|| Path::new(source))
}

/// Loads the scene that the command line names, and says what is odd about it.
pub fn load_scene(arguments: &SceneArgs) -> Result<Scene, CliError> {
    load_named(&arguments.scene, &arguments.reading)
}

/// Loads the scene that `source` names, and says what is odd about it.
pub fn load_named(source: &OsStr, reading: &ReadingArgs) -> Result<Scene, CliError> {
    let scene = read_scene(source, &reading.load_config())?;
    for warning in &scene.warnings {
        logs::warn(format_args!("{}", warning.0));
    }
    Ok(scene)
}

/// The scene that `source` names.
pub fn read_scene(source: &OsStr, config: &LoadConfig) -> Result<Scene, CliError> {
    let builtin = source
        .to_str()
        .and_then(|s| Some((s, s.strip_prefix(BUILTIN)?)));
    match builtin {
        None => Ok(load_file(Path::new(source), config)?),
        Some((source, name)) => {
            let scene = generate(name)?;
            let library = format!("{}.mtl", scene.name);
            Ok(load_text(
                source,
                scene.obj.as_bytes(),
                &[(&library, scene.mtl.as_bytes())],
                config,
            )?)
        }
    }
}

/// Builds what every command that looks into a scene needs, on a device as it comes.
pub fn prepare(
    scene: Scene,
    reading: &ReadingArgs,
    seed: u64,
) -> Result<PreparedScene, EmbreeError> {
    PreparedScene::new(scene, reading.sides_mode(), seed, &DeviceConfig::default())
}
