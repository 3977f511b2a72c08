//! Flags of every command that reads a scene or solves one.

use super::quality::Quality;
use super::typed_number::parse_whole;
use crate::occluder::OccluderConfig;
use crate::scene::{Axes, LoadConfig, SidesMode};
use crate::solve::{ConfigError, Normalise, SolveConfig, Stop, Stride, Technique};
use clap::{Args, ValueEnum};
use std::ffi::OsString;

/// The scene and how to read it.
#[derive(Clone, Debug, Args)]
pub struct SceneArgs {
    /// An OBJ file, or builtin:NAME (certilux generate --list).
    #[arg(value_name = "SCENE")]
    pub scene: OsString,
    /// How to read it.
    #[command(flatten)]
    pub reading: ReadingArgs,
}

/// How scenes are read.
#[derive(Clone, Debug, Args)]
pub struct ReadingArgs {
    /// Bring reflectances of 1 and more down to just below 1 instead of refusing the scene.
    #[arg(long)]
    pub clamp_reflectance: bool,
    /// Which sides of a surface receive and reflect light.
    #[arg(long, value_enum, default_value_t = SidesArg::Auto)]
    pub sides: SidesArg,
    /// Which axes bounding boxes run along: those of the scene's walls make a building that stands askew as cheap as
    /// any other.
    #[arg(long, value_enum, default_value_t = AxesArg::Scene)]
    pub axes: AxesArg,
    /// Threads; 0 is one a processor. Results do not depend on it.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_threads, allow_negative_numbers = true)]
    pub threads: usize,
}

/// Most threads: more than any machine of today runs at once, few enough that their stacks can be reserved.
const MAX_THREADS: usize = 1024;

pub fn parse_threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n) if n <= MAX_THREADS => Ok(n),
        _ => Err(format!("a whole number from 0 to {MAX_THREADS} is needed")),
    }
}

impl ReadingArgs {
    /// How to load.
    pub fn load_config(&self) -> LoadConfig {
        LoadConfig {
            clamp_reflectance: self.clamp_reflectance,
            axes: self.axes.into(),
        }
    }

    /// Which sides to give the scene.
    pub fn sides_mode(&self) -> SidesMode {
        match self.sides {
            SidesArg::Auto => SidesMode::Auto,
            SidesArg::One => SidesMode::One,
            SidesArg::Two => SidesMode::Two,
        }
    }
}

/// `--axes`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum AxesArg {
    /// Three perpendicular directions that most of the area faces, where they hold a quarter of it.
    Scene,
    /// Those of the file.
    File,
}

impl From<AxesArg> for Axes {
    fn from(axes: AxesArg) -> Self {
        match axes {
            AxesArg::Scene => Self::Scene,
            AxesArg::File => Self::File,
        }
    }
}

/// `--sides`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SidesArg {
    /// Those that light can reach, found by probe rays from the emitters on.
    Auto,
    /// The front, from which the vertices run counter-clockwise.
    One,
    /// Both.
    Two,
}

/// `--technique`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TechniqueArg {
    /// Rays only.
    Normal,
    /// Rays, but none where a shaft is proved empty.
    Visibility,
    /// Nor where one large occluder is proved to cut every segment.
    Occlusion,
    /// As occlusion; and where little is left in a shaft, that little is tested natively, as are single rays against rectangles that blocked those before.
    Blockers,
    /// Everything sees everything: measures what visibility costs.
    Unoccluded,
}

impl From<TechniqueArg> for Technique {
    fn from(technique: TechniqueArg) -> Self {
        match technique {
            TechniqueArg::Normal => Self::Normal,
            TechniqueArg::Visibility => Self::Visibility,
            TechniqueArg::Occlusion => Self::Occlusion,
            TechniqueArg::Blockers => Self::Blockers,
            TechniqueArg::Unoccluded => Self::Unoccluded,
        }
    }
}

/// `--stride`
pub fn parse_stride(text: &str) -> Result<Stride, String> {
    match text {
        "auto" => Ok(Stride::Auto),
        _ => match text.parse() {
            Ok(levels) if levels > 0 => Ok(Stride::Every(levels)),
            _ => Err("a whole number from 1, or auto, is needed".to_owned()),
        },
    }
}

/// What the occluders are to be like.
#[derive(Clone, Debug, Args)]
pub struct OccluderArgs {
    /// Occluders of a flat cluster at most.
    #[arg(long, value_name = "N", default_value_t = OccluderConfig::default().per_cluster, value_parser = parse_whole::<usize>, allow_negative_numbers = true)]
    pub occluders: usize,
    /// Area of the smallest occluder over the squared diagonal of the scene.
    #[arg(long, value_name = "X", default_value_t = OccluderConfig::default().min_area, value_parser = parse_share, allow_negative_numbers = true)]
    pub occluder_size: f64,
    /// A cluster is flat while its deviation makes an angle below this over its width.
    #[arg(long, value_name = "DEG", default_value_t = OccluderConfig::default().flatness_degrees, value_parser = parse_angle, allow_negative_numbers = true)]
    pub flatness: f64,
}

