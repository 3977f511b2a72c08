//! The arguments of `certilux error-budget`.

use super::solve_args::{SceneArgs, SolveArgs};
use std::path::PathBuf;

/// `certilux error-budget`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Each approximation in turn is made nearly exact, the others left as they are. What goes of the squared error is what the \
                  approximation was worth; shares need not add up to one. The reference's noise is taken off."
)]
pub struct ErrorBudgetCommand {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// What to compare with (certilux reference).
    #[arg(long, value_name = "REF.json")]
    pub reference: PathBuf,
    /// Solves with different seeds, to tell chance from the rest.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u32).range(2..=1000), allow_negative_numbers = true)]
    pub seeds: u32,
    /// The figures for programs.
    #[arg(long, value_name = "FILE.json")]
    pub json: Option<PathBuf>,
    /// How to solve.
    #[command(flatten)]
    pub solve: SolveArgs,
}
