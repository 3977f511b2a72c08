//! Several files that appear together: written into a folder of their own inside the target, so that what fails
//! late leaves the old set untouched, and moved to their names once all are whole.

use super::OutputError;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// Name of the folder that holds unfinished files; a run that was killed may leave it, the next removes it.
const STAGING_NAME: &str = "unfinished.partial";

/// A set of files on its way.
#[derive(Debug)]
pub struct Staging {
    target: PathBuf,
    folder: PathBuf,
    names: Vec<String>,
}

impl Staging {
    /// A set for the folder `target`, which exists.
    ///
    /// # Errors
    /// [`OutputError::Io`] where no folder can be made in it.
    pub fn new(target: &Path) -> Result<Self, OutputError> {
        let folder = target.join(STAGING_NAME);
        remove(&folder).map_err(|e| OutputError::io("remove", &folder, e))?;
        fs::create_dir(&folder).map_err(|e| OutputError::io("make the folder", &folder, e))?;
        Ok(Self {
            target: target.to_path_buf(),
            folder,
            names: Vec::new(),
        })
    }

    /// Where to write the file that is to be called `name`.
    ///
    /// # Errors
    /// [`OutputError::NotARegularFile`] where the name is taken by something that is not a file.
    pub fn file(&mut self, name: &str) -> Result<PathBuf, OutputError> {
        let path = self.target.join(name);
        if fs::metadata(&path).is_ok_and(|m| !m.is_file()) {
            return Err(OutputError::NotARegularFile { path });
        }
        self.names.push(name.to_owned());
        Ok(self.folder.join(name))
    }

    /// Moves all files to their names, in the order in which they were asked for, and says what they are.
    ///
    /// # Errors
    /// [`OutputError::Io`] with the first that cannot be moved; those before it have their new content.
    pub fn publish(self) -> Result<Vec<PathBuf>, OutputError> {
        let mut files = Vec::with_capacity(self.names.len());
        for name in &self.names {
            let path = self.target.join(name);
            fs::rename(self.folder.join(name), &path)
                .map_err(|e| OutputError::io("rename to", &path, e))?;
            files.push(path);
        }
        Ok(files)
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        // What cannot be removed still carries the name that says it is unfinished.
        let _ = remove(&self.folder);
    }
}

/// Removes a folder with all it holds, or a file; nothing there is no failure.
fn remove(path: &Path) -> io::Result<()> {
    let removed = match fs::symlink_metadata(path) {
        Ok(found) if found.is_dir() => fs::remove_dir_all(path),
        Ok(_) => fs::remove_file(path),
        Err(e) => Err(e),
    };
    match removed {
        Err(e) if e.kind() != io::ErrorKind::NotFound => Err(e),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        let mut names: Vec<_> = entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn files_appear_together_or_not_at_all() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path();
        for name in ["a", "b"] {
            fs::write(target.join(name), "old").unwrap();
        }
        let mut given_up = Staging::new(target).unwrap();
        fs::write(given_up.file("a").unwrap(), "new").unwrap();
        drop(given_up);
        assert_eq!(names(target), ["a", "b"]);
        assert_eq!(fs::read(target.join("a")).unwrap(), b"old");

        let mut set = Staging::new(target).unwrap();
        for name in ["a", "b"] {
            fs::write(set.file(name).unwrap(), "new").unwrap();
            assert_eq!(fs::read(target.join(name)).unwrap(), b"old");
        }
        assert_eq!(set.publish().unwrap(), [target.join("a"), target.join("b")]);
        assert_eq!(names(target), ["a", "b"]);
        assert_eq!(fs::read(target.join("b")).unwrap(), b"new");
    }

    #[test]
    fn what_a_killed_run_left_is_removed() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join(STAGING_NAME)).unwrap();
        fs::write(folder.path().join(STAGING_NAME).join("a"), "half").unwrap();
        let mut set = Staging::new(folder.path()).unwrap();
        fs::write(set.file("b").unwrap(), "whole").unwrap();
        set.publish().unwrap();
        assert_eq!(names(folder.path()), ["b"]);
    }

    #[test]
    fn a_taken_name_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("a")).unwrap();
        let mut set = Staging::new(folder.path()).unwrap();
        assert!(matches!(
            set.file("a"),
            Err(OutputError::NotARegularFile { .. })
        ));
        drop(set);
        assert_eq!(names(folder.path()), ["a"]);
    }
}
