//! `certilux view`: a picture of a solved folder from any place.

use super::error::CliError;
use super::file_plan::FilePlan;
use super::logs;
use super::render::{PictureFormat, write_picture};
use super::session::{Session, print_line};
use super::solve_command::with_threads;
use super::view_args::{DEFAULT_CLUSTERS, ShowArg, ViewCommand};
use super::view_exhibit::{Subject, exhibit};
use crate::embree::{Device, DeviceConfig};
use crate::output::{Camera, Picture, PinHole, Shading, UpAxis, View, ViewConfig};
use glam::DVec3;
use indicatif::{ProgressBar, ProgressStyle};

/// Renders DIR/solution.ply.
pub fn run(session: &Session, command: &ViewCommand) -> Result<(), CliError> {
    check(command)?;
    for flag in unused(command)? {
        logs::warn(format_args!("{flag}"));
    }
    let results = ["solution.ply", "stats.json"].map(|name| command.solved.join(name));
    let plan = match &command.scene {
        Some(scene) => FilePlan::default().scene("--scene", scene),
        None => FilePlan::default(),
    };
    plan.reads("DIR", &results)
        .reads("--reference", &command.reference)
        .writes("--out", [&command.out])
        .check()?;
    with_threads(command.threads, || take(session, command))
}

/// What is better known before the work than after.
fn check(command: &ViewCommand) -> Result<(), CliError> {
    let refuse = |reason: String| Err(CliError::Argument(reason));
    let format = PictureFormat::of(&command.out)?;
    let show = command.show;
    let layers = matches!(show, ShowArg::Radiance | ShowArg::Irradiance);
    let name = show_name(show);
    if format == PictureFormat::Exr && !layers {
        return refuse(format!(
            "--show {name} makes a picture for the eye: --out must end in .png"
        ));
    }
    if command.gather > 0 && !show.has_light() {
        return refuse(format!(
            "--show {name} shows no light that --gather could gather"
        ));
    }
    match (show, &command.reference) {
        (ShowArg::Error, None) => refuse(
            "--show error needs --reference FILE.json, which certilux reference makes".to_owned(),
        ),
        (ShowArg::Error, Some(_)) | (_, None) => Ok(()),
        (_, Some(_)) => refuse(format!("--show {name} compares with no --reference")),
    }
}

/// What `--show` is told.
fn show_name(show: ShowArg) -> String {
    let value = clap::ValueEnum::to_possible_value(&show);
    value.map_or_else(String::new, |v| v.get_name().to_owned())
}

/// The flags that change nothing about this picture, with the reason. They are no reason to refuse it: the environment or a
/// file may give them for all pictures.
fn unused(command: &ViewCommand) -> Result<Vec<String>, CliError> {
    let show = command.show;
    let layers = PictureFormat::of(&command.out)? == PictureFormat::Exr;
    let what = match layers {
        true => "an .exr".to_owned(),
        false => format!("--show {}", show_name(show)),
    };
    let has_scale = matches!(show, ShowArg::Irradiance | ShowArg::Error | ShowArg::Rays);
    let has_tones = show.has_light() && !has_scale;
    let flags = [
        (
            command.exposure != 0.0 && (layers || !has_tones),
            "--exposure",
            format!("{what} holds values or colours that no exposure changes"),
        ),
        (
            command.greatest.is_some() && (layers || !has_scale),
            "--greatest",
            format!("{what} has no scale of false colours"),
        ),
        (
            command.flat && !show.has_light(),
            "--flat",
            format!("{what} shows no light that could be shaded"),
        ),
        (
            command.clusters != DEFAULT_CLUSTERS && show != ShowArg::Clusters,
            "--clusters",
            format!("{what} shows no clusters"),
        ),
        (
            command.scene.is_some() && show.has_light() && !show.needs_scene(),
            "--scene",
            format!("{what} needs the solution only"),
        ),
    ];
    Ok(flags
        .into_iter()
        .filter(|(is_unused, ..)| *is_unused)
        .map(|(_, flag, reason)| format!("{flag} is not used: {reason}"))
        .collect())
}

fn take(session: &Session, command: &ViewCommand) -> Result<(), CliError> {
    let subject = Subject::read(session, command)?;
    let device = Device::new(&DeviceConfig::default())?;
    let view = View::new(&subject.mesh, &device)?;
    let camera = camera(&view, command).pin_hole()?;
    let config = ViewConfig {
        shading: if command.flat {
            Shading::Flat
        } else {
            Shading::Smooth
        },
        gather: command.gather,
        ..ViewConfig::default()
    };
    let picture = match command.show.has_light() {
        true => Some(render(session, &view, &camera, &config)?),
        false => None,
    };
    let plain =
        command.show == ShowArg::Radiance || PictureFormat::of(&command.out)? == PictureFormat::Exr;
    match picture.as_ref().filter(|_| plain) {
        Some(picture) => write_picture(
            &command.out,
            picture,
            command.exposure,
            &session.interrupted,
        )?,
        None => {
            let shown = exhibit(
                session,
                command,
                subject.matter,
                &view,
                &camera,
                picture,
                &device,
            )?;
            if let Some(scale) = &shown.scale {
                print_line(format_args!("{}", scale.describe()));
            }
            shown.write_png(&command.out, &session.interrupted)?;
        }
    }
    session.say(format_args!("wrote {}", command.out.display()));
    Ok(())
}

/// Takes the picture, with a bar on a terminal where it may take long.
fn render(
    session: &Session,
    view: &View,
    camera: &PinHole,
    config: &ViewConfig,
) -> Result<Picture, CliError> {
    let bar = match config.gather == 0 || session.quiet || logs::as_json() {
        true => ProgressBar::hidden(),
        // Hidden by itself where standard error is no terminal.
        false => ProgressBar::new(u64::from(camera.size()[1])),
    };
    let style = ProgressStyle::with_template("gathering [{bar:30}] {percent:>3} % left {eta}");
    bar.set_style((style.unwrap_or_else(|_| ProgressStyle::default_bar())).progress_chars("=> "));
    let picture = view.render_watched(camera, config, &session.interrupted, &|| bar.inc(1));
    bar.finish_and_clear();
    picture.ok_or(CliError::Interrupted)
}

/// The automatic camera with whatever was asked for put in its place.
fn camera(view: &View, command: &ViewCommand) -> Camera {
    let given = command.eye.is_some() && command.target.is_some();
    let size = command.size.0;
    // Looking for a place takes seconds in a large scene.
    let automatic = match (given, command.up, command.fov) {
        (true, Some(_), Some(_)) => None,
        _ => Some(view.automatic_camera(size, command.up.map(|up| UpAxis::nearest(up.into())))),
    };
    let or = |given: Option<[f64; 3]>, automatic: Option<DVec3>| {
        (given.map(DVec3::from).or(automatic)).unwrap_or_default()
    };
    Camera {
        eye: or(command.eye, automatic.map(|a| a.eye)),
        target: or(command.target, automatic.map(|a| a.target)),
        up: or(command.up, automatic.map(|a| a.up)),
        fov: (command.fov.or(automatic.map(|a| a.fov))).unwrap_or_default(),
        size,
    }
}
