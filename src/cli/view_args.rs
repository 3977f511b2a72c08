//! Flags of `certilux view`.

use super::solve_args::parse_threads;
use super::typed_number::{parse_finite, parse_positive};
use std::ffi::OsString;
use std::path::PathBuf;

/// Clusters that are shown unless told: few enough for their colours to differ.
pub const DEFAULT_CLUSTERS: u32 = 64;

/// `certilux view`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Without --eye and --target the camera chooses a place inside the lit space. Lengths are in the scene's units.\n\n\
                  What --show shows:\n  \
                  radiance    what an eye sees\n  \
                  irradiance  the light that arrives, in false colours\n  \
                  error       how much brighter or darker each face is than in --reference\n  \
                  mesh        the edges of the patches over the picture\n  \
                  clusters    face clusters, a colour each (paper, Fig. 1); needs the scene\n  \
                  occluders   the extracted rectangles over the picture (paper, Figs. 3 and 4); needs the scene\n  \
                  rays        where rays were needed, per area; needs the scene, and solves it again to count them\n\
                  The scale of false colours stands in the picture and on standard output. The scene is found by stats.json, or \
                  named by --scene.\n\n\
                  Examples:\n  certilux view solved --out print.png --gather 256 --size 1920x1440\n  \
                  certilux reference room.obj --out ref.json  &&  certilux view solved --show error --reference ref.json --out error.png"
)]
pub struct ViewCommand {
    /// A folder that `certilux solve` wrote.
    #[arg(value_name = "DIR")]
    pub solved: PathBuf,
    /// The picture: .exr (radiance, irradiance, normals, depth, face ids; --show radiance or irradiance only) or .png.
    #[arg(long, value_name = "FILE")]
    pub out: PathBuf,
    /// How the camera is placed where no --eye or --target says.
    #[arg(long, value_enum, default_value_t = CameraArg::Auto)]
    pub camera: CameraArg,
    /// Where the camera stands.
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub eye: Option<[f64; 3]>,
    /// What it looks at.
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub target: Option<[f64; 3]>,
    /// What is up.
    #[arg(long, value_name = "X,Y,Z", value_parser = parse_vector, allow_hyphen_values = true)]
    pub up: Option<[f64; 3]>,
    /// Vertical angle of view in degrees.
    #[arg(long, value_name = "DEG", value_parser = parse_finite, allow_negative_numbers = true)]
    pub fov: Option<f64>,
    /// Width and height in pixels.
    #[arg(long, value_name = "WxH", value_parser = parse_size, default_value = "960x720")]
    pub size: PictureSize,
    /// Stops brighter (or darker) than the automatic exposure of a PNG.
    #[arg(
        long,
        value_name = "EV",
        default_value_t = 0.0,
        value_parser = parse_finite,
        allow_negative_numbers = true
    )]
    pub exposure: f64,
    /// One value a patch instead of smooth shading.
    #[arg(long)]
    pub flat: bool,
    /// Final gathering with N rays a pixel: irradiance is found anew at every pixel, from the solution around it. 64 is a
    /// look, 256 and more for print.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(..=1 << 16), allow_negative_numbers = true)]
    pub gather: u32,
    /// What to show.
    #[arg(long, value_enum, default_value_t = ShowArg::Radiance)]
    pub show: ShowArg,
    /// The reference that --show error compares with.
    #[arg(long, value_name = "FILE.json")]
    pub reference: Option<PathBuf>,
    /// The scene that DIR was solved from, where stats.json does not lead to it: an OBJ file, or builtin:NAME.
    #[arg(long, value_name = "FILE.obj")]
    pub scene: Option<OsString>,
    /// Clusters of --show clusters: the hierarchy is cut where it has this many nodes.
    #[arg(long, value_name = "N", default_value_t = DEFAULT_CLUSTERS, value_parser = clap::value_parser!(u32).range(1..), allow_negative_numbers = true)]
    pub clusters: u32,
    /// Upper end of the scale of false colours, so that pictures can be compared [default: chosen by what is seen].
    #[arg(long, value_name = "X", value_parser = parse_positive, allow_negative_numbers = true)]
    pub greatest: Option<f64>,
    /// Threads; 0 is one a processor. Pictures do not depend on it.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_threads, allow_negative_numbers = true)]
    pub threads: usize,
}

/// `--show`
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum ShowArg {
    /// What an eye sees.
    Radiance,
    /// The light that arrives, in false colours.
    Irradiance,
    /// How far each face is from a reference.
    Error,
    /// The edges of the patches.
    Mesh,
    /// Face clusters, a colour each.
    Clusters,
    /// The extracted rectangles over the picture.
    Occluders,
    /// Where rays were needed.
    Rays,
}

impl ShowArg {
    /// True where the picture is the solution's light, with or without marks upon it.
    pub fn has_light(self) -> bool {
        matches!(
            self,
            Self::Radiance | Self::Irradiance | Self::Mesh | Self::Occluders
        )
    }

    /// True where the scene is needed and not only its solution.
    pub fn needs_scene(self) -> bool {
        matches!(self, Self::Clusters | Self::Occluders | Self::Rays)
    }
}

/// `--camera`
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum CameraArg {
    /// Inside the lit space, where much of it is seen.
    Auto,
}

/// Width and height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PictureSize(pub [u32; 2]);

/// Greatest width or height: 16 k pictures hold 5 GB of layers.
const GREATEST_SIDE: u32 = 16_384;

fn parse_vector(text: &str) -> Result<[f64; 3], String> {
    let numbers: Vec<f64> = text
        .split(',')
        .map(|t| t.trim().parse::<f64>().map_err(|e| format!("{t:?}: {e}")))
        .collect::<Result<_, _>>()?;
    match numbers[..] {
        [x, y, z] if numbers.iter().all(|n| n.is_finite()) => Ok([x, y, z]),
        _ => Err("three finite numbers with commas between them are needed".to_owned()),
    }
}

fn parse_size(text: &str) -> Result<PictureSize, String> {
    let reason = || format!("a size such as 960x720 is needed, each side 1 to {GREATEST_SIDE}");
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(reason)?;
    let side = |t: &str| match t.parse::<u32>() {
        Ok(n) if (1..=GREATEST_SIDE).contains(&n) => Ok(n),
        _ => Err(reason()),
    };
    Ok(PictureSize([side(width)?, side(height)?]))
}
