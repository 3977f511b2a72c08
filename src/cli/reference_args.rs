//! Arguments of `certilux reference` and `certilux error`.

use super::solve_args::SceneArgs;
use super::typed_number::{parse_bound, parse_whole};
use crate::reference::ReferenceConfig;
use std::ffi::OsString;
use std::path::PathBuf;

/// `certilux reference`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "REF.json holds one record a face and side: area, radiosity and its standard error. Every estimate is unbiased.\n\
                  The same scene, seed, faces and number of rounds give the same numbers at any number of threads."
)]
pub struct ReferenceCommand {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// The reference.
    #[arg(long, value_name = "REF.json")]
    pub out: PathBuf,
    /// Standard error asked of every face, relative to the greater of its radiosity and 1 % of the area mean.
    #[arg(long, value_name = "X", default_value_t = ReferenceConfig::default().error, allow_negative_numbers = true)]
    pub error: f64,
    /// Begin no round that would end after so many seconds; every face gets one round.
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub max_seconds: Option<f64>,
    /// Measure a sample of N faces.
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub faces: Option<u32>,
    /// Seed of every path.
    #[arg(long, value_name = "S", default_value_t = ReferenceConfig::default().seed, value_parser = parse_whole::<u64>, allow_negative_numbers = true)]
    pub seed: u64,
}

/// `certilux error`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Compared is reflected radiosity, mean of the channels, weighted by area, over the faces of the reference that reflect.\n\
                  Exit code 1 where the relative RMS error is above --max. A scene, or with --max a solution, of other content than the reference's \
                  is refused."
)]
pub struct ErrorCommand {
    /// A folder that `certilux solve` wrote, or its solution.ply.
    #[arg(value_name = "DIR|SOLUTION.ply")]
    pub solution: PathBuf,
    /// A reference.
    #[arg(value_name = "REF.json")]
    pub reference: PathBuf,
    /// The scene, for a reference without Kd_rgb and Ke_rgb: an OBJ file, or builtin:NAME.
    #[arg(long, value_name = "SCENE")]
    pub scene: Option<OsString>,
    /// Greatest relative RMS error that passes, such as 0.02.
    #[arg(long, value_name = "X", value_parser = parse_bound, allow_negative_numbers = true)]
    pub max: Option<f64>,
    /// Write the figures of every face.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}
