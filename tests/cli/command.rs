//! Runs the program in a folder of its own.

use serde_json::Value;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// A scratch folder in which the program runs, so that relative paths in it need no prefix.
pub struct Folder {
    root: TempDir,
}

/// How a run ended.
pub struct Outcome {
    /// Exit code; `None` where a signal ended the program.
    pub code: Option<i32>,
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
}

impl Folder {
    pub fn new() -> Self {
        Self {
            root: tempfile::tempdir().unwrap(),
        }
    }

    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.root.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        fs::write(self.path(name), content).unwrap();
    }

    /// A run that has not been started yet; no terminal on any stream.
    pub fn command<S: AsRef<OsStr>>(&self, arguments: &[S]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_certilux"));
        command
            .current_dir(self.root.path())
            .args(arguments)
            // What whoever runs the tests has set for other programs.
            .env_remove("RUST_LOG")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        command
    }

    /// Runs the program to its end.
    pub fn run<S: AsRef<OsStr>>(&self, arguments: &[S]) -> Outcome {
        Outcome::of(self.command(arguments).output().unwrap())
    }

    /// Runs a command line whose arguments hold no spaces.
    pub fn line(&self, line: &str) -> Outcome {
        self.run(&line.split_whitespace().collect::<Vec<_>>())
    }

    /// `stats.json` of a results folder.
    pub fn stats(&self, results: &str) -> Value {
        let text = fs::read_to_string(self.path(results).join("stats.json")).unwrap();
        serde_json::from_str(&text).unwrap()
    }

    /// Names of what a folder holds, ascending; empty where it is not there.
    pub fn names(&self, folder: &str) -> Vec<String> {
        let Ok(entries) = fs::read_dir(self.path(folder)) else {
            return Vec::new();
        };
        let mut names: Vec<_> = entries
            .map(|e| e.unwrap().file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}

impl Outcome {
    pub fn of(output: std::process::Output) -> Self {
        Self {
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).unwrap(),
            stderr: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Asserts the exit code and that nothing panicked; `what` is for the message.
    #[track_caller]
    pub fn ends_with(&self, code: i32, what: &str) -> &Self {
        assert_eq!(
            self.code,
            Some(code),
            "{what}\nstdout: {}\nstderr: {}",
            self.stdout,
            self.stderr
        );
        assert!(!self.stderr.contains("panicked"), "{what}: {}", self.stderr);
        self
    }

    /// Asserts that standard error holds all of `words`.
    #[track_caller]
    pub fn says(&self, words: &[&str]) -> &Self {
        for word in words {
            assert!(
                self.stderr.contains(word),
                "\"{word}\" is not in: {}",
                self.stderr
            );
        }
        self
    }
}

/// A room of 2 x 2 x 2 with one lamp, as OBJ and the text of its `room.mtl`.
pub const ROOM: [&str; 2] = [
    "mtllib room.mtl
v -1 -1 -1
v 1 -1 -1
v 1 1 -1
v -1 1 -1
v -1 -1 1
v 1 -1 1
v 1 1 1
v -1 1 1
v -0.25 -0.25 0.875
v 0.25 -0.25 0.875
v 0.25 0.25 0.875
v -0.25 0.25 0.875
usemtl wall
f 1 2 3 4
f 8 7 6 5
f 1 5 6 2
f 2 6 7 3
f 3 7 8 4
f 4 8 5 1
usemtl lamp
f 12 11 10 9
",
    "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n",
];

/// Writes [`ROOM`] as `room.obj` and `room.mtl`.
pub fn write_room(folder: &Folder) {
    folder.write("room.obj", ROOM[0]);
    folder.write("room.mtl", ROOM[1]);
}

/// Settings under which a small scene solves in a fraction of a second.
pub const COARSE: &str = "--no-view --epsilon 1e-3 --gradient 0.1 --min-area 1e-3";
