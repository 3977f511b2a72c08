//! Progress of a solve on a terminal: pass, exchanges a second, time left.

use super::logs;
use crate::solve::{Observer, PassStatistics, SolveConfig, Stop};
use indicatif::{HumanCount, ProgressBar, ProgressStyle};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

/// A bar a pass, on standard error; nothing where that is no terminal or with `--quiet`. Raising the flag
/// stops the solve.
pub struct Progress {
    bar: ProgressBar,
    goal: String,
    interrupted: Arc<AtomicBool>,
    exchanges: AtomicU64,
    started: Instant,
}

impl Progress {
    /// Watches a solve with this configuration.
    pub fn new(quiet: bool, interrupted: Arc<AtomicBool>, config: &SolveConfig) -> Self {
        let bar = if quiet || logs::as_json() {
            ProgressBar::hidden()
        } else {
            // Hidden by itself where standard error is no terminal.
            ProgressBar::new(0)
        };
        let style =
            ProgressStyle::with_template("{prefix} [{bar:30}] {percent:>3} % {msg} left {eta}")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
        bar.set_style(style.progress_chars("=> "));
        Self {
            bar,
            goal: match config.stop {
                Stop::Passes(n) => format!("of {n}"),
                Stop::Converged(x) => format!("until {x:e} is unshot"),
            },
            interrupted,
            exchanges: AtomicU64::new(0),
            started: Instant::now(),
        }
    }

    /// Removes the bar.
    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.finish();
    }
}

impl Observer for Progress {
    fn pass_started(&self, pass: u32, tasks: usize) {
        self.bar.reset();
        self.bar.set_length(tasks as u64);
        self.bar.set_prefix(format!("pass {pass} {}", self.goal));
    }

    fn task_done(&self, exchanges: u64) {
        let all = self.exchanges.fetch_add(exchanges, Ordering::Relaxed) + exchanges;
        let rate = all as f64 / self.started.elapsed().as_secs_f64().max(1e-9);
        self.bar
            .set_message(format!("{} exchanges/s", HumanCount(rate as u64)));
        self.bar.inc(1);
    }

    fn pass_done(&self, statistics: &PassStatistics, unshot_fraction: f64) {
        tracing::info!(
            pass = statistics.pass,
            exchanges = statistics.exchanges,
            rays = statistics.rays,
            seconds = statistics.seconds,
            unshot_fraction,
            "pass done"
        );
        self.bar.println(format!(
            "pass {:>3}: {} exchanges, {} rays, {:.2} s, {:.2e} of the power unshot",
            statistics.pass,
            HumanCount(statistics.exchanges),
            HumanCount(statistics.rays),
            statistics.seconds,
            unshot_fraction
        ));
    }

    fn interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }
}
