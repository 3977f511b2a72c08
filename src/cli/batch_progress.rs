//! Progress of a batch: a line a job that ended, and on a terminal a bar with those that run.

use super::logs;
use super::session::print_line;
use crate::job::{JobRecord, JobStatus};
use indicatif::{ProgressBar, ProgressStyle};
use std::fmt::Write;

/// Names shown at most beside the bar.
const MOST_SHOWN: usize = 3;

/// The bar, on standard error.
pub struct BatchProgress {
    bar: ProgressBar,
    quiet: bool,
}

impl BatchProgress {
    /// For so many jobs.
    pub fn new(quiet: bool, jobs: usize) -> Self {
        let bar = if quiet || logs::as_json() {
            ProgressBar::hidden()
        } else {
            // Hidden by itself where standard error is no terminal.
            ProgressBar::new(jobs as u64)
        };
        let style = ProgressStyle::with_template("{pos} of {len} jobs [{bar:30}] {msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style.progress_chars("=> "));
        Self { bar, quiet }
    }

    /// A job has ended.
    pub fn ended(&self, job: &JobRecord) {
        self.bar.inc(1);
        if self.quiet {
            return;
        }
        let word = match job.status {
            JobStatus::Done => "done",
            JobStatus::Skipped => "skipped",
            _ => "FAILED",
        };
        let seconds = job.seconds.unwrap_or_default();
        self.bar
            .suspend(|| print_line(format_args!("{word:<8} {:>8.1} s  {}", seconds, job.name)));
    }

    /// Jobs that run now.
    pub fn running<'a>(&self, names: impl Iterator<Item = &'a str>) {
        if self.bar.is_hidden() {
            return;
        }
        let mut text = String::new();
        for (k, name) in names.enumerate() {
            // Writing to a string cannot fail.
            let _ = match k {
                0 => write!(text, "{name}"),
                MOST_SHOWN => write!(text, ", ..."),
                k if k > MOST_SHOWN => Ok(()),
                _ => write!(text, ", {name}"),
            };
        }
        self.bar.set_message(text);
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Drop for BatchProgress {
    fn drop(&mut self) {
        self.finish();
    }
}
