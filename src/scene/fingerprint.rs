//! A number that tells scenes apart: whether results kept on disk are of this one.

use super::model::Scene;

/// FNV-1a with 64 bits (Fowler, Noll and Vo): tells files apart that changed by accident, and is no
/// defence against anybody who wants two scenes to agree.
struct Fnv(u64);

impl Fnv {
    fn add(&mut self, bits: u64) {
        for byte in bits.to_le_bytes() {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}

impl Scene {
    /// Hash of all that a solve looks at: vertices as read, polygons and their faces, reflectances and
    /// emissions. The same on every machine.
    pub fn fingerprint(&self) -> u64 {
        let mut hash = Fnv(0xcbf2_9ce4_8422_2325);
        for position in &self.source_positions {
            (position.to_array().iter()).for_each(|x| hash.add(x.to_bits()));
        }
        for polygon in &self.polygons {
            (polygon.vertices.iter()).for_each(|&v| hash.add(u64::from(v)));
            hash.add(u64::from(polygon.source_face));
            let surface = &self.surfaces[polygon.surface as usize];
            let numbers = surface.reflectance.iter().chain(&surface.emission);
            numbers.for_each(|x| hash.add(x.to_bits()));
        }
        hash.0
    }
}
