//! `batch.json`: what became of each job, for programs; rewritten while the batch runs.

use serde::Serialize;
use std::collections::BTreeMap;

/// The whole file.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct BatchFile {
    /// Version of this layout: [`BatchFile::FORMAT`].
    pub format: u32,
    /// Version of this program.
    pub certilux: String,
    /// The command line.
    pub command: Vec<String>,
    /// Jobs that run at the same time.
    pub jobs_at_once: usize,
    /// Threads of all of them together.
    pub threads: usize,
    /// True once every job has come to its end; false after an interruption.
    pub finished: bool,
    /// Jobs by status.
    pub counts: BatchCounts,
    /// Wall time so far.
    pub seconds: f64,
    /// The jobs in the order of the list.
    pub jobs: Vec<JobRecord>,
}

/// How many jobs have each status.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[non_exhaustive]
pub struct BatchCounts {
    /// All.
    pub total: usize,
    /// See [`JobStatus::Done`].
    pub done: usize,
    /// See [`JobStatus::Skipped`].
    pub skipped: usize,
    /// See [`JobStatus::Failed`].
    pub failed: usize,
    /// See [`JobStatus::Interrupted`].
    pub interrupted: usize,
    /// See [`JobStatus::Running`].
    pub running: usize,
    /// See [`JobStatus::Waiting`].
    pub waiting: usize,
}

/// What became of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum JobStatus {
    /// Not begun.
    Waiting,
    /// Under way.
    Running,
    /// Solved by this run of the batch, from the beginning or from a checkpoint.
    Done,
    /// Its folder held this very solve already.
    Skipped,
    /// It ended with an error.
    Failed,
    /// The batch was stopped while it ran; its checkpoint may be there.
    Interrupted,
}

/// One job.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct JobRecord {
    /// Its name.
    pub name: String,
    /// Its scene.
    pub scene: String,
    /// Folder of its results.
    pub out: String,
    /// What the list sets, by the names of the flags.
    pub settings: BTreeMap<String, String>,
    /// What became of it.
    pub status: JobStatus,
    /// Threads that it was given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub threads: Option<usize>,
    /// Wall time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seconds: Option<f64>,
    /// Exit code of its solve, unless a signal ended it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exit_code: Option<i32>,
    /// The signal that ended it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub signal: Option<i32>,
    /// Why it failed, in its own words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

impl BatchFile {
    /// The layout described here.
    pub const FORMAT: u32 = 1;

    /// Counts the jobs anew.
    pub fn count(&mut self) {
        let count = |status| self.jobs.iter().filter(|j| j.status == status).count();
        self.counts = BatchCounts {
            total: self.jobs.len(),
            done: count(JobStatus::Done),
            skipped: count(JobStatus::Skipped),
            failed: count(JobStatus::Failed),
            interrupted: count(JobStatus::Interrupted),
            running: count(JobStatus::Running),
            waiting: count(JobStatus::Waiting),
        };
    }
}
