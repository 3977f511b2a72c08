//! What a solve writes beside `solution.ply` and `stats.json`: pictures, and other forms of the solution.

use super::args::{FormArg, SolveCommand};
use super::checkpointing::FILE_NAME as CHECKPOINT_NAME;
use super::error::CliError;
use super::render::{DEFAULT_SIZE, render, write_picture};
use super::session::Session;
use crate::output::{OutputsBlock, SolvedMesh, Staging, UpAxis, ViewConfig, write_glb, write_vtu};
use clap::ValueEnum;
use std::collections::BTreeMap;

/// All that a solve may write into its folder, or remove from it.
pub const RESULTS: [&str; 7] = [
    "solution.ply",
    "stats.json",
    "view.exr",
    "view.png",
    "solution.glb",
    "solution.vtu",
    CHECKPOINT_NAME,
];
/// The pictures.
const PICTURES: [&str; 2] = ["view.exr", "view.png"];
/// The forms that are written on request.
const FORMS: [(FormArg, &str); 2] = [
    (FormArg::Glb, "solution.glb"),
    (FormArg::Vtu, "solution.vtu"),
];

/// The files that a command asks for, with what they are made with.
pub fn asked_outputs(command: &SolveCommand) -> OutputsBlock {
    let up = |unless_told: &str| {
        let told = command.up.and_then(|axis| axis.to_possible_value());
        let axis = told.map_or_else(|| unless_told.to_owned(), |v| v.get_name().to_owned());
        BTreeMap::from([("up".to_owned(), axis)])
    };
    let mut outputs = OutputsBlock::new();
    if !command.no_view {
        outputs.extend(PICTURES.map(|name| (name.to_owned(), up("auto"))));
    }
    for (form, name) in FORMS {
        if command.format.contains(&form) {
            let options = match form {
                FormArg::Glb => up("y"),
                FormArg::Ply | FormArg::Vtu => BTreeMap::new(),
            };
            outputs.insert(name.to_owned(), options);
        }
    }
    outputs
}

/// The names that a command will write under.
pub fn written_names(command: &SolveCommand) -> Vec<&'static str> {
    let asked = asked_outputs(command);
    let optional = |name: &&str| PICTURES.contains(name) || FORMS.iter().any(|(_, n)| n == name);
    let names = RESULTS.into_iter().filter(|name| *name != CHECKPOINT_NAME);
    names
        .filter(|name| !optional(name) || asked.contains_key(*name))
        .collect()
}

/// Writes those of the files that a command asks for, and that are `wanted`.
pub fn write_outputs(
    session: &Session,
    command: &SolveCommand,
    mesh: &SolvedMesh,
    staging: &mut Staging,
    wanted: impl Fn(&str) -> bool,
) -> Result<(), CliError> {
    for (form, name) in FORMS {
        if !(command.format.contains(&form) && wanted(name)) {
            continue;
        }
        let path = staging.file(name)?;
        match form {
            FormArg::Ply => {}
            FormArg::Glb => {
                let up = command.up.map_or(UpAxis::Y, UpAxis::from);
                write_glb(&path, mesh, up, &session.interrupted)?;
            }
            FormArg::Vtu => write_vtu(&path, mesh, &session.interrupted)?,
        }
    }
    if command.no_view || !PICTURES.iter().any(|name| wanted(name)) {
        return Ok(());
    }
    let picture = render(
        mesh,
        |view| view.automatic_camera(DEFAULT_SIZE, command.up.map(UpAxis::from)),
        &ViewConfig::default(),
        &session.interrupted,
    )?;
    for name in PICTURES.into_iter().filter(|name| wanted(name)) {
        write_picture(&staging.file(name)?, &picture, 0.0, &session.interrupted)?;
    }
    Ok(())
}

/// Removes the files of an earlier solution that this solve was not asked for: they would be of other light.
pub fn remove_other_outputs(command: &SolveCommand) {
    let asked = asked_outputs(command);
    let forms = FORMS.map(|(_, name)| name);
    for name in PICTURES.iter().chain(&forms) {
        if !asked.contains_key(*name) {
            // What cannot be removed is no failure of the solve; most often it is not there.
            let _ = std::fs::remove_file(command.out.join(name));
        }
    }
}
