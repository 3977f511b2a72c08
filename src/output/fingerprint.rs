//! What a result belongs to: the content of the scene and every setting that affects the light.
//!
//! Names of files and materials are left out, so a scene may be moved; so is the number of threads, on which
//! nothing depends.

use crate::scene::Scene;
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::fs::File;
use std::io;
use std::path::Path;

/// SHA-256 in hexadecimal, lower case.
pub type HashText = String;

/// Scene and settings of a solve.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fingerprint {
    /// Hash of the scene's content.
    pub scene: HashText,
    /// The settings by the names of their flags, with values that read back exactly.
    pub settings: BTreeMap<String, String>,
}

/// The hashes in `stats.json`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct ContentBlock {
    /// Of the scene: [`scene_hash`].
    pub scene: HashText,
    /// Of the settings: [`Fingerprint::settings_hash`].
    pub settings: HashText,
    /// Of the bytes of `solution.ply`.
    pub solution: HashText,
}

impl Fingerprint {
    /// Of a scene and the settings that it is solved with.
    pub fn new(scene: &Scene, settings: BTreeMap<String, String>) -> Self {
        Self {
            scene: scene_hash(scene),
            settings,
        }
    }

    /// Hash of all settings.
    pub fn settings_hash(&self) -> HashText {
        let mut hash = Sha256::new();
        for text in self.settings.iter().flat_map(|(key, value)| [key, value]) {
            hash.update((text.len() as u64).to_le_bytes());
            hash.update(text);
        }
        hex(&hash.finalize())
    }

    /// In what `found` differs from this, for a message; nothing where it is the same.
    pub fn difference(&self, found: &Self) -> Option<String> {
        let mut differences = Vec::new();
        if self.scene != found.scene {
            differences.push("another scene".to_owned());
        }
        let names: std::collections::BTreeSet<&String> =
            self.settings.keys().chain(found.settings.keys()).collect();
        for name in names {
            let [here, there] = [self, found].map(|f| f.settings.get(name));
            if here != there {
                let text = |value: Option<&String>| value.map_or("not set", |v| v).to_owned();
                let (here, there) = (text(here), text(there));
                differences.push(format!("{name} is {there} there and {here} here"));
            }
        }
        (!differences.is_empty()).then(|| differences.join("; "))
    }
}

/// Hash of what a scene consists of: vertices as read, triangles and colours. What is made of them is a matter of settings.
pub fn scene_hash(scene: &Scene) -> HashText {
    let mut hash = Sha256::new();
    let count = |hash: &mut Sha256, n: usize| hash.update((n as u64).to_le_bytes());
    count(&mut hash, scene.source_positions.len());
    for position in &scene.source_positions {
        update_f64(&mut hash, &position.to_array());
    }
    count(&mut hash, scene.polygons.len());
    for polygon in &scene.polygons {
        let [a, b, c] = polygon.vertices;
        for number in [a, b, c, polygon.source_face, polygon.surface] {
            hash.update(number.to_le_bytes());
        }
    }
    count(&mut hash, scene.surfaces.len());
    for surface in &scene.surfaces {
        update_f64(&mut hash, &surface.reflectance);
        update_f64(&mut hash, &surface.emission);
    }
    count(&mut hash, scene.source_faces as usize);
    for face in &scene.dropped_faces {
        hash.update(face.to_le_bytes());
    }
    hex(&hash.finalize())
}

/// Hash of a file's bytes.
///
/// # Errors
/// The system's, where it cannot be read.
pub fn file_hash(path: &Path) -> io::Result<HashText> {
    struct Sink(Sha256);
    impl io::Write for Sink {
        fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
            self.0.update(bytes);
            Ok(bytes.len())
        }
        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }
    let mut sink = Sink(Sha256::new());
    let mut file = io::BufReader::with_capacity(1 << 20, File::open(path)?);
    io::copy(&mut file, &mut sink)?;
    Ok(hex(&sink.0.finalize()))
}

fn update_f64(hash: &mut Sha256, values: &[f64]) {
    for value in values {
        hash.update(value.to_bits().to_le_bytes());
    }
}

fn hex(bytes: &[u8]) -> HashText {
    bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

#[cfg(test)]
mod tests {
    use super::super::fixture;
    use super::*;
    use glam::DVec3;

    fn room() -> Scene {
        fixture::room(DVec3::ZERO, DVec3::ONE, fixture::grey(0.5, 1.0))
    }

    fn settings(pairs: &[(&str, &str)]) -> BTreeMap<String, String> {
        let own = |&(k, v): &(&str, &str)| (k.to_owned(), v.to_owned());
        pairs.iter().map(own).collect()
    }

    #[test]
    fn whatever_changes_a_scene_changes_its_hash_but_not_its_name() {
        let original = scene_hash(&room());
        let mut renamed = room();
        renamed.name.push('x');
        renamed.surfaces[0].material.push('x');
        assert_eq!(scene_hash(&renamed), original);

        let changes: [fn(&mut Scene); 6] = [
            |s| s.source_positions[3].x += f64::EPSILON,
            |s| s.polygons[2].vertices.rotate_left(1),
            |s| s.polygons[2].source_face += 1,
            |s| s.surfaces[0].reflectance[1] = 0.25,
            |s| s.surfaces[0].emission[2] = -0.0,
            |s| s.dropped_faces.push(1),
        ];
        for (k, change) in changes.into_iter().enumerate() {
            let mut other = room();
            other.surfaces[0].emission[2] = 0.0;
            let before = scene_hash(&other);
            change(&mut other);
            assert_ne!(scene_hash(&other), before, "change {k}");
        }
    }

    #[test]
    fn settings_do_not_run_into_each_other() {
        let hash =
            |pairs: &[(&str, &str)]| Fingerprint::new(&room(), settings(pairs)).settings_hash();
        assert_ne!(hash(&[("a", "bc")]), hash(&[("ab", "c")]));
        assert_ne!(hash(&[("a", "b"), ("c", "d")]), hash(&[("a", "bcd")]));
        assert_eq!(
            hash(&[("a", "b"), ("c", "d")]),
            hash(&[("c", "d"), ("a", "b")])
        );
    }

    #[test]
    fn differences_are_named() {
        let here = Fingerprint::new(&room(), settings(&[("epsilon", "1e-5"), ("rays", "8")]));
        assert_eq!(here.difference(&here), None);
        let mut there = here.clone();
        there.settings.insert("epsilon".into(), "1e-4".into());
        there.settings.remove("rays");
        let text = here.difference(&there).unwrap();
        assert_eq!(
            text,
            "epsilon is 1e-4 there and 1e-5 here; rays is not set there and 8 here"
        );
        there.scene.clear();
        assert!(
            here.difference(&there)
                .unwrap()
                .starts_with("another scene; ")
        );
    }
}
