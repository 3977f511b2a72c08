//! Random numbers by counting: what a path draws depends on what the path is for and on nothing else.

use crate::math::hash_u64;

/// Step of the Weyl sequence under SplitMix64 (Steele et al. 2014): 2^64 over the golden ratio, odd.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// A stream of uniform numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Random {
    state: u64,
}

impl Random {
    /// The stream that belongs to `key`.
    pub fn new(key: u64) -> Self {
        Self {
            state: hash_u64(key),
        }
    }

    /// The next number in [0, 1), a multiple of 2^-53.
    pub fn next(&mut self) -> f64 {
        let bits = hash_u64(self.state);
        self.state = self.state.wrapping_add(STEP);
        (bits >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// A number of a low-discrepancy sequence, a multiple of 2^-24, with random digits below: uniform to
    /// 2^-53, so that no choice is too improbable to be made.
    pub fn refine(&mut self, coarse: f32) -> f64 {
        // Below 1 still: (2^24 - 1 + (1 - 2^-53)) / 2^24 rounds to less than 1.
        (f64::from(coarse) + self.next() * (1.0 / 16_777_216.0)).min(BELOW_ONE)
    }
}

/// The greatest number below 1.
const BELOW_ONE: f64 = 1.0 - f64::EPSILON / 2.0;

/// A key of several numbers, in order.
pub(super) fn key_of(parts: &[u64]) -> u64 {
    parts.iter().fold(0, |key, &part| hash_u64(key ^ part))
}
