//! `certilux batch` as typed.

use super::byte_size::{ByteSize, parse_byte_size};
use super::solve_args::parse_threads;
use std::path::PathBuf;

/// `certilux batch`
#[derive(Debug, clap::Args)]
#[command(
    after_help = "A job list in TOML; keys are the flags of solve without dashes:\n\n\
                  \x20 [defaults]\n\
                  \x20 epsilon = 1e-5\n\
                  \x20 no-view = true\n\n\
                  \x20 [[job]]                      # one solve\n\
                  \x20 name = \"kitchen\"             # default: the scene's name\n\
                  \x20 scene = \"scenes/kitchen.obj\" # from the folder of the list; also a pattern, a list, builtin:NAME\n\n\
                  \x20 [[job]]                      # 2 x 2 solves of each scene\n\
                  \x20 scene = \"scenes/hall-*.obj\"\n\
                  \x20 [job.grid]\n\
                  \x20 epsilon = [1e-5, 1e-6]\n\
                  \x20 technique = [\"normal\", \"occlusion\"]\n\n\
                  Results go to DIR/NAME, what a job says to DIR/NAME/log.txt, what became of all to DIR/batch.json.\n\
                  Exit code 1 if a job failed."
)]
pub struct BatchCommand {
    /// The job list.
    #[arg(value_name = "JOBS.toml")]
    pub list: PathBuf,
    /// Folder for the folders of the jobs; made if it is not there.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
    /// Skip jobs that are done (same scene, same settings), go on with those that were cut short.
    #[arg(long)]
    pub resume: bool,
    /// Jobs at the same time; 0 is one for every four threads.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_threads, allow_negative_numbers = true)]
    pub jobs: usize,
    /// Threads of all jobs together; 0 is one a processor.
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = parse_threads, allow_negative_numbers = true)]
    pub threads: usize,
    /// Memory of all jobs together, shared equally by those that run at the same time: refuse jobs that are likely to
    /// need more than their share.
    #[arg(long, value_name = "SIZE", value_parser = parse_byte_size)]
    pub max_memory: Option<ByteSize>,
    /// Run only the job of this name, and leave batch.json alone; may be given several times.
    #[arg(long, value_name = "NAME")]
    pub only: Vec<String>,
    /// Print the names of the jobs and run none.
    #[arg(long)]
    pub list_names: bool,
}
