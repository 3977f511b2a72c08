//! The command line: errors become exit codes here and nowhere else.

use std::process::ExitCode;

fn main() -> ExitCode {
    match certilux::cli::run(std::env::args_os()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            error.report();
            ExitCode::from(error.exit_code())
        }
    }
}
