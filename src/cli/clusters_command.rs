//! `certilux clusters`: face clusters in colours (paper, Fig. 1).

use super::args::ClustersCommand;
use super::error::CliError;
use super::file_plan::FilePlan;
use super::render::check_mesh_name;
use super::scene_source::{load_scene, prepare};
use super::session::Session;
use crate::output::write_cluster_ply;
use crate::solve::SolveConfig;

/// Writes the clusters where the hierarchy is cut at `--count` nodes.
pub fn run(session: &Session, command: &ClustersCommand) -> Result<(), CliError> {
    check_mesh_name(&command.out, "ply")?;
    FilePlan::default()
        .scene("SCENE", &command.scene.scene)
        .writes("--out", [&command.out])
        .check()?;
    let scene = load_scene(&command.scene)?;
    let prepared = prepare(scene, &command.scene.reading, SolveConfig::default().seed)?;
    let shown = write_cluster_ply(
        &command.out,
        &prepared.scene,
        &prepared.hierarchy,
        command.count as usize,
        &session.interrupted,
    )?;
    session.say(format_args!(
        "wrote {}: {shown} clusters",
        command.out.display()
    ));
    Ok(())
}
