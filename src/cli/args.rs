//! The command line as typed.

use super::batch_args::BatchCommand;
use super::byte_size::{ByteSize, parse_byte_size};
use super::error_budget_args::ErrorBudgetCommand;
use super::reference_args::{ErrorCommand, ReferenceCommand};
use super::solve_args::{
    OccluderArgs, ReadingArgs, SceneArgs, SolveArgs, TechniqueArg, parse_threads,
};
use super::sweep_args::SweepCommand;
use super::typed_number::parse_whole;
use super::view_args::ViewCommand;
use crate::experiment::AuditConfig;
use crate::output::UpAxis;
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
    /// No progress and no summary; what a command is to print stays, errors and warnings still go to standard error.
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// Messages on standard error as JSON, one object a line, with every pass; RUST_LOG chooses what (default: info).
    #[arg(long, global = true)]
    pub json_logs: bool,
    /// Ignore certilux.toml and variables such as CERTILUX_EPSILON.
    #[arg(long, global = true)]
    pub no_config: bool,
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve a scene: radiosity on every face, its picture and its numbers.
    Solve(SolveCommand),
    /// Run many solves from a list, side by side; skip what is done, go on with what was cut short.
    Batch(BatchCommand),
    /// Render a solved folder from any place.
    View(ViewCommand),
    /// Measure the radiosity of every face by path tracing, with standard errors.
    Reference(ReferenceCommand),
    /// Compare a solution with a reference: relative RMS error and bias.
    Error(ErrorCommand),
    /// Write a built-in scene as OBJ and MTL.
    Generate(GenerateCommand),
    /// Write the face clusters of a scene in colours, to look at (paper, Fig. 1).
    Clusters(ClustersCommand),
    /// Run a suite of solves; record its counts and times, or check them against a record.
    Bench(BenchCommand),
    /// Techniques side by side: the paper's Table 1.
    Compare(CompareCommand),
    /// Speed against accuracy: solve a scene at many settings, each compared with a reference.
    Sweep(SweepCommand),
    /// Where the error of a solve comes from: each approximation in turn made nearly exact.
    ErrorBudget(ErrorBudgetCommand),
    /// One self-contained page over solves, comparisons and sweeps.
    Report(ReportCommand),
    /// Write the occluders of a scene as a mesh to lay over it (paper, Figs. 3 and 4).
    Occluders(OccludersCommand),
    /// Check the guarantees of a solve: replay its proofs in exact arithmetic, attack them with rays.
    Audit(AuditCommand),
    /// Print the completions of a shell.
    Completions(CompletionsCommand),
    /// Write the manual pages.
    Man(ManCommand),
}

/// `certilux completions`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "bash: certilux completions bash > ~/.local/share/bash-completion/completions/certilux\n\
                  zsh:  certilux completions zsh > DIR/_certilux, with DIR in fpath\n\
                  fish: certilux completions fish > ~/.config/fish/completions/certilux.fish"
)]
pub struct CompletionsCommand {
    /// The shell.
    #[arg(value_name = "SHELL", value_enum)]
    pub shell: clap_complete::Shell,
}

/// `certilux man`
#[derive(Debug, clap::Args)]
#[command(after_help = "To read them:  certilux man --out man1  &&  man -l man1/certilux-solve.1")]
pub struct ManCommand {
    /// Folder for certilux.1 and a page a command; made if it is not there.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}

/// `certilux report`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "A folder may hold what solve, compare (--json) and sweep write: pictures, where energy and time went, rays saved by \
                  each guarantee, Table 1 beside the paper's, plots, warnings, and how to reproduce it all. The page needs no network.\n\n\
                  Example:  certilux solve room.obj --out solved  &&  certilux report solved --out report.html"
)]
pub struct ReportCommand {
    /// Folders with results, a section each.
    #[arg(value_name = "DIR", required = true)]
    pub folders: Vec<PathBuf>,
    /// The page.
    #[arg(long, value_name = "FILE.html")]
    pub out: PathBuf,
}

