//! The files that an OBJ file names: its material libraries, and the textures that those name.

use super::assets::existing_file;
use super::statement::for_each_statement;
use super::texture_map::TextureMap;
use std::path::{Path, PathBuf};

/// Those of the files that are there; none where the OBJ file cannot be read, which loading it reports.
pub fn named_files(obj: &Path) -> Vec<PathBuf> {
    let folder = obj.parent().unwrap_or_else(|| Path::new(""));
    let mut libraries: Vec<PathBuf> = Vec::new();
    each_statement_of(obj, |keyword, name| {
        if keyword == b"mtllib" {
            // One name with spaces, or several names.
            let whole = std::iter::once(name);
            let names = whole.chain(name.split_ascii_whitespace());
            libraries.extend(names.filter_map(|name| existing_file(folder, name)));
        }
    });
    libraries.sort();
    libraries.dedup();
    let mut textures = Vec::new();
    for library in &libraries {
        textures.extend(textures_of(library, folder));
    }
    libraries.extend(textures);
    libraries
}

fn textures_of(library: &Path, folder: &Path) -> Vec<PathBuf> {
    let mut textures = Vec::new();
    let Some(bytes) = read(library) else {
        return textures;
    };
    for_each_statement(&bytes, |statement| {
        if [b"map_Kd".as_slice(), b"map_Ke"].contains(&statement.keyword)
            && let Ok((map, _)) = TextureMap::parse(statement)
        {
            textures.extend(existing_file(folder, &map.file));
        }
    });
    textures
}

fn each_statement_of(path: &Path, mut each: impl FnMut(&[u8], &str)) {
    if let Some(bytes) = read(path) {
        for_each_statement(&bytes, |statement| {
            each(statement.keyword, &statement.name());
        });
    }
}

/// The bytes of a regular file: a pipe may never end, and may be read once only.
fn read(path: &Path) -> Option<Vec<u8>> {
    let is_file = std::fs::metadata(path).is_ok_and(|found| found.is_file());
    is_file.then(|| std::fs::read(path).ok()).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn libraries_and_their_textures_are_found() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        for (name, text) in [
            (
                "a.obj",
                "mtllib b.mtl c d.mtl\nmtllib missing.mtl\nv 0 0 0\nmtllib c d.mtl\n",
            ),
            (
                "b.mtl",
                "newmtl x\nmap_Kd -s 2 2 C:\\work\\wall one.png\nmap_Ke missing.png\nmap_Ks gloss.png\n",
            ),
            ("c d.mtl", "newmtl y\nmap_Ke lamp.png\n"),
            ("wall one.png", ""),
            ("lamp.png", ""),
            ("gloss.png", ""),
        ] {
            std::fs::write(path(name), text).unwrap();
        }
        let mut found = named_files(&path("a.obj"));
        found.sort();
        let want = ["b.mtl", "c d.mtl", "lamp.png", "wall one.png"].map(path);
        assert_eq!(found, want);
        assert!(named_files(&path("none.obj")).is_empty());
    }
}
