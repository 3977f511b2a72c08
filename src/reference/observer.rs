//! How a long measurement is watched and stopped.

/// Hears of progress, from any thread.
pub trait ReferenceObserver: Sync {
    /// Round `round`, counted from 1, begins: `tasks` tasks for the `faces` faces that are not yet sure enough.
    fn round_started(&self, _round: u32, _tasks: usize, _faces: usize) {}
    /// A task has ended after `rays` rays.
    fn task_done(&self, _rays: u64) {}
    /// True when the measurement shall stop; asked often.
    fn interrupted(&self) -> bool {
        false
    }
}

/// Hears nothing and never interrupts.
#[derive(Clone, Copy, Debug, Default)]
pub struct SilentReference;

impl ReferenceObserver for SilentReference {}
