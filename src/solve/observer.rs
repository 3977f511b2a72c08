//! How a long solve is watched and stopped.

use super::element_name::ElementName;
use super::snapshot::Snapshot;
use super::statistics::PassStatistics;

/// Hears of progress, from any thread.
pub trait Observer: Sync {
    /// A pass begins, made of `tasks` tasks.
    fn pass_started(&self, _pass: u32, _tasks: usize) {}
    /// A task has ended after `exchanges` exchanges.
    fn task_done(&self, _exchanges: u64) {}
    /// A pass has ended; `unshot_fraction` is the unshot power over the emitted.
    fn pass_done(&self, _statistics: &PassStatistics, _unshot_fraction: f64) {}
    /// A pass has ended, and `take` makes the state from which the solve can be [resumed](super::resume).
    fn state_reached(&self, _take: &dyn Fn() -> Snapshot) {}
    /// Whether [`Self::rays_cast`] wants to be told: asked once a task.
    fn counts_rays(&self) -> bool {
        false
    }
    /// Rays were cast through Embree to find what reaches `receiver`.
    fn rays_cast(&self, _receiver: ElementName, _rays: u32) {}
    /// True when the solve shall stop; asked often.
    fn interrupted(&self) -> bool {
        false
    }
}

/// Hears nothing and never interrupts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {}
