//! Progress of a sweep on a terminal: solves done, what is being solved, time left.

use crate::experiment::{SweepSettings, stride_name};
use crate::solve::Observer;
use indicatif::{ProgressBar, ProgressStyle};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A bar on standard error; nothing where that is no terminal or with `--quiet`. Raising the flag stops
/// the solve under way.
pub struct SweepProgress {
    bar: ProgressBar,
    interrupted: Arc<AtomicBool>,
}

impl SweepProgress {
    /// Watches so many solves.
    pub fn new(quiet: bool, interrupted: Arc<AtomicBool>, solves: usize) -> Self {
        let bar = if quiet {
            ProgressBar::hidden()
        } else {
            // Hidden by itself where standard error is no terminal.
            ProgressBar::new(solves as u64)
        };
        let style = ProgressStyle::with_template("{pos}/{len} [{bar:30}] left {eta} {msg}")
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style.progress_chars("=> "));
        Self { bar, interrupted }
    }

    /// A solve begins.
    pub fn begins(&self, settings: &SweepSettings) {
        self.bar.set_message(format!(
            "{} epsilon {:e} rays {} stride {}",
            settings.technique.name(),
            settings.epsilon,
            settings.rays,
            stride_name(settings.stride)
        ));
        self.bar.tick();
    }

    /// It has ended.
    pub fn ends(&self) {
        self.bar.inc(1);
    }
}

impl Drop for SweepProgress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

impl Observer for SweepProgress {
    fn interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }
}