/// `certilux solve`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Writes into DIR: solution.ply (radiosity and irradiance of every leaf patch), stats.json (counts, times, \
                  where the power went), view.exr and view.png; with --format glb,vtu also solution.glb and solution.vtu. While it works, solve.checkpoint holds the state after a late pass: \
                  the same command with --resume goes on from there, to the same bytes.\n\n\
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
    /// Forms of the solution: solution.ply, which is always written because the other commands read it, and beside it
    /// solution.glb (glTF, for viewers and modelling programs) and solution.vtu (for ParaView).
    #[arg(long, value_name = "FORM", value_enum, value_delimiter = ',', default_values_t = [FormArg::Ply])]
    pub format: Vec<FormArg>,
    /// What is up in the scene. solution.glb is turned so that it is +y, as glTF demands [default there: y]; the pictures
    /// stand upright by it [default there: y or z, by where the lamps shine from].
    #[arg(long, value_name = "AXIS", value_enum)]
    pub up: Option<AxisArg>,
    /// Leave out view.exr and view.png.
    #[arg(long)]
    pub no_view: bool,
    /// Go on from the checkpoint in DIR, if there is one; if DIR holds this very solve already, make only the files that it
    /// lacks, or that were made with another --up. Another finished solve in DIR is refused, not overwritten.
    #[arg(long, conflicts_with = "check_claims")]
    pub resume: bool,
    /// With --resume, solve anew where DIR holds another finished solve: what a batch does whose list has changed.
    #[arg(long, requires = "resume", hide = true)]
    pub renew: bool,
    /// Keep no checkpoint. With one, at most a twentieth of the time goes into it.
    #[arg(long)]
    pub no_checkpoint: bool,
    /// Refuse a solve that is likely to need more memory than SIZE (such as 8G), and stop one that holds more after a pass.
    #[arg(long, value_name = "SIZE", value_parser = parse_byte_size)]
    pub max_memory: Option<ByteSize>,
}

/// `--up`
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum AxisArg {
    /// +x.
    X,
    /// +y.
    Y,
    /// +z.
    Z,
}

impl From<AxisArg> for UpAxis {
    fn from(axis: AxisArg) -> Self {
        match axis {
            AxisArg::X => Self::X,
            AxisArg::Y => Self::Y,
            AxisArg::Z => Self::Z,
        }
    }
}

/// `--format`
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum FormArg {
    /// The numbers of every patch.
    Ply,
    /// glTF 2.0 with colours at the vertices.
    Glb,
    /// VTK's unstructured grid with the numbers of every patch.
    Vtu,
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

/// `certilux clusters`
#[derive(Debug, clap::Args)]
pub struct ClustersCommand {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// The coloured mesh.
    #[arg(long, value_name = "FILE.ply")]
    pub out: PathBuf,
    /// Clusters to show: the hierarchy is cut where it has this many nodes.
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = clap::value_parser!(u32).range(1..), allow_negative_numbers = true)]
    pub count: u32,
}

/// `certilux occluders`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "An occluder is a rectangle that the scene's own surfaces certainly cover: whatever two things it parts \
                  wholly cannot see each other."
)]
pub struct OccludersCommand {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// The rectangles: one object an occluder.
    #[arg(long, value_name = "FILE.obj")]
    pub out: PathBuf,
    /// Counts and areas.
    #[arg(long, value_name = "FILE.json")]
    pub json: Option<PathBuf>,
    /// What occluders are to be like.
    #[command(flatten)]
    pub occluders: OccluderArgs,
}

/// `certilux audit`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "A claim says that two elements cannot see each other, or see each other fully. A ray that contradicts one \
                  counts only if exact arithmetic agrees with the ray. Exit code 1 if a contradiction stands."
)]
pub struct AuditCommand {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// How to solve.
    #[command(flatten)]
    pub solve: SolveArgs,
    /// Claims to audit: a uniform sample of those made, or all.
    #[arg(long, value_name = "N|all", default_value = DEFAULT_CLAIMS, value_parser = parse_claims, allow_negative_numbers = true)]
    pub claims: usize,
    /// Rays cast against each claim: half of them uniform, half aimed at borders.
    #[arg(long, value_name = "N", default_value_t = AuditConfig::default().rays_per_claim, value_parser = clap::value_parser!(u32).range(1..=1 << 20), allow_negative_numbers = true)]
    pub rays_per_claim: u32,
    /// Claims of full visibility to test against every polygon of the scene: the first N of those audited.
    #[arg(long, value_name = "N", default_value_t = AuditConfig::default().brute_force, value_parser = parse_whole::<usize>, allow_negative_numbers = true)]
    pub brute_force: usize,
    /// Also measure, pass by pass, how much of full occlusion and full visibility is detected, each pass
    /// from the state that the technique normal leaves.
    #[arg(long)]
    pub detection: bool,
    /// The report.
    #[arg(long, value_name = "FILE.json")]
    pub json: Option<PathBuf>,
}

