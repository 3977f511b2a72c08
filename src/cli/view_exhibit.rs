//! What `certilux view --show` needs beside the solution, and the pictures that it makes of it.

use super::error::CliError;
use super::logs;
use super::ray_counter::count_rays;
use super::scene_source::{prepare, read_scene};
use super::session::{Session, print_line};
use super::solved_scene::SolvedScene;
use super::view_args::{ShowArg, ViewCommand};
use crate::embree::Device;
use crate::occluder::extract_occluders;
use crate::output::{
    ColourScale, Exhibit, Picture, PinHole, Shown, SolvedMesh, Spread, View, errors_of_faces,
    read_ply, read_reference, solved_lights, true_faces,
};
use crate::reference::{SolutionError, solution_error};
use crate::scene::LoadConfig;
use crate::solve::PreparedScene;

/// The mesh to look at, and what is to be shown of it.
pub struct Subject {
    /// The mesh.
    pub mesh: SolvedMesh,
    /// Beside its light.
    pub matter: Matter,
}

/// What is shown beside light.
pub enum Matter {
    /// Nothing.
    Light,
    /// The scene.
    Scene(Box<SolvedScene>),
    /// The comparison with a reference.
    Error(Box<SolutionError>),
    /// Rays per area of each face.
    Rays(Vec<Option<f64>>),
}

impl Subject {
    /// Reads all of it.
    pub fn read(session: &Session, command: &ViewCommand) -> Result<Self, CliError> {
        let path = command.solved.join("solution.ply");
        let mesh = read_ply(&path).map_err(CliError::Solution)?;
        if command.show.needs_scene() {
            let solved = SolvedScene::find(&command.solved, command.scene.as_deref())?;
            if command.show != ShowArg::Rays {
                let matter = Matter::Scene(Box::new(solved));
                return Ok(Self { mesh, matter });
            }
            session.say(format_args!(
                "solving again to count rays; the first time it took {:.1} s",
                solved.seconds
            ));
            let counted = count_rays(session, solved)?;
            if counted.mesh != mesh {
                logs::warn(format_args!(
                    "the solve has not given {} again, bit by bit: another version of the program, of Embree or another processor; \
                     what is shown is the new one",
                    path.display()
                ));
            }
            print_line(format_args!("{} rays through Embree", counted.total));
            return Ok(Self {
                mesh: counted.mesh,
                matter: Matter::Rays(counted.density),
            });
        }
        let matter = match &command.reference {
            None => Matter::Light,
            Some(reference) => {
                let records = read_reference(reference).map_err(CliError::Solution)?.faces;
                let load = LoadConfig {
                    clamp_reflectance: true,
                    ..LoadConfig::default()
                };
                let scene = command.scene.as_ref();
                let scene = scene.map(|source| read_scene(source, &load)).transpose()?;
                let truth = true_faces(&records, scene.as_ref())?;
                Matter::Error(Box::new(solution_error(&truth, &solved_lights(&mesh))?))
            }
        };
        Ok(Self { mesh, matter })
    }
}

/// Makes the picture that `--show` asks for; `picture` is the light, where it is wanted.
pub fn exhibit(
    session: &Session,
    command: &ViewCommand,
    matter: Matter,
    view: &View<'_>,
    camera: &PinHole,
    picture: Option<Picture>,
    device: &Device,
) -> Result<Shown, CliError> {
    let exhibit = Exhibit {
        view,
        camera,
        interrupted: &session.interrupted,
    };
    let light = picture.unwrap_or(Picture {
        size: camera.size(),
        pixels: Vec::new(),
    });
    let tone_map = light.exposure().brighter(command.exposure);
    let coloured = |values: &[Option<f64>], name, unit, spread| {
        let numbers = with_areas(view.mesh(), values);
        let scale = ColourScale::new(name, unit, spread, numbers, command.greatest);
        exhibit.values(values, scale)
    };
    let shown = match (command.show, matter) {
        (_, Matter::Error(error)) => {
            print_line(format_args!(
                "relative RMS error {:.4} %, bias {:+.4} %; faces that the reference does not hold are grey",
                100.0 * error.relative_rms,
                100.0 * error.bias
            ));
            let values = errors_of_faces(view.mesh(), &error);
            coloured(&values, "error", "% of mean", Spread::Signed)
        }
        (_, Matter::Rays(density)) => {
            coloured(&density, "rays per area", "1/m2", Spread::Logarithmic)
        }
        (ShowArg::Clusters, Matter::Scene(solved)) => {
            let prepared = prepare_again(session, *solved)?.1;
            let count = command.clusters as usize;
            let shown = exhibit.clusters(&prepared.scene, &prepared.hierarchy, count);
            shown.map(|(shown, clusters)| {
                print_line(format_args!("{clusters} clusters"));
                shown
            })
        }
        (_, Matter::Scene(solved)) => {
            let (config, prepared) = prepare_again(session, *solved)?;
            let set = session
                .stops_at_once(|| extract_occluders(&prepared.scene, &prepared.hierarchy, &config));
            print_line(format_args!("{} occluders", set.occluders.len()));
            exhibit.occluders(&light, tone_map, &prepared.scene, &set, device)?
        }
        (ShowArg::Mesh, Matter::Light) => exhibit.mesh(&light, tone_map),
        (_, Matter::Light) => Some(exhibit.irradiance(&light, command.greatest)),
    };
    shown.ok_or(CliError::Interrupted)
}

/// The numbers that are known, with the areas of their faces.
fn with_areas<'a>(
    mesh: &'a SolvedMesh,
    values: &'a [Option<f64>],
) -> impl Iterator<Item = (f64, f64)> + 'a {
    (mesh.faces.iter().zip(values)).filter_map(|(face, value)| Some(((*value)?, mesh.area(face))))
}

/// The scene with its hierarchy, and how its occluders are found.
fn prepare_again(
    session: &Session,
    solved: SolvedScene,
) -> Result<(crate::occluder::OccluderConfig, PreparedScene), CliError> {
    let solve = &solved.command.solve;
    let (config, seed) = (solve.occluders.config(), solve.seed);
    let reading = &solved.command.scene.reading;
    let prepared = session.stops_at_once(|| prepare(solved.scene, reading, seed))?;
    Ok((config, prepared))
}
