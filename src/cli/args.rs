//! The command line as typed.

use super::solve_args::{SceneArgs, SolveArgs};
use clap::{Parser, Subcommand};
use std::path::PathBuf;

/// The whole command line.
#[derive(Debug, Parser)]
#[command(
    name = "certilux",
    version,
    about = "Batch radiosity: diffuse global illumination of triangle scenes, with proofs of visibility",
    after_help = "Exit codes: 0 done; 1 a check failed; 2 wrong arguments or invalid input; 130 interrupted; 3 anything else.\n\
                  A first solve:  certilux generate cornell --out scenes  &&  certilux solve scenes/cornell.obj --out solved"
)]
pub struct Cli {
    /// No progress and no summary; errors and warnings still go to standard error.
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve a scene: radiosity on every face, its picture and its numbers.
    Solve(SolveCommand),
    /// Write a built-in scene as OBJ and MTL.
    Generate(GenerateCommand),
}

/// `certilux solve`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Writes into DIR: solution.ply (radiosity and irradiance of every leaf patch), stats.json (counts, times, \
                  where the power went), view.exr and view.png.\n\n\
                  Speed against accuracy: --epsilon first, then --rays. --passes 1 is direct light alone."
)]
pub struct SolveCommand {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Folder for the results; made if it is not there.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// How to solve.
    #[command(flatten)]
    pub solve: SolveArgs,
    /// Leave out view.exr and view.png.
    #[arg(long)]
    pub no_view: bool,
}

/// `certilux generate`
#[derive(Debug, clap::Args)]
pub struct GenerateCommand {
    /// Name of the scene; --list shows them all.
    #[arg(value_name = "NAME", required_unless_present = "list")]
    pub name: Option<String>,
    /// Folder for NAME.obj and NAME.mtl.
    #[arg(long, value_name = "DIR", required_unless_present = "list")]
    pub out: Option<PathBuf>,
    /// List the built-in scenes.
    #[arg(long)]
    pub list: bool,
}
