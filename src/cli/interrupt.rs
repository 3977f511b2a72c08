//! Ctrl-C: the first asks the work to stop cleanly, the second ends the program at once; so does the first while
//! nothing is being written.

use super::error::CliError;
use super::logs;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The two flags between the handler and the work.
pub struct Interrupt {
    /// Rises at the first Ctrl-C or termination signal.
    pub raised: Arc<AtomicBool>,
    /// Raised by the work while there is nothing to clean up.
    pub idle: Arc<AtomicBool>,
}

/// Lets writes beyond a limit on file sizes (`ulimit -f`) fail, so that they are reported and undone. Where the system
/// does not let us, they end the program as before.
#[cfg(unix)]
pub fn survive_size_limits() {
    let noticed = Arc::default();
    if let Err(error) = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, noticed) {
        logs::warn(format_args!(
            "a limit on file sizes would end the program: {error}"
        ));
    }
}

/// Elsewhere there are none.
#[cfg(not(unix))]
pub fn survive_size_limits() {}

/// Installs the handler.
pub fn install() -> Result<Interrupt, CliError> {
    let interrupt = Interrupt {
        raised: Arc::default(),
        idle: Arc::default(),
    };
    let (raised, idle) = (Arc::clone(&interrupt.raised), Arc::clone(&interrupt.idle));
    ctrlc::set_handler(move || {
        let first = !raised.swap(true, Ordering::Relaxed);
        if first && !idle.load(Ordering::Relaxed) {
            return;
        }
        let error = CliError::Interrupted;
        if first {
            error.report();
        }
        std::process::exit(error.exit_code().into());
    })
    .map_err(|e| CliError::System(format!("cannot listen for interruptions: {e}")))?;
    Ok(interrupt)
}
