//! What is said on standard error besides progress: as sentences, or with `--json-logs` as one JSON object a line.

use std::fmt;
use std::sync::OnceLock;
use tracing_subscriber::EnvFilter;

/// Set once, before anything is said; unset means sentences.
static AS_JSON: OnceLock<bool> = OnceLock::new();

/// What is logged as JSON unless `RUST_LOG` says otherwise.
const DEFAULT_FILTER: &str = "info";

/// `RUST_LOG` cannot be understood.
#[derive(Debug, thiserror::Error)]
#[error("RUST_LOG={text}: {reason}")]
pub struct BadFilter {
    text: String,
    reason: String,
}

/// Starts logging: as JSON if asked for, else as text where `RUST_LOG` asks for anything.
pub fn install(as_json: bool) -> Result<(), BadFilter> {
    let filter = match std::env::var("RUST_LOG") {
        Ok(text) if !text.trim().is_empty() => {
            EnvFilter::try_new(&text).map_err(|e| BadFilter {
                reason: e.to_string(),
                text,
            })?
        }
        _ if as_json => EnvFilter::new(DEFAULT_FILTER),
        _ => return Ok(()),
    };
    let lines = tracing_subscriber::fmt()
        .with_writer(std::io::stderr)
        .with_env_filter(filter);
    let installed = match as_json {
        true => lines.json().flatten_event(true).try_init().is_ok(),
        false => lines.with_ansi(false).try_init().is_ok(),
    };
    // A library user's own subscriber, or a second call, stays in force.
    if installed {
        AS_JSON.get_or_init(|| as_json);
    }
    Ok(())
}

/// True where lines of JSON are asked for.
pub fn as_json() -> bool {
    AS_JSON.get().copied().unwrap_or(false)
}

/// Something the user should know, though the work goes on.
pub fn warn(text: fmt::Arguments<'_>) {
    match as_json() {
        true => tracing::warn!("{text}"),
        false => eprintln!("certilux: warning: {text}"),
    }
}

/// Why the work ends.
pub fn error(text: fmt::Arguments<'_>, exit_code: u8) {
    match as_json() {
        true => tracing::error!(exit_code, "{text}"),
        false => eprintln!("certilux: {text}"),
    }
}

/// Something that is neither, such as what is being done.
pub fn note(text: fmt::Arguments<'_>) {
    match as_json() {
        true => tracing::info!("{text}"),
        false => eprintln!("certilux: {text}"),
    }
}
