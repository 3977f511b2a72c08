//! Random numbers, the same in every run.

use certilux::math::hash_u64;

pub struct Numbers(u64);

impl Numbers {
    pub fn new(seed: u64) -> Self {
        Self(hash_u64(seed))
    }

    /// In [0, 1).
    pub fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_add(1);
        (hash_u64(self.0) >> 40) as f32 / 16_777_216.0
    }

    /// In 0..n.
    pub fn below(&mut self, n: usize) -> usize {
        ((self.next() * n as f32) as usize).min(n - 1)
    }
}
