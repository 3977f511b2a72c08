//! What every command is given beside its own arguments.

use std::fmt;
use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// The run of the program that a command belongs to.
pub struct Session {
    /// No progress, no summary.
    pub quiet: bool,
    /// The words of the command line, for the records.
    pub words: Vec<String>,
    /// Raised by Ctrl-C.
    pub interrupted: Arc<AtomicBool>,
}

impl Session {
    /// A line of the summary on standard output; nothing with `--quiet`.
    pub fn say(&self, line: fmt::Arguments<'_>) {
        if !self.quiet {
            print_line(line);
        }
    }
}

/// A line on standard output. A reader that left early, such as `head`, is no failure: the results
/// are in files.
pub fn print_line(line: fmt::Arguments<'_>) {
    let _ = writeln!(std::io::stdout(), "{line}");
}
