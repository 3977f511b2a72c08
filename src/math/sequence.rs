//! Low-discrepancy points in [0,1)^4, scrambled by a hash, so that a sample depends only on what
//! it is for and never on the thread that draws it.

/// A well-mixed 64-bit hash (the finaliser of SplitMix64, Steele et al. 2014).
pub fn hash_u64(value: u64) -> u64 {
    let mut z = value.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The four-dimensional R-sequence (Roberts 2018: the generalised golden ratio), shifted by a
/// hash (Cranley-Patterson rotation).
#[derive(Clone, Copy, Debug)]
pub struct SampleSequence {
    shift: [u32; 4],
}

impl SampleSequence {
    /// 2^32 * (1/g, 1/g^2, 1/g^3, 1/g^4) with g = 1.1673039782614187, the root of g^5 = g + 1.
    const STEP: [u32; 4] = [3_679_390_609, 3_152_041_523, 2_700_274_806, 2_313_257_605];

    /// The sequence that belongs to `key`.
    pub fn new(key: u64) -> Self {
        let (a, b) = (hash_u64(key), hash_u64(key ^ 0x5851_f42d_4c95_7f2d));
        Self {
            shift: [a as u32, (a >> 32) as u32, b as u32, (b >> 32) as u32],
        }
    }

    /// Point number `index`, each coordinate in [0,1).
    pub fn point(&self, index: u32) -> [f32; 4] {
        std::array::from_fn(|d| {
            let bits = self.shift[d].wrapping_add(Self::STEP[d].wrapping_mul(index));
            // The 24 leading bits are exact in f32 and stay below 1.
            (bits >> 8) as f32 * (1.0 / 16_777_216.0)
        })
    }

    /// Points `index` to `index + 7`, coordinate by coordinate.
    #[inline(always)]
    pub fn points(&self, index: u32) -> [[f32; 8]; 4] {
        let mut points = [[0.0; 8]; 4];
        for (d, coordinate) in points.iter_mut().enumerate() {
            let first = self.shift[d].wrapping_add(Self::STEP[d].wrapping_mul(index));
            for (l, value) in coordinate.iter_mut().enumerate() {
                let bits = first.wrapping_add(Self::STEP[d].wrapping_mul(l as u32));
                *value = (bits >> 8) as f32 * (1.0 / 16_777_216.0);
            }
        }
        points
    }
}
