//! Repeatable choices, so that rooms differ from each other and from run to run do not.

use crate::math::hash_u64;

/// A stream of numbers that depends only on its seed.
#[derive(Clone, Debug)]
pub struct Dice {
    state: u64,
}

impl Dice {
    /// The stream of `seed`.
    pub fn new(seed: u64) -> Self {
        Self {
            state: hash_u64(seed),
        }
    }

    /// A whole number in `0..count`.
    pub fn pick(&mut self, count: usize) -> usize {
        self.state = hash_u64(self.state);
        ((self.state >> 32) as usize * count) >> 32
    }

    /// A number in `low..high`, in steps of a hundredth of the difference.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.pick(100) as f64 / 100.0
    }
}
