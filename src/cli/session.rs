//! What every command is given beside its own arguments.

use super::error::CliError;
use std::fmt;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

/// The run of the program that a command belongs to.
pub struct Session {
    /// No progress, no summary.
    pub quiet: bool,
    /// The words of the command line, for the records.
    pub words: Vec<String>,
    /// Raised by Ctrl-C.
    pub interrupted: Arc<AtomicBool>,
    /// Up while there is nothing to clean up, so that Ctrl-C may end the program at once.
    pub idle: Arc<AtomicBool>,
}

impl Session {
    /// Does `work` that writes nothing and does not ask whether it is to stop: Ctrl-C ends it at once.
    pub fn stops_at_once<T>(&self, work: impl FnOnce() -> T) -> T {
        self.idle.store(true, Ordering::Relaxed);
        let result = work();
        self.idle.store(false, Ordering::Relaxed);
        result
    }

    /// A line of the summary on standard output; nothing with `--quiet`.
    pub fn say(&self, line: fmt::Arguments<'_>) {
        if !self.quiet {
            print_line(line);
        }
    }
}

/// Why what was printed was not taken, the first time.
static LOST: OnceLock<io::Error> = OnceLock::new();

/// A line of results on standard output, with `--quiet` too; [`check_printed`] tells whether all were taken.
pub fn print_line(line: fmt::Arguments<'_>) {
    print_text(format!("{line}\n").as_bytes());
}

/// Text on standard output.
pub fn print_text(text: &[u8]) {
    let mut out = io::stdout();
    if let Err(error) = out.write_all(text).and_then(|()| out.flush()) {
        // One that is there already was first.
        let _ = LOST.set(error);
    }
}

/// Fails where something was printed and lost, as on a full disk; files are written by then. A reader that left early, such as `head`, had enough.
pub fn check_printed() -> Result<(), CliError> {
    match LOST.get() {
        Some(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(CliError::System(format!(
            "cannot write to standard output: {error}"
        ))),
        _ => Ok(()),
    }
}
