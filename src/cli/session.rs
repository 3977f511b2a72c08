//! What every command is given beside its own arguments.

use std::fmt;
use std::io::Write;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

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

/// A line on standard output. A reader that left early, such as `head`, is no failure: the results
/// are in files.
pub fn print_line(line: fmt::Arguments<'_>) {
    let _ = writeln!(std::io::stdout(), "{line}");
}
