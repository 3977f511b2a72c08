//! A stream of numbers read from the fuzzer's bytes; zeros once they are used up.

use glam::Vec3;

/// Bytes still to be read.
pub struct Bytes<'a>(&'a [u8]);

impl<'a> Bytes<'a> {
    /// All of `data`.
    pub fn new(data: &'a [u8]) -> Self {
        Self(data)
    }

    /// True once everything has been read.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The next byte.
    pub fn byte(&mut self) -> u8 {
        let (first, rest) = self.0.split_first().map_or((0, self.0), |(&b, r)| (b, r));
        self.0 = rest;
        first
    }

    /// Below `count`, which is at most 256.
    pub fn below(&mut self, count: usize) -> usize {
        usize::from(self.byte()) % count
    }

    /// A coordinate within half a unit. Most lie on a coarse grid, where planes, edges and corners
    /// coincide; some a few roundings or weld distances beside it; some anywhere.
    pub fn coordinate(&mut self) -> f32 {
        let grid = f32::from(self.byte() as i8) / 256.0;
        match self.below(8) {
            0..=3 => grid,
            4 => grid + f32::from(self.byte() as i8) * 6.0e-8,
            5 => grid + f32::from(self.byte() as i8) * 5.0e-7,
            6 => grid + f32::from(self.byte() as i8) * 3.0e-5,
            _ => grid + f32::from(self.byte() as i8) / 65_536.0,
        }
        .clamp(-0.5, 0.5)
    }

    /// A point of the unit cube about the origin.
    pub fn point(&mut self) -> Vec3 {
        Vec3::new(self.coordinate(), self.coordinate(), self.coordinate())
    }

    /// In [0, 1].
    pub fn share(&mut self) -> f64 {
        f64::from(u16::from_le_bytes([self.byte(), self.byte()])) / 65_535.0
    }
}
