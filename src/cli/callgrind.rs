//! Instructions of small solves, counted by callgrind where valgrind is installed.

use super::error::CliError;
use super::session::Session;
use crate::experiment::{COMPILER, InstructionCounts};
use std::io::Read;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::Ordering;
use std::time::Duration;

/// A pass over furniture and one over what it reflects, in a second under callgrind.
const SOLVE: [&str; 10] = [
    "solve",
    "builtin:d",
    "--epsilon",
    "1e-3",
    "--passes",
    "2",
    "--threads",
    "1",
    "--no-view",
    "--no-config",
];

/// The techniques that are counted.
const TECHNIQUES: [&str; 3] = ["normal", "occlusion", "blockers"];

/// Between two looks at whether valgrind is done, or the work to be stopped.
const POLL: Duration = Duration::from_millis(50);

/// Counts the instructions of the passes of a small solve by each technique; `None` without valgrind.
pub fn count_instructions(session: &Session) -> Result<Option<InstructionCounts>, CliError> {
    let has_valgrind = Command::new("valgrind")
        .arg("--version")
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|s| s.success());
    if !has_valgrind {
        return Ok(None);
    }
    let program = std::env::current_exe()
        .map_err(|e| CliError::System(format!("cannot find this program's file: {e}")))?;
    let folder = std::env::temp_dir().join(format!("certilux-bench-{}", std::process::id()));
    let mut counts = InstructionCounts {
        compiler: COMPILER.to_owned(),
        solve: SOLVE.join(" "),
        ..InstructionCounts::default()
    };
    for technique in TECHNIQUES {
        let instructions = count(session, &program, &folder, technique);
        let _ = std::fs::remove_dir_all(&folder);
        counts
            .by_technique
            .insert(technique.to_owned(), instructions?);
    }
    Ok(Some(counts))
}

fn count(
    session: &Session,
    program: &Path,
    folder: &Path,
    technique: &str,
) -> Result<u64, CliError> {
    let failed = |e: std::io::Error| CliError::System(format!("cannot run valgrind: {e}"));
    let mut child = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg("--toggle-collect=*run_pass*")
        .arg(program)
        .args(SOLVE)
        .args(["--quiet", "--technique", technique, "--out"])
        .arg(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(failed)?;
    // What it says, a few lines, fits the pipe: it can be read when all is over.
    let status = loop {
        if session.interrupted.load(Ordering::Relaxed) {
            // It may have ended by itself; it is waited for either way.
            let _ = child.kill();
            child.wait().map_err(failed)?;
            return Err(CliError::Interrupted);
        }
        match child.try_wait().map_err(failed)? {
            Some(status) => break status,
            None => std::thread::sleep(POLL),
        }
    };
    let mut said = Vec::new();
    if let Some(mut stderr) = child.stderr.take() {
        stderr.read_to_end(&mut said).map_err(failed)?;
    }
    let said = String::from_utf8_lossy(&said);
    let number = said.lines().find_map(|line| {
        let (_, number) = line.split_once("Collected :")?;
        number.trim().parse::<u64>().ok()
    });
    match number {
        Some(n) if status.success() && n > 0 => Ok(n),
        _ => Err(CliError::System(format!(
            "valgrind counted no instructions of {technique}: {}",
            said.lines().last().unwrap_or("it said nothing")
        ))),
    }
}
