//! Ctrl-C: the first asks the work to stop cleanly, the second ends the program at once.

use super::error::CliError;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What a shell reports for a program ended by an interruption: 128 + SIGINT.
const INTERRUPTED: i32 = 130;

/// Installs the handler; the flag rises at the first Ctrl-C or termination signal.
pub fn install() -> Result<Arc<AtomicBool>, CliError> {
    let flag = Arc::new(AtomicBool::new(false));
    let raised = Arc::clone(&flag);
    ctrlc::set_handler(move || {
        if raised.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED);
        }
    })
    .map_err(|e| CliError::System(format!("cannot listen for interruptions: {e}")))?;
    Ok(flag)
}
