//! The program with something wrong with it, by the name that its file has: see `bench/planted.sh`.

use certilux::solve::{Regression, plant};
use std::process::ExitCode;

fn main() -> ExitCode {
    let file = std::env::current_exe().unwrap_or_default();
    match file.file_name().and_then(|name| name.to_str()) {
        Some("slow-kernel") => plant(Regression::SlowKernel),
        Some("changed-count") => plant(Regression::ChangedCount),
        _ => {}
    }
    match certilux::cli::run(std::env::args_os()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            error.report();
            ExitCode::from(error.exit_code())
        }
    }
}
