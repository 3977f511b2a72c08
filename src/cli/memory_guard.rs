//! Memory: an estimate before the solve, a refusal where it is too much, and a look at the truth after every pass.

use super::byte_size::ByteSize;
use super::error::CliError;
use super::logs;
use crate::job::MemoryEstimate;
use crate::solve::{Observer, PassStatistics, Snapshot};
use std::sync::atomic::{AtomicU64, Ordering};

/// An estimate from which it is worth a word.
const LARGE: u64 = 1 << 30;

/// Refuses a solve that is likely to need more than it may, and speaks of large ones.
pub fn check_estimate(estimate: MemoryEstimate, max: Option<ByteSize>) -> Result<(), CliError> {
    let [likely, most] = [estimate.likely, estimate.most].map(ByteSize);
    if let Some(max) = max.filter(|&max| likely > max) {
        return Err(CliError::Argument(format!(
            "the solve is likely to need {likely} of memory (at worst {most}), more than --max-memory {max}; \
             a greater --epsilon, --gradient or --min-area needs less"
        )));
    }
    if likely.0 >= LARGE {
        logs::note(format_args!(
            "the solve is likely to need {likely} of memory, at worst {most}"
        ));
        if let Some(free) = available().map(ByteSize).filter(|&free| likely > free) {
            logs::warn(format_args!("this machine has {free} to spare"));
        }
    }
    Ok(())
}

/// Passes on what a solve tells, and stops it once it holds more memory than it may.
pub struct MemoryGuard<'a> {
    watcher: &'a dyn Observer,
    max: Option<ByteSize>,
    /// What was held when it was too much; 0 before.
    exceeded: AtomicU64,
}

impl<'a> MemoryGuard<'a> {
    /// A guard that lets pass what is below `max`.
    pub fn new(watcher: &'a dyn Observer, max: Option<ByteSize>) -> Self {
        Self {
            watcher,
            max,
            exceeded: AtomicU64::new(0),
        }
    }

    /// How much was held when the guard stopped the solve.
    pub fn exceeded(&self) -> Option<ByteSize> {
        match self.exceeded.load(Ordering::Relaxed) {
            0 => None,
            held => Some(ByteSize(held)),
        }
    }
}

impl Observer for MemoryGuard<'_> {
    fn pass_started(&self, pass: u32, tasks: usize) {
        self.watcher.pass_started(pass, tasks);
    }

    fn task_done(&self, exchanges: u64) {
        self.watcher.task_done(exchanges);
    }

    fn pass_done(&self, statistics: &PassStatistics, unshot_fraction: f64) {
        self.watcher.pass_done(statistics, unshot_fraction);
        let held = self
            .max
            .and_then(|max| resident().filter(|&held| held > max.0));
        if let Some(held) = held {
            self.exceeded.store(held, Ordering::Relaxed);
        }
    }

    fn state_reached(&self, take: &dyn Fn() -> Snapshot) {
        self.watcher.state_reached(take);
    }

    fn interrupted(&self) -> bool {
        self.exceeded().is_some() || self.watcher.interrupted()
    }
}

/// Resident memory of this process; `None` where the system does not tell.
fn resident() -> Option<u64> {
    line_of("/proc/self/status", "VmRSS:")
}

/// Memory that programs can have without others being swapped out.
fn available() -> Option<u64> {
    line_of("/proc/meminfo", "MemAvailable:")
}

/// The bytes in a line such as `VmRSS:   1234 kB`.
fn line_of(file: &str, name: &str) -> Option<u64> {
    let text = std::fs::read_to_string(file).ok()?;
    let rest = text.lines().find_map(|line| line.strip_prefix(name))?;
    let kilobytes: u64 = rest.split_whitespace().next()?.parse().ok()?;
    Some(kilobytes * 1024)
}
