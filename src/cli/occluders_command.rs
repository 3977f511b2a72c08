//! `certilux occluders`: the extracted rectangles as a mesh (paper, Figs. 3 and 4).

use super::args::OccludersCommand;
use super::error::CliError;
use super::file_plan::FilePlan;
use super::render::check_mesh_name;
use super::scene_source::{load_scene, prepare};
use super::session::Session;
use crate::occluder::extract_occluders;
use crate::output::{OccluderSummary, write_json, write_occluders};
use crate::solve::SolveConfig;
use std::time::Instant;

/// Extracts the occluders and writes them.
pub fn run(session: &Session, command: &OccludersCommand) -> Result<(), CliError> {
    check_mesh_name(&command.out, "obj")?;
    FilePlan::default()
        .scene("SCENE", &command.scene.scene)
        .writes("--out", [&command.out])
        .writes("--json", &command.json)
        .check()?;
    let scene = load_scene(&command.scene)?;
    let config = command.occluders.config();
    let prepared = prepare(scene, &command.scene.reading, SolveConfig::default().seed)?;
    let start = Instant::now();
    let set = extract_occluders(&prepared.scene, &prepared.hierarchy, &config);
    let seconds = start.elapsed().as_secs_f64();
    write_occluders(&command.out, &prepared.scene, &set, &session.interrupted)?;
    let summary = OccluderSummary::new(&prepared.scene, &set, config);
    if let Some(path) = &command.json {
        write_json(path, &summary, &session.interrupted)?;
    }
    session.say(format_args!(
        "wrote {}: {} occluders of {} flat clusters, {:.1} % of whose area they cover, and {} solids; extracted in {seconds:.3} s",
        command.out.display(),
        summary.occluders,
        summary.flat_clusters,
        100.0 * summary.covered_share,
        summary.solids,
    ));
    Ok(())
}
