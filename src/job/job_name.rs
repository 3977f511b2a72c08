//! Names of jobs, which are names of folders.

use super::setting::{Setting, SettingValue};
use std::path::Path;

/// What stands before the name of a built-in scene.
const BUILTIN: &str = "builtin:";
/// Longest name in bytes: file systems take 255, and files inside get suffixes.
const LONGEST: usize = 200;
/// Names that the batch itself uses in its folder.
const TAKEN: [&str; 2] = ["batch.json", "batch.json.partial"];

/// What a scene is called where the job has no name: `room` for `scenes/room.obj`, `a` for `builtin:a`.
pub fn scene_name(scene: &str) -> String {
    match scene.strip_prefix(BUILTIN) {
        Some(name) => name.to_owned(),
        None => Path::new(scene)
            .file_stem()
            .map_or_else(String::new, |s| s.to_string_lossy().into_owned()),
    }
}

/// True where a scene is no file.
pub fn is_builtin(scene: &str) -> bool {
    scene.starts_with(BUILTIN)
}

/// `name` with the choices of a grid.
pub fn with_choices(name: &str, choices: &[Setting]) -> String {
    choices.iter().fold(name.to_owned(), |name, choice| {
        let value = match &choice.value {
            SettingValue::On => "true",
            SettingValue::Off => "false",
            SettingValue::Text(text) => text,
        };
        format!("{name}-{}={value}", choice.key)
    })
}

/// Whether a folder may be called so on any system that the results may be copied to.
///
/// # Errors
/// Why not.
pub fn check(name: &str) -> Result<(), String> {
    let bad = |c: char| c.is_control() || "/\\:*?\"<>|".contains(c);
    if name.is_empty() {
        return Err("a job needs a name".to_owned());
    }
    if let Some(c) = name.chars().find(|&c| bad(c)) {
        return Err(format!(
            "the name {name:?} holds {c:?}, which names of folders may not"
        ));
    }
    if name.starts_with(['.', '-']) || name.ends_with(['.', ' ']) {
        return Err(format!(
            "the name {name:?} begins or ends with a dot, a dash or a space"
        ));
    }
    if name.len() > LONGEST {
        return Err(format!("the name {name:?} is longer than {LONGEST} bytes"));
    }
    if TAKEN.contains(&name) {
        return Err(format!("the name {name:?} is that of a file of the batch"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_have_names() {
        assert_eq!(scene_name("builtin:two-rooms"), "two-rooms");
        assert_eq!(scene_name("scenes/a.b/room.v2.obj"), "room.v2");
        assert_eq!(scene_name("room"), "room");
        assert_eq!(scene_name(".."), "");
    }

    #[test]
    fn only_names_of_folders_pass() {
        for name in ["room", "room v2", "a-epsilon=1e-5", "Zürich"] {
            assert_eq!(check(name), Ok(()), "{name}");
        }
        let long = "x".repeat(201);
        for name in [
            "",
            "..",
            ".x",
            "a/b",
            "a\\b",
            "a\nb",
            "a\0",
            "-rf",
            "x.",
            "batch.json",
            &long,
        ] {
            assert!(check(name).is_err(), "{name:?}");
        }
    }
}