/// Claims audited unless told.
const DEFAULT_CLAIMS: &str = "100000";

fn parse_claims(text: &str) -> Result<usize, String> {
    match text {
        "all" => Ok(usize::MAX),
        _ => text
            .parse()
            .ok()
            .filter(|&n| n > 0)
            .ok_or_else(|| "a whole number from 1, or all, is needed".to_owned()),
    }
}

/// `certilux compare`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "The paper's table against Embree:\n  certilux compare builtin:{a,b,c,d,e,f} --markdown table.md --csv table.csv --json table.json\n\n\
                  builtin:a to builtin:f are run at the epsilon, rays and passes of the paper's table unless told otherwise; \
                  other scenes at the defaults of solve, three passes."
)]
pub struct CompareCommand {
    /// OBJ files, or builtin:NAME.
    #[arg(value_name = "SCENE", required = true)]
    pub scenes: Vec<String>,
    /// Techniques to put beside normal (unoccluded is always run: it shows what visibility costs).
    #[arg(long, value_delimiter = ',', value_enum, default_values_t = [TechniqueArg::Visibility, TechniqueArg::Occlusion, TechniqueArg::Blockers])]
    pub techniques: Vec<TechniqueArg>,
    /// Repeats; times are their medians.
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..), allow_negative_numbers = true)]
    pub repeat: u32,
    /// The table for programs.
    #[arg(long, value_name = "FILE.csv")]
    pub csv: Option<PathBuf>,
    /// All repeats, quartiles and settings.
    #[arg(long, value_name = "FILE.json")]
    pub json: Option<PathBuf>,
    /// The table beside the paper's.
    #[arg(long, value_name = "FILE.md")]
    pub markdown: Option<PathBuf>,
    /// How to read them.
    #[command(flatten)]
    pub reading: ReadingArgs,
    /// How to solve.
    #[command(flatten)]
    pub solve: SolveArgs,
}

/// `certilux bench`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Counts have to be the same as in the baseline; times are compared as ratios to normal in the same run, within \
                  what the repeats spread; instructions, which callgrind counts where valgrind is installed, within 3 %. Embree is told to use AVX2, since counts depend on its instruction set."
)]
pub struct BenchCommand {
    /// Which suite: smoke takes a second, ci under a minute, paper is Table 1.
    #[arg(long, value_enum, default_value_t = SuiteArg::Ci)]
    pub suite: SuiteArg,
    /// Write the run as a baseline.
    #[arg(long, value_name = "FILE.json")]
    pub record: Option<PathBuf>,
    /// Compare with a baseline; exit code 1 on a regression.
    #[arg(long, value_name = "FILE.json", conflicts_with = "record")]
    pub check: Option<PathBuf>,
    /// Do not count instructions, though valgrind is there.
    #[arg(long)]
    pub no_instructions: bool,
    /// What to print: bmf is Bencher's metric format.
    #[arg(long, value_enum, default_value_t = BenchFormat::Text)]
    pub format: BenchFormat,
    /// Threads; 0 is one a processor. Counts do not depend on it.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_threads, allow_negative_numbers = true)]
    pub threads: usize,
}

/// `--suite`
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum SuiteArg {
    /// One small scene: does the check itself work?
    Smoke,
    /// Small scenes, for every change.
    Ci,
    /// The paper's Table 1.
    Paper,
}

impl SuiteArg {
    /// The suite's name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Smoke => "smoke",
            Self::Ci => "ci",
            Self::Paper => "paper",
        }
    }
}

/// `--format`
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum BenchFormat {
    /// A line a row.
    Text,
    /// The baseline as JSON.
    Json,
    /// Bencher metric format.
    Bmf,
}
