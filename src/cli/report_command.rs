//! `certilux report`: one self-contained page over solves, comparisons and sweeps.

use super::args::ReportCommand;
use super::error::CliError;
use super::session::Session;
use crate::output::write_report;

/// Reads the folders and writes the page.
pub fn run(session: &Session, command: &ReportCommand) -> Result<(), CliError> {
    write_report(&command.out, &command.folders, &session.interrupted)?;
    session.say(format_args!("wrote {}", command.out.display()));
    Ok(())
}
