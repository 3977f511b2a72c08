//! What every command is given beside its own arguments.

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