pub fn parse_share(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if x > 0.0 && x.is_finite() => Ok(x),
        _ => Err("a positive finite number is needed".to_owned()),
    }
}

pub fn parse_angle(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(x) if (0.0..=30.0).contains(&x) => Ok(x),
        _ => Err("an angle from 0 to 30 degrees is needed".to_owned()),
    }
}

impl OccluderArgs {
    /// The configuration of the extraction.
    pub fn config(&self) -> OccluderConfig {
        OccluderConfig {
            per_cluster: self.occluders,
            min_area: self.occluder_size,
            flatness_degrees: self.flatness,
            ..OccluderConfig::default()
        }
    }
}

/// `--normalise`
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum NormaliseArg {
    /// In closed scenes with a reflectance of 0.95 or more.
    Auto,
    /// In closed scenes.
    On,
    /// Never.
    Off,
}

impl From<NormaliseArg> for Normalise {
    fn from(normalise: NormaliseArg) -> Self {
        match normalise {
            NormaliseArg::Auto => Self::Auto,
            NormaliseArg::On => Self::On,
            NormaliseArg::Off => Self::Off,
        }
    }
}

/// How to solve.
#[derive(Clone, Debug, Args)]
pub struct SolveArgs {
    /// A preset of --epsilon, --rays and --converge; flags given beside it win [default: normal].
    #[arg(long, value_enum)]
    pub quality: Option<Quality>,
    /// How visibility is decided.
    #[arg(long, value_enum, default_value_t = TechniqueArg::Occlusion)]
    pub technique: TechniqueArg,
    /// Refine until an exchange carries less than this fraction of the emitted power [default: 1e-5].
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub epsilon: Option<f64>,
    /// Refine a receiver until an exchange leaves less than this fraction of the mean irradiance unresolved on it; four times as much from pass 2 on.
    #[arg(long, value_name = "X", default_value_t = SolveConfig::default().gradient, allow_negative_numbers = true)]
    pub gradient: f64,
    /// Visibility samples of an exchange; multiples of 8 are cheapest [default: 8]. Where the first samples decide that a
    /// pair is not refined, one in four such pairs casts as many more to measure it.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub rays: Option<u32>,
    /// Stop after N passes: 1 is direct light, 2 adds the first reflection.
    #[arg(
        long,
        value_name = "N",
        conflicts_with = "converge",
        allow_negative_numbers = true
    )]
    pub passes: Option<u32>,
    /// Stop when the unshot power is below this fraction of the emitted; what further passes would bring is then
    /// added, the last one continued as a geometric series [default: 1e-3].
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub converge: Option<f64>,
    /// Smallest patch, a fraction of the scene's area (one side of each surface).
    #[arg(long, value_name = "X", default_value_t = SolveConfig::default().min_area, allow_negative_numbers = true)]
    pub min_area: f64,
    /// Seed of the sample points.
    #[arg(long, value_name = "S", default_value_t = SolveConfig::default().seed, value_parser = parse_whole::<u64>, allow_negative_numbers = true)]
    pub seed: u64,
    /// Scale each pass so that all that is shot arrives.
    #[arg(long, value_enum, default_value_t = NormaliseArg::Auto)]
    pub normalise: NormaliseArg,
    /// Levels between queries for a guarantee (the paper's is 4), which then also hide pairs part by part, or auto: where they
    /// are likely to pay, and boxes of air.
    #[arg(long, value_name = "K|auto", default_value = DEFAULT_STRIDE, value_parser = parse_stride, allow_negative_numbers = true)]
    pub stride: Stride,
    /// What occluders are to be like.
    #[command(flatten)]
    pub occluders: OccluderArgs,
    /// Debugging: cast the rays of proved exchanges, and those tested natively, all the same; fail if one proves a claim or a test wrong.
    #[arg(long)]
    pub check_claims: bool,
}

/// Levels between queries unless told.
const DEFAULT_STRIDE: &str = "auto";

impl SolveArgs {
    /// The validated configuration.
    ///
    /// # Errors
    /// A setting out of range, named by its flag.
    pub fn config(&self) -> Result<SolveConfig, ConfigError> {
        let default = self.quality.unwrap_or_default().config();
        let config = SolveConfig {
            technique: self.technique.into(),
            epsilon: self.epsilon.unwrap_or(default.epsilon),
            gradient: self.gradient,
            rays: self.rays.unwrap_or(default.rays),
            stop: match (self.passes, self.converge) {
                (Some(n), _) => Stop::Passes(n),
                (None, Some(x)) => Stop::Converged(x),
                (None, None) => default.stop,
            },
            min_area: self.min_area,
            seed: self.seed,
            normalise: self.normalise.into(),
            stride: self.stride,
            check_claims: self.check_claims,
            ..default
        };
        config.validate()?;
        Ok(config)
    }
}
