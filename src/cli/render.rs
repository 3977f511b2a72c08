//! A picture of a solved mesh: shared by `solve` and `view`.

use super::error::CliError;
use crate::embree::{Device, DeviceConfig};
use crate::output::{
    Camera, OutputError, Picture, SolvedMesh, View, ViewConfig, write_exr, write_png,
};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Pixels of a picture unless told.
pub const DEFAULT_SIZE: [u32; 2] = [960, 720];

/// Renders with `camera`, or from an automatic place inside the lit space.
pub fn render(
    mesh: &SolvedMesh,
    camera: impl FnOnce(&View) -> Camera,
    config: &ViewConfig,
    interrupted: &AtomicBool,
) -> Result<Picture, CliError> {
    let device = Device::new(&DeviceConfig::default())?;
    let view = View::new(mesh, &device)?;
    let camera = camera(&view).pin_hole()?;
    view.render(&camera, config, interrupted)
        .ok_or(CliError::Interrupted)
}

/// How a picture is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PictureFormat {
    /// All layers.
    Exr,
    /// Tone-mapped.
    Png,
}

impl PictureFormat {
    /// The format that the ending of a name asks for.
    ///
    /// # Errors
    /// [`CliError::Argument`] for any other ending.
    pub fn of(path: &Path) -> Result<Self, CliError> {
        match ending(path).as_deref() {
            Some("exr") => Ok(Self::Exr),
            Some("png") => Ok(Self::Png),
            _ => Err(CliError::Argument(format!(
                "--out {}: a picture's name ends in .exr or .png",
                path.display()
            ))),
        }
    }
}

/// What follows the last dot of a name, in lower case.
fn ending(path: &Path) -> Option<String> {
    path.extension().map(|e| e.to_string_lossy().to_lowercase())
}

/// Refuses a name for a mesh of another format than is written.
///
/// # Errors
/// [`CliError::Argument`] for any other ending than `format`.
pub fn check_mesh_name(path: &Path, format: &str) -> Result<(), CliError> {
    if ending(path).as_deref() == Some(format) {
        return Ok(());
    }
    let article = match format.starts_with('o') {
        true => "an",
        false => "a",
    };
    Err(CliError::Argument(format!(
        "--out {}: {article} {} file is written, whose name ends in .{format}",
        path.display(),
        format.to_uppercase()
    )))
}

/// Writes a picture by the ending of its name; a PNG `stops` brighter than its automatic exposure.
pub fn write_picture(
    path: &Path,
    picture: &Picture,
    stops: f64,
    interrupted: &AtomicBool,
) -> Result<(), CliError> {
    match PictureFormat::of(path)? {
        PictureFormat::Exr => write_exr(path, picture, interrupted)?,
        PictureFormat::Png => {
            let tone_map = picture.exposure().brighter(stops);
            write_png(path, picture, tone_map, interrupted)?;
        }
    }
    Ok(())
}

/// Makes a folder for results.
pub fn make_folder(path: &Path) -> Result<(), OutputError> {
    std::fs::create_dir_all(path).map_err(|e| OutputError::io("make the folder", path, e))
}
