//! Progress of a measurement on a terminal: round, faces left, rays a second.

use crate::reference::ReferenceObserver;
use indicatif::{HumanCount, ProgressBar, ProgressStyle};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

/// A bar a round, on standard error; nothing where that is no terminal or with `--quiet`. Raising the
/// flag stops the measurement.
pub struct ReferenceProgress {
    bar: ProgressBar,
    interrupted: Arc<AtomicBool>,
    rays: AtomicU64,
    started: Instant,
}

impl ReferenceProgress {
    /// Watches a measurement.
    pub fn new(quiet: bool, interrupted: Arc<AtomicBool>) -> Self {
        let bar = if quiet {
            ProgressBar::hidden()
        } else {
            // Hidden by itself where standard error is no terminal.
            ProgressBar::new(0)
        };
        let style = ProgressStyle::with_template("{prefix} [{bar:30}] {percent:>3} % {msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style.progress_chars("=> "));
        Self {
            bar,
            interrupted,
            rays: AtomicU64::new(0),
            started: Instant::now(),
        }
    }
}

impl Drop for ReferenceProgress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

impl ReferenceObserver for ReferenceProgress {
    fn round_started(&self, round: u32, tasks: usize, faces: usize) {
        self.bar.reset();
        self.bar.set_length(tasks as u64);
        self.bar
            .set_prefix(format!("round {round}, {faces} faces to go"));
    }

    fn task_done(&self, rays: u64) {
        let all = self.rays.fetch_add(rays, Ordering::Relaxed) + rays;
        let rate = all as f64 / self.started.elapsed().as_secs_f64().max(1e-9);
        self.bar
            .set_message(format!("{} rays/s", HumanCount(rate as u64)));
        self.bar.inc(1);
    }

    fn interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }
}
