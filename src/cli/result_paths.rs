//! Places of results, looked at before the work.

use crate::output::OutputError;
use std::fs::{self, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

/// Refuses, before the work, what could not be written after it: a file in a folder that is not there or takes no files,
/// or in the place of a folder or a device.
pub fn check_result_paths<'a>(
    paths: impl IntoIterator<Item = &'a PathBuf>,
) -> Result<(), OutputError> {
    for path in paths {
        let folder = match path.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        let fail = |e: io::Error| OutputError::io("write", path, e);
        if !fs::metadata(folder).map_err(fail)?.is_dir() {
            return Err(fail(io::ErrorKind::NotADirectory.into()));
        }
        if path.is_dir() {
            return Err(fail(io::ErrorKind::IsADirectory.into()));
        }
        check_name(path)?;
        probe(folder).map_err(fail)?;
    }
    Ok(())
}

/// Makes a folder for results and refuses one that takes no files, or in which one of `names` is taken by something that
/// is no file.
pub fn make_result_folder(folder: &Path, names: &[&str]) -> Result<(), OutputError> {
    fs::create_dir_all(folder).map_err(|e| OutputError::io("make the folder", folder, e))?;
    for name in names {
        check_name(&folder.join(name))?;
    }
    probe(folder).map_err(|e| OutputError::io("write into", folder, e))
}

fn check_name(path: &Path) -> Result<(), OutputError> {
    match fs::metadata(path) {
        Ok(found) if !found.is_file() => Err(OutputError::NotARegularFile {
            path: path.to_path_buf(),
        }),
        _ => Ok(()),
    }
}

/// Makes an empty file in `folder` and removes it: whether a user may is more than permissions say.
fn probe(folder: &Path) -> io::Result<()> {
    let path = folder.join(format!("probe-{}.partial", std::process::id()));
    let mut options = OpenOptions::new();
    match options.write(true).create_new(true).open(&path) {
        Ok(_) => fs::remove_file(&path),
        // Another machine's: the folder takes files.
        Err(e) if e.kind() == io::ErrorKind::AlreadyExists => Ok(()),
        Err(e) => Err(e),
    }
}
