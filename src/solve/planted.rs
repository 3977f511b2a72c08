//! Regressions that `bench/planted.sh` plants to see `certilux bench --check` catch them. Only with the feature
//! `plant-regressions`, which no product has.

use std::cell::Cell;
use std::sync::atomic::{AtomicU8, Ordering};

/// What is wrong with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Regression {
    /// The irradiance kernel does some of its work twice.
    SlowKernel = 1,
    /// Each task reports one ray too many.
    ChangedCount = 2,
}

static PLANTED: AtomicU8 = AtomicU8::new(0);

/// One call of the kernel in so many is made twice: 5 % of a small solve's instructions.
const REPEATED: u32 = 3;

/// Plants a regression for the rest of the program's life.
pub fn plant(regression: Regression) {
    PLANTED.store(regression as u8, Ordering::Relaxed);
}

fn is_planted(regression: Regression) -> bool {
    PLANTED.load(Ordering::Relaxed) == regression as u8
}

/// Whether this call of the kernel is to be made twice.
pub(super) fn repeats_call() -> bool {
    thread_local!(static CALLS: Cell<u32> = const { Cell::new(0) });
    is_planted(Regression::SlowKernel)
        && CALLS.with(|calls| {
            calls.set(calls.get().wrapping_add(1));
            calls.get().is_multiple_of(REPEATED)
        })
}

/// Rays that a task reports and has not cast.
pub(super) fn rays_too_many() -> u64 {
    u64::from(is_planted(Regression::ChangedCount))
}
