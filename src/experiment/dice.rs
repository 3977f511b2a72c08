//! Random numbers that depend on what they are for and on nothing else.

use crate::math::hash_u64;

/// A stream of numbers: a counter, hashed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dice {
    key: u64,
    count: u64,
}

impl Dice {
    /// The stream that belongs to `key`.
    pub fn new(key: u64) -> Self {
        Self {
            key: hash_u64(key),
            count: 0,
        }
    }

    fn bits(&mut self) -> u64 {
        self.count += 1;
        hash_u64(self.key ^ hash_u64(self.count))
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f32 {
        // 24 bits are exact in f32.
        (self.bits() >> 40) as f32 * (1.0 / 16_777_216.0)
    }

    /// Uniform in [0, 1), twice.
    pub fn pair(&mut self) -> [f32; 2] {
        let bits = self.bits();
        [(bits >> 40) as f32, ((bits >> 8) & 0xff_ffff) as f32].map(|x| x * (1.0 / 16_777_216.0))
    }

    /// Uniform below `count`, which is positive.
    pub fn below(&mut self, count: usize) -> usize {
        debug_assert!(count > 0);
        // The bias is below 2^-32 for counts of 2^32.
        ((u128::from(self.bits()) * count as u128) >> 64) as usize
    }
}
