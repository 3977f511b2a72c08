//! Flags of every command that reads a scene or solves one.

use crate::scene::{LoadConfig, SidesMode};
use crate::solve::{ConfigError, Normalise, SolveConfig, Stop, Technique};
use clap::{Args, ValueEnum};

/// The scene and how to read it.
#[derive(Clone, Debug, Args)]
pub struct SceneArgs {
    /// An OBJ file, or builtin:NAME (certilux generate --list).
    #[arg(value_name = "SCENE")]
    pub scene: String,
    /// Bring reflectances of 1 and more down to just below 1 instead of refusing the scene.
    #[arg(long)]
    pub clamp_reflectance: bool,
    /// Which sides of a surface receive and reflect light.
    #[arg(long, value_enum, default_value_t = SidesArg::Auto)]
    pub sides: SidesArg,
    /// Threads; 0 is one a processor. Results do not depend on it.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_threads)]
    pub threads: usize,
}

/// Most threads: more than any machine of today runs at once, few enough that their stacks can be reserved.
const MAX_THREADS: usize = 1024;

fn parse_threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(n) if n <= MAX_THREADS => Ok(n),
        _ => Err(format!("a whole number from 0 to {MAX_THREADS} is needed")),
    }
}

impl SceneArgs {
    /// How to load.
    pub fn load_config(&self) -> LoadConfig {
        LoadConfig {
            clamp_reflectance: self.clamp_reflectance,
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
    /// Everything sees everything: measures what visibility costs.
    Unoccluded,
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

/// How to solve.
#[derive(Clone, Debug, Args)]
pub struct SolveArgs {
    /// How visibility is decided.
    #[arg(long, value_enum, default_value_t = TechniqueArg::Normal)]
    pub technique: TechniqueArg,
    /// Refine until an exchange carries less than this fraction of the emitted power.
    #[arg(long, value_name = "X", default_value_t = SolveConfig::default().epsilon, allow_negative_numbers = true)]
    pub epsilon: f64,
    /// Refine a receiver until an exchange leaves less than this fraction of the mean irradiance unresolved on it.
    #[arg(long, value_name = "X", default_value_t = SolveConfig::default().gradient, allow_negative_numbers = true)]
    pub gradient: f64,
    /// Visibility samples of an exchange; multiples of 8 are cheapest.
    #[arg(long, value_name = "N", default_value_t = SolveConfig::default().rays, allow_negative_numbers = true)]
    pub rays: u32,
    /// Stop after N passes: 1 is direct light, 2 adds the first reflection.
    #[arg(long, value_name = "N", conflicts_with = "converge")]
    pub passes: Option<u32>,
    /// Stop when the unshot power is below this fraction of the emitted [default: 1e-3].
    #[arg(long, value_name = "X", allow_negative_numbers = true)]
    pub converge: Option<f64>,
    /// Smallest patch, a fraction of the scene's area (one side of each surface).
    #[arg(long, value_name = "X", default_value_t = SolveConfig::default().min_area, allow_negative_numbers = true)]
    pub min_area: f64,
    /// Seed of the sample points.
    #[arg(long, value_name = "S", default_value_t = SolveConfig::default().seed)]
    pub seed: u64,
    /// Scale each pass so that all that is shot arrives.
    #[arg(long, value_enum, default_value_t = NormaliseArg::Auto)]
    pub normalise: NormaliseArg,
}

impl SolveArgs {
    /// The validated configuration.
    ///
    /// # Errors
    /// A setting out of range, named by its flag.
    pub fn config(&self) -> Result<SolveConfig, ConfigError> {
        let default = SolveConfig::default();
        let config = SolveConfig {
            technique: match self.technique {
                TechniqueArg::Normal => Technique::Normal,
                TechniqueArg::Unoccluded => Technique::Unoccluded,
            },
            epsilon: self.epsilon,
            gradient: self.gradient,
            rays: self.rays,
            stop: match (self.passes, self.converge) {
                (Some(n), _) => Stop::Passes(n),
                (None, Some(x)) => Stop::Converged(x),
                (None, None) => default.stop,
            },
            min_area: self.min_area,
            seed: self.seed,
            normalise: match self.normalise {
                NormaliseArg::Auto => Normalise::Auto,
                NormaliseArg::On => Normalise::On,
                NormaliseArg::Off => Normalise::Off,
            },
        };
        config.validate()?;
        Ok(config)
    }
}
