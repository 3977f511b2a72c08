//! Where material libraries and textures are looked for: beside the OBJ file, or in memory.

use std::io;
use std::path::{Path, PathBuf};

/// The files that an OBJ file may name.
#[derive(Clone, Copy)]
pub(super) enum Assets<'a> {
    /// A folder of the file system.
    Folder(&'a Path),
    /// Pairs of name and content.
    Memory(&'a [(&'a str, &'a [u8])]),
}

impl Assets<'_> {
    /// The content of the file called `name`, and what to call it in messages. Names written on
    /// Windows, or with the folders of the author's machine, are tried in simpler forms too.
    ///
    /// # Errors
    /// What reading the first form that exists gives, or that nothing was found.
    pub fn read(&self, name: &str) -> io::Result<(String, Vec<u8>)> {
        let mut failure = io::Error::from(io::ErrorKind::NotFound);
        for form in forms(name) {
            match self.read_exactly(&form) {
                Ok(found) => return Ok(found),
                Err(e) if e.kind() == io::ErrorKind::NotFound => {}
                Err(e) => failure = e,
            }
        }
        Err(failure)
    }

    fn read_exactly(&self, name: &str) -> io::Result<(String, Vec<u8>)> {
        match self {
            Self::Folder(folder) => {
                let path: PathBuf = folder.join(name);
                let found = std::fs::metadata(&path)?;
                // A pipe or a device may never end; a folder is refused by reading it.
                if !found.is_file() && !found.is_dir() {
                    return Err(io::Error::other("is a pipe or a device"));
                }
                let bytes = std::fs::read(&path)?;
                Ok((path.display().to_string(), bytes))
            }
            Self::Memory(files) => files
                .iter()
                .find(|(n, _)| *n == name)
                .map(|&(n, bytes)| (n.to_owned(), bytes.to_vec()))
                .ok_or_else(|| io::ErrorKind::NotFound.into()),
        }
    }
}

/// The file that `name` stands for in `folder`, if one of its forms exists.
pub(super) fn existing_file(folder: &Path, name: &str) -> Option<PathBuf> {
    let paths = forms(name).into_iter().map(|form| folder.join(form));
    paths.into_iter().find(|path| path.is_file())
}

/// As written; with slashes; the last part alone.
fn forms(name: &str) -> Vec<String> {
    let slashes = name.replace('\\', "/");
    let last = slashes.rsplit('/').next().unwrap_or_default().to_owned();
    let mut forms = vec![name.to_owned()];
    for form in [slashes, last] {
        if !form.is_empty() && !forms.contains(&form) {
            forms.push(form);
        }
    }
    forms
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_paths_are_found_beside_the_file() {
        let files: [(&str, &[u8]); 2] = [("maps/a.png", b"1"), ("b.png", b"2")];
        let assets = Assets::Memory(&files);
        assert_eq!(assets.read("maps\\a.png").unwrap().1, b"1");
        assert_eq!(assets.read("C:\\work\\b.png").unwrap().1, b"2");
        assert_eq!(
            assets.read("c.png").unwrap_err().kind(),
            io::ErrorKind::NotFound
        );
    }
}
