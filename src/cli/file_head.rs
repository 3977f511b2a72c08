//! What stands first in the JSON files of the commands that measure.

use super::session::Session;
use serde::Serialize;

/// Who wrote a file, and how.
#[derive(Serialize)]
pub struct FileHead<'a> {
    /// Version of the file's layout.
    format: u32,
    /// Version of this program.
    certilux: &'static str,
    /// Version of the Embree library.
    embree: String,
    /// The command line.
    command: &'a [String],
}

impl<'a> FileHead<'a> {
    /// The first layout, written by the command at hand.
    pub fn new(session: &'a Session, embree: impl ToString) -> Self {
        Self {
            format: 1,
            certilux: env!("CARGO_PKG_VERSION"),
            embree: embree.to_string(),
            command: &session.words,
        }
    }
}
