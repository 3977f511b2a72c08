//! The checkpoint of `certilux solve`: kept after passes, taken up with `--resume`, removed with the last file.

use super::error::CliError;
use super::logs;
use crate::output::{CheckpointKey, Fingerprint, read_checkpoint, write_checkpoint};
use crate::solve::{Observer, PassStatistics, PreparedScene, Snapshot, SolveError};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Name of the checkpoint in the folder of results.
pub const FILE_NAME: &str = "solve.checkpoint";

/// How many times as long as the last checkpoint took to write the solve goes on before the next: quick passes would
/// else spend more time on theirs, with a disk that is waited for, than on light.
const WORK_PER_WRITE: u32 = 20;

/// A checkpoint that was written.
#[derive(Clone, Copy)]
struct Written {
    at: Instant,
    took: Duration,
}

/// Passes on what a solve tells, and keeps its state after the first pass, and after those that end long enough after the
/// last checkpoint.
pub struct Checkpointing<'a> {
    watcher: &'a dyn Observer,
    key: CheckpointKey,
    path: PathBuf,
    keep: bool,
    /// A disk that is full is said to be so once.
    complained: AtomicBool,
    passes_made: AtomicUsize,
    last: Mutex<Option<Written>>,
    /// Passes made since the state on disk.
    passes_since: AtomicUsize,
}

impl<'a> Checkpointing<'a> {
    /// For a solve whose results go to `folder`; states are kept if `keep`.
    pub fn new(
        watcher: &'a dyn Observer,
        folder: &Path,
        prepared: &PreparedScene,
        fingerprint: Fingerprint,
        keep: bool,
    ) -> Self {
        Self {
            watcher,
            key: CheckpointKey {
                certilux: env!("CARGO_PKG_VERSION").to_owned(),
                embree: prepared.embree_version.to_string(),
                fingerprint,
            },
            path: folder.join(FILE_NAME),
            keep,
            complained: AtomicBool::new(false),
            passes_made: AtomicUsize::new(0),
            last: Mutex::new(None),
            passes_since: AtomicUsize::new(0),
        }
    }

    /// The state to go on from, if there is one and it is asked for.
    pub fn state(&self, resume: bool) -> Result<Option<Snapshot>, CliError> {
        match resume {
            true => Ok(read_checkpoint(&self.path, &self.key)?),
            false => {
                if self.keep && self.path.exists() {
                    logs::warn(format_args!(
                        "{} of an earlier solve will be replaced; --resume would have gone on from it",
                        self.path.display()
                    ));
                }
                Ok(None)
            }
        }
    }

    /// Passes made by this run of the program.
    pub fn passes_made(&self) -> usize {
        self.passes_made.load(Ordering::Relaxed)
    }

    /// What an interruption is called, now that the state may be on disk.
    pub fn explain(&self, error: SolveError) -> CliError {
        match error {
            SolveError::Interrupted { pass, completed }
                if completed > 0 && self.keep && !self.complained.load(Ordering::Relaxed) =>
            {
                CliError::Suspended {
                    pass,
                    completed: completed - self.passes_since.load(Ordering::Relaxed) as u32,
                    checkpoint: self.path.clone(),
                }
            }
            other => other.into(),
        }
    }

    /// Removes the checkpoint, also one that was only read: the results are there.
    pub fn remove(&self) {
        let unfinished = self.path.with_file_name(format!("{FILE_NAME}.partial"));
        for path in [&self.path, &unfinished] {
            // What cannot be removed is recognised by its content whenever it is met again.
            let _ = std::fs::remove_file(path);
        }
    }
}

impl Observer for Checkpointing<'_> {
    fn pass_started(&self, pass: u32, tasks: usize) {
        self.watcher.pass_started(pass, tasks);
    }

    fn task_done(&self, exchanges: u64) {
        self.watcher.task_done(exchanges);
    }

    fn pass_done(&self, statistics: &PassStatistics, unshot_fraction: f64) {
        self.passes_made.fetch_add(1, Ordering::Relaxed);
        self.watcher.pass_done(statistics, unshot_fraction);
    }

    fn state_reached(&self, take: &dyn Fn() -> Snapshot) {
        if !self.keep {
            return;
        }
        let mut last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        if last.is_some_and(|w| w.at.elapsed() < WORK_PER_WRITE * w.took) {
            self.passes_since.fetch_add(1, Ordering::Relaxed);
            return;
        }
        self.passes_since.store(0, Ordering::Relaxed);
        let begun = Instant::now();
        // A solve of days is not given up because a disk is full.
        if let Err(error) = write_checkpoint(&self.path, &self.key, &take())
            && !self.complained.swap(true, Ordering::Relaxed)
        {
            logs::warn(format_args!(
                "the solve goes on without a checkpoint: {error}"
            ));
        }
        *last = Some(Written {
            at: Instant::now(),
            took: begun.elapsed(),
        });
    }

    fn interrupted(&self) -> bool {
        self.watcher.interrupted()
    }
}

/// True where a solve into `folder` was begun and not ended.
pub fn has_checkpoint(folder: &Path) -> bool {
    let begun = folder.join(FILE_NAME);
    begun.exists() || begun.is_symlink()
}
