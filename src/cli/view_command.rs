//! `certilux view`: a picture of a solved folder from any place.

use super::args::ViewCommand;
use super::error::CliError;
use super::render::{PictureFormat, render, write_picture};
use super::session::Session;
use crate::output::{Camera, Shading, View, ViewConfig, read_ply};
use glam::DVec3;

/// Renders DIR/solution.ply.
pub fn run(session: &Session, command: &ViewCommand) -> Result<(), CliError> {
    // A name that no picture can have is better known before the work than after.
    PictureFormat::of(&command.out)?;
    let mesh = read_ply(&command.solved.join("solution.ply")).map_err(CliError::Solution)?;
    let config = ViewConfig {
        shading: if command.flat {
            Shading::Flat
        } else {
            Shading::Smooth
        },
        ..ViewConfig::default()
    };
    let picture = render(
        &mesh,
        |view| camera(view, command),
        &config,
        &session.interrupted,
    )?;
    write_picture(
        &command.out,
        &picture,
        command.exposure,
        &session.interrupted,
    )?;
    session.say(format_args!("wrote {}", command.out.display()));
    Ok(())
}

/// The automatic camera with whatever was asked for put in its place.
fn camera(view: &View, command: &ViewCommand) -> Camera {
    let automatic = view.automatic_camera(command.size.0);
    Camera {
        eye: command.eye.map_or(automatic.eye, DVec3::from),
        target: command.target.map_or(automatic.target, DVec3::from),
        up: command.up.map_or(automatic.up, DVec3::from),
        fov: command.fov.unwrap_or(automatic.fov),
        size: command.size.0,
    }
}
