//! Arguments of `certilux sweep`, and the lists that they stand for.

use super::quality::Quality;
use super::solve_args::{
    NormaliseArg, SceneArgs, TechniqueArg, parse_angle, parse_share, parse_stride,
};
use super::typed_number::{parse_bound, parse_positive, parse_whole};
use crate::experiment::{SweepLists, SweepSettings};
use crate::occluder::OccluderConfig;
use crate::reference::ReferenceConfig;
use crate::solve::{SolveConfig, Stride};
use std::path::PathBuf;

/// `certilux sweep`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Lists are values with commas between them. Technique x epsilon x rays are tried in every combination, the other lists one \
                  value at a time from the centre; --cross combines them all. The centre is the default, or the first value of a list \
                  that lacks the default.\n\n\
                  Writes into DIR: sweep.csv and sweep.json (a row a setting, after every solve), error-seconds and error-rays as .svg and \
                  .png, and reference.json unless --reference names one. Times are medians over --repeat rounds, of which every other \
                  runs backwards; they include what a technique builds, not what all share."
)]
pub struct SweepCommand {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Folder for the results; made if it is not there.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// What to compare with (certilux reference); else it is measured into DIR.
    #[arg(long, value_name = "REF.json")]
    pub reference: Option<PathBuf>,
    /// Standard error asked of a measured reference.
    #[arg(long, value_name = "X", default_value_t = 0.002, value_parser = parse_positive, allow_negative_numbers = true)]
    pub reference_error: f64,
    /// Seconds after which no further round of a measured reference begins [default: 120, with --quick 10].
    #[arg(long, value_name = "S", value_parser = parse_positive, allow_negative_numbers = true)]
    pub reference_seconds: Option<f64>,
    /// A small grid, solved once each.
    #[arg(long)]
    pub quick: bool,
    /// All lists in every combination.
    #[arg(long)]
    pub cross: bool,
    /// Solves of each row [default: 3, with --quick 1].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..), allow_negative_numbers = true)]
    pub repeat: Option<u16>,
    /// Go on from the rows that DIR holds.
    #[arg(long)]
    pub resume: bool,
    /// Techniques.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_enum)]
    pub technique: Vec<TechniqueArg>,
    /// Epsilons.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse_positive, allow_negative_numbers = true)]
    pub epsilon: Vec<f64>,
    /// Rays a sampled exchange.
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        allow_negative_numbers = true
    )]
    pub rays: Vec<u32>,
    /// Levels between queries, or auto.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse_stride, allow_negative_numbers = true)]
    pub stride: Vec<Stride>,
    /// Occluders of a flat cluster at most.
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        value_parser = parse_whole::<usize>,
        allow_negative_numbers = true
    )]
    pub occluders: Vec<usize>,
    /// Areas of the smallest occluder over the squared diagonal of the scene.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse_share, allow_negative_numbers = true)]
    pub occluder_size: Vec<f64>,
    /// Degrees below which a cluster is flat.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse_angle, allow_negative_numbers = true)]
    pub flatness: Vec<f64>,
    /// Shares of the mean irradiance that an exchange may leave unresolved.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse_positive, allow_negative_numbers = true)]
    pub gradient: Vec<f64>,
    /// Smallest patches, fractions of the scene's area.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse_bound, allow_negative_numbers = true)]
    pub min_area: Vec<f64>,
    /// Unshot fractions at which to stop.
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = parse_positive, allow_negative_numbers = true)]
    pub converge: Vec<f64>,
    /// Seed of the sample points of every solve.
    #[arg(long, value_name = "S", default_value_t = SolveConfig::default().seed, value_parser = parse_whole::<u64>, allow_negative_numbers = true)]
    pub seed: u64,
    /// Scale each pass so that all that is shot arrives.
    #[arg(long, value_enum, default_value_t = NormaliseArg::Auto)]
    pub normalise: NormaliseArg,
}

/// Seconds spent on a measured reference: its noise is then below that of the defaults in rooms of a few
/// thousand triangles.
const REFERENCE_SECONDS: [f64; 2] = [120.0, 10.0];
/// Repeats of a row: the fewest that have a median.
const REPEATS: [u16; 2] = [3, 1];

/// Lists that are tried where the command line is silent: a decade about the defaults.
fn usual_lists() -> SweepLists {
    use TechniqueArg::{Blockers, Normal, Occlusion, Visibility};
    SweepLists {
        techniques: [Normal, Visibility, Occlusion, Blockers]
            .map(Into::into)
            .to_vec(),
        epsilons: vec![1.0e-4, 3.0e-5, 1.0e-5, 3.0e-6, 1.0e-6],
        rays: vec![2, 4, 8, 16, 32],
        strides: vec![Stride::Auto, Stride::Every(1), Stride::Every(4)],
        occluders: vec![2, 8, 32],
        occluder_sizes: vec![1.0e-5, 1.0e-4, 1.0e-3],
        flatness: vec![0.1, 1.0, 5.0],
        gradients: vec![1.0e-3, 5.0e-3, 2.0e-2],
        min_areas: vec![1.0e-6, 1.0e-5],
        converge: vec![1.0e-2, 1.0e-3, 1.0e-4],
    }
}

