//! The files that a command reads and those that it is to write: told before the work, so that no result takes the
//! place of what was read, or of another result.

use super::error::CliError;
use super::result_paths::check_result_paths;
use super::scene_source::scene_path;
use crate::scene::named_files;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// A file, and the argument that names it.
struct Named {
    argument: String,
    path: PathBuf,
}

impl Named {
    fn new(argument: &str, path: &Path) -> Self {
        Self {
            argument: argument.to_owned(),
            path: path.to_owned(),
        }
    }
}

/// What a command reads and writes.
#[derive(Default)]
pub struct FilePlan {
    scenes: Vec<Named>,
    inputs: Vec<Named>,
    outputs: Vec<Named>,
    /// Files that only a folder was named for: it is made, and looked at, by the command.
    in_folders: Vec<Named>,
}

impl FilePlan {
    /// The scene that `source` names; with what its file names, if it is one.
    pub fn scene(mut self, argument: &str, source: &OsStr) -> Self {
        self.scenes
            .extend(scene_path(source).map(|path| Named::new(argument, path)));
        self
    }

    /// Files that are read.
    pub fn reads<'a>(
        mut self,
        argument: &str,
        paths: impl IntoIterator<Item = &'a PathBuf>,
    ) -> Self {
        let named = paths.into_iter().map(|path| Named::new(argument, path));
        self.inputs.extend(named);
        self
    }

    /// A file that is written, if it is asked for.
    pub fn writes<'a>(
        mut self,
        argument: &str,
        path: impl IntoIterator<Item = &'a PathBuf>,
    ) -> Self {
        let named = path.into_iter().map(|path| Named::new(argument, path));
        self.outputs.extend(named);
        self
    }

    /// Files that are written into a folder, or removed from it.
    pub fn writes_into<S: AsRef<Path>>(
        mut self,
        argument: &str,
        folder: &Path,
        names: impl IntoIterator<Item = S>,
    ) -> Self {
        let named = (names.into_iter()).map(|name| Named::new(argument, &folder.join(name)));
        self.in_folders.extend(named);
        self
    }

    /// Refuses what would destroy a file that is read or another result, and what could not be written.
    ///
    /// # Errors
    /// [`CliError::Argument`] with both arguments; [`CliError::Output`] where a file has no place.
    pub fn check(&self) -> Result<(), CliError> {
        self.check_inputs()?;
        for (at, one) in self.outputs.iter().enumerate() {
            let place = place(&one.path);
            let other = (self.outputs[..at].iter()).find(|other| self::place(&other.path) == place);
            if let Some(other) = other {
                return Err(CliError::Argument(format!(
                    "{} and {} both name {}: one would overwrite the other",
                    other.argument,
                    one.argument,
                    one.path.display()
                )));
            }
        }
        check_result_paths(self.outputs.iter().map(|one| &one.path))?;
        Ok(())
    }

    fn check_inputs(&self) -> Result<(), CliError> {
        let outputs = self.outputs.iter().chain(&self.in_folders);
        // What is not there can be no input.
        let taken: Vec<(&Named, PathBuf)> = outputs
            .filter(|output| output.path.exists())
            .map(|output| (output, place(&output.path)))
            .collect();
        let clash = |input: &Path| {
            let input = place(input);
            let found = taken.iter().find(|(_, path)| *path == input);
            found.map(|(output, _)| *output)
        };
        for input in self.inputs.iter().chain(&self.scenes) {
            if let Some(output) = clash(&input.path) {
                return Err(overwritten(output, &input.argument));
            }
        }
        // Reading a large OBJ file takes time.
        for scene in self.scenes.iter().filter(|_| !taken.is_empty()) {
            if let Some(output) = named_files(&scene.path).iter().find_map(|path| clash(path)) {
                let input = format!("the materials and textures of {}", scene.argument);
                return Err(overwritten(output, &input));
            }
        }
        Ok(())
    }
}

fn overwritten(output: &Named, input: &str) -> CliError {
    CliError::Argument(format!(
        "{} would overwrite {}, which is read ({input})",
        output.argument,
        output.path.display()
    ))
}

/// The one path of what may be called in several ways; of a file that is not there yet, by its folder.
fn place(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| {
        let folder = match path.parent() {
            Some(parent) if parent != Path::new("") => parent,
            _ => Path::new("."),
        };
        match (folder.canonicalize(), path.file_name()) {
            (Ok(folder), Some(name)) => folder.join(name),
            _ => path.to_owned(),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refusal(plan: &FilePlan) -> String {
        match plan.check() {
            Err(CliError::Argument(text)) => text,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn other_names_of_one_file_are_seen_through() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::create_dir(path("sub")).unwrap();
        std::fs::write(path("in.json"), "{}").unwrap();
        let plan = |out: &str| {
            let [input, output] = [path("in.json"), path(out)];
            (FilePlan::default().reads("REF", [&input])).writes("--json", [&output])
        };
        let text = refusal(&plan("sub/../in.json"));
        assert!(text.contains("--json") && text.contains("REF"), "{text}");
        assert!(plan("sub/in.json").check().is_ok());
        let twice = plan("a.csv").writes("--csv", [&path("sub/../a.csv")]);
        let text = refusal(&twice);
        assert!(text.contains("--json") && text.contains("--csv"), "{text}");
        assert!(!path("a.csv").exists());
    }

    #[test]
    fn what_a_scene_names_is_read_too() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        std::fs::write(path("a.obj"), "mtllib a.mtl\n").unwrap();
        std::fs::write(path("a.mtl"), "newmtl x\nmap_Kd view.png\n").unwrap();
        std::fs::write(path("view.png"), "").unwrap();
        let plan = || FilePlan::default().scene("SCENE", path("a.obj").as_os_str());
        for out in ["a.obj", "a.mtl", "view.png"] {
            let text = refusal(&plan().writes("--out", [&path(out)]));
            assert!(text.contains("--out") && text.contains("SCENE"), "{text}");
        }
        let names = ["solution.ply", "view.png"];
        refusal(&plan().writes_into("--out", folder.path(), names));
        let one = plan().writes_into("--out", folder.path(), &names[..1]);
        assert!(one.check().is_ok());
    }
}
