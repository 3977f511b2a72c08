//! What can go wrong while results are written or read back.

use std::io;
use std::path::{Path, PathBuf};

/// A result file could not be written or read. Every message names the file and the reason.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The operating system refused: disk full, no such folder, no permission.
    #[error("cannot {action} {}: {source}", path.display())]
    Io {
        /// What was tried, as a verb.
        action: &'static str,
        /// The file.
        path: PathBuf,
        /// The operating system's reason.
        source: io::Error,
    },
    /// The name stands for a folder, a device or a pipe, which a rename would replace.
    #[error("cannot write {}: it exists and is not a regular file", path.display())]
    NotARegularFile {
        /// The file.
        path: PathBuf,
    },
    /// Asked to stop before the file was complete; nothing is left of it.
    #[error("interrupted while writing {}", path.display())]
    Interrupted {
        /// The file.
        path: PathBuf,
    },
    /// More elements than the format can count.
    #[error("cannot write {}: {count} {what} are more than the format's 2^31 - 1", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Which elements.
        what: &'static str,
        /// How many.
        count: usize,
    },
    /// A number that JSON cannot hold.
    #[error("cannot write {}: the value of \"{key}\" is not a finite number", path.display())]
    NotFinite {
        /// The file.
        path: PathBuf,
        /// Path of the key, from the top.
        key: String,
    },
    /// Not a file that we wrote, or not all of it.
    #[error("{} is not a solution: {reason}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong, with the place.
        reason: String,
    },
    /// Not a reference to compare with, or not all of it.
    #[error("{} is not a reference: {reason}", path.display())]
    NotAReference {
        /// The file.
        path: PathBuf,
        /// What is wrong, with the place.
        reason: String,
    },
    /// Not the rows of an earlier sweep, or of another one.
    #[error("cannot go on from {}: {reason}", path.display())]
    NotASweep {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// An image encoder's complaint that is not the operating system's.
    #[error("cannot encode {}: {reason}", path.display())]
    Encoding {
        /// The file.
        path: PathBuf,
        /// The encoder's words.
        reason: String,
    },
}

impl OutputError {
    /// An error of the operating system while doing `action` to `path`.
    pub(crate) fn io(action: &'static str, path: &Path, source: io::Error) -> Self {
        Self::Io {
            action,
            path: path.to_path_buf(),
            source,
        }
    }

    /// A file that does not hold what it should.
    pub(crate) fn malformed(path: &Path, reason: impl Into<String>) -> Self {
        Self::Malformed {
            path: path.to_path_buf(),
            reason: reason.into(),
        }
    }
}