/// The lists of `--quick`.
fn quick_lists() -> SweepLists {
    SweepLists {
        techniques: [TechniqueArg::Normal, TechniqueArg::Occlusion]
            .map(Into::into)
            .to_vec(),
        epsilons: vec![1.0e-4, 1.0e-5],
        rays: vec![4, 8],
        ..SweepLists::default()
    }
}

/// `typed`, or what is usual where nothing was typed.
fn or_usual<T>(typed: &[T], usual: Vec<T>) -> Vec<T>
where
    T: Clone,
{
    match typed {
        [] => usual,
        _ => typed.to_vec(),
    }
}

/// The default where the list holds it or is empty, else the first of the list.
fn centre_of<T: Copy + PartialEq>(list: &[T], default: T) -> T {
    match list.first() {
        Some(&first) if !list.contains(&default) => first,
        _ => default,
    }
}

impl SweepCommand {
    /// Solves of each row.
    pub fn repeats(&self) -> usize {
        let [usual, quick] = REPEATS;
        let default = if self.quick { quick } else { usual };
        usize::from(self.repeat.unwrap_or(default))
    }

    /// How a reference is measured.
    pub fn reference_config(&self) -> ReferenceConfig {
        let [usual, quick] = REFERENCE_SECONDS;
        let default = if self.quick { quick } else { usual };
        ReferenceConfig {
            error: self.reference_error,
            max_seconds: Some(self.reference_seconds.unwrap_or(default)),
            ..ReferenceConfig::default()
        }
    }

    /// What no list says.
    pub fn base(&self) -> SolveConfig {
        SolveConfig {
            seed: self.seed,
            normalise: self.normalise.into(),
            ..SolveConfig::default()
        }
    }

    /// The values to try.
    fn lists(&self) -> SweepLists {
        let usual = match self.quick {
            true => quick_lists(),
            false => usual_lists(),
        };
        let typed = self.technique.iter().map(|&t| t.into());
        SweepLists {
            techniques: or_usual(&typed.collect::<Vec<_>>(), usual.techniques),
            epsilons: or_usual(&self.epsilon, usual.epsilons),
            rays: or_usual(&self.rays, usual.rays),
            strides: or_usual(&self.stride, usual.strides),
            occluders: or_usual(&self.occluders, usual.occluders),
            occluder_sizes: or_usual(&self.occluder_size, usual.occluder_sizes),
            flatness: or_usual(&self.flatness, usual.flatness),
            gradients: or_usual(&self.gradient, usual.gradients),
            min_areas: or_usual(&self.min_area, usual.min_areas),
            converge: or_usual(&self.converge, usual.converge),
        }
    }

    /// The points, the centre first. The presets are among them where neither epsilon nor rays nor anything else
    /// that a preset sets was typed.
    ///
    /// # Errors
    /// Too many of them.
    pub fn points(&self) -> Result<Vec<SweepSettings>, crate::experiment::TooManyPoints> {
        let lists = self.lists();
        let default = SweepSettings::of(&SolveConfig::default(), &OccluderConfig::default());
        let centre = SweepSettings {
            technique: centre_of(&lists.techniques, default.technique),
            epsilon: centre_of(&lists.epsilons, default.epsilon),
            rays: centre_of(&lists.rays, default.rays),
            stride: centre_of(&lists.strides, default.stride),
            occluders: centre_of(&lists.occluders, default.occluders),
            occluder_size: centre_of(&lists.occluder_sizes, default.occluder_size),
            flatness: centre_of(&lists.flatness, default.flatness),
            gradient: centre_of(&lists.gradients, default.gradient),
            min_area: centre_of(&lists.min_areas, default.min_area),
            converge: centre_of(&lists.converge, default.converge),
        };
        let mut points = lists.points(&centre, self.cross)?;
        let free = self.epsilon.is_empty() && self.rays.is_empty() && self.converge.is_empty();
        if free && !self.quick && centre == default {
            for (_, preset) in presets() {
                if !points.contains(&preset) {
                    points.push(preset);
                }
            }
        }
        Ok(points)
    }
}

/// The presets by name.
pub fn presets() -> [(&'static str, SweepSettings); 3] {
    Quality::ALL.map(|quality| {
        let settings = SweepSettings::of(&quality.config(), &OccluderConfig::default());
        (quality.name(), settings)
    })
}
