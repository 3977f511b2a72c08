//! Files that a command is to write when its work is done.

use crate::output::OutputError;
use std::io;
use std::path::{Path, PathBuf};

/// Refuses, before the work, what could not be written after it: a file in a folder that is not there, or in the place of
/// a folder.
pub fn check_result_paths<'a>(
    paths: impl IntoIterator<Item = &'a PathBuf>,
) -> Result<(), OutputError> {
    for path in paths {
        let folder = match path.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        let fail = |e: io::Error| OutputError::io("write", path, e);
        if !std::fs::metadata(folder).map_err(fail)?.is_dir() {
            return Err(fail(io::ErrorKind::NotADirectory.into()));
        }
        if path.is_dir() {
            return Err(fail(io::ErrorKind::IsADirectory.into()));
        }
    }
    Ok(())
}
