//! `certilux report`: one self-contained page over solves, comparisons and sweeps.

use super::args::ReportCommand;
use super::error::CliError;
use super::file_plan::FilePlan;
use super::session::Session;
use crate::output::write_report;
use std::path::{Path, PathBuf};

/// Reads the folders and writes the page.
pub fn run(session: &Session, command: &ReportCommand) -> Result<(), CliError> {
    let results: Vec<PathBuf> = (command.folders.iter()).flat_map(|f| results(f)).collect();
    FilePlan::default()
        .reads("DIR", &results)
        .writes("--out", [&command.out])
        .check()?;
    write_report(&command.out, &command.folders, &session.interrupted)?;
    session.say(format_args!("wrote {}", command.out.display()));
    Ok(())
}

/// All that a folder holds but pages, which an earlier report may have left: what is not read is a result too.
fn results(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let is_page = |path: &PathBuf| {
        let ending = path.extension().unwrap_or_default();
        ending.eq_ignore_ascii_case("html") || ending.eq_ignore_ascii_case("htm")
    };
    let paths = entries.map(|entry| entry.path());
    paths
        .filter(|path| path.is_file() && !is_page(path))
        .collect()
}
