//! Visibility of a receiver as a whole and part by part: the samples of one exchange say where on it a shadow falls, at no
//! further ray.
//!
//! A part has few samples, and its visibility is noisy; but what it receives is a sum over many exchanges, whose
//! shadows add up where they fall together, instead of darkening the whole receiver evenly.

/// Most parts of a receiver whose visibility is told apart.
pub const PARTS: usize = 8;

/// Share of the unoccluded light that arrives at a receiver and at its parts, usually 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartVisibility {
    /// At all of it.
    pub whole: f32,
    /// At each part; of one whose samples carry no light, as at the whole.
    pub parts: [f32; PARTS],
}

impl PartVisibility {
    /// Everything arrives.
    pub const CLEAR: Self = Self::even(1.0);

    /// The same everywhere.
    pub const fn even(visibility: f32) -> Self {
        Self {
            whole: visibility,
            parts: [visibility; PARTS],
        }
    }

    /// True when all parts are known to see as much as the whole.
    pub fn is_even(&self) -> bool {
        self.parts.iter().all(|&part| part == self.whole)
    }

    /// This, and `times` what `again` differs by: a second set of samples that stands for several.
    pub fn corrected(&self, again: &Self, times: f32) -> Self {
        let correct = |first: f32, again: f32| first + times * (again - first);
        Self {
            whole: correct(self.whole, again.whole),
            parts: std::array::from_fn(|k| correct(self.parts[k], again.parts[k])),
        }
    }
}

impl Default for PartVisibility {
    fn default() -> Self {
        Self::even(0.0)
    }
}

/// Weights of the samples of each part: of all, and of those that are clear.
#[derive(Clone, Copy, Debug, Default)]
pub struct PartWeights {
    all: [f32; PARTS],
    clear: [f32; PARTS],
}

impl PartWeights {
    /// Adds eight samples: the part that each lies in, the light that it would carry, what of it no surface that
    /// touches its ends swallows, and a bit for each that is blocked.
    #[inline(always)]
    pub fn add(&mut self, part: &[u8; 8], light: &[f32; 8], open: &[f32; 8], blocked: u8) {
        for l in 0..8 {
            let part = usize::from(part[l]) % PARTS;
            self.all[part] += light[l];
            if blocked & (1 << l) == 0 {
                self.clear[part] += open[l];
            }
        }
    }

    /// The visibility of a receiver that as a whole sees `whole`.
    pub fn visibility(&self, whole: f32) -> PartVisibility {
        PartVisibility {
            whole,
            parts: std::array::from_fn(|k| match self.all[k] > 0.0 {
                true => self.clear[k] / self.all[k],
                false => whole,
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_see_what_their_own_samples_see() {
        let mut weights = PartWeights::default();
        let part = [0, 0, 1, 1, 2, 2, 2, 3];
        let light = [1.0, 3.0, 1.0, 1.0, 2.0, 1.0, 1.0, 0.0];
        // The second sample is swallowed where it starts, the third, fourth and fifth are blocked.
        let open = [1.0, 0.0, 1.0, 1.0, 2.0, 1.0, 1.0, 0.0];
        weights.add(&part, &light, &open, 0b0001_1100);
        let seen = weights.visibility(0.3);
        assert_eq!(seen.parts[..3], [0.25, 0.0, 0.5]);
        // No light would come to the fourth part, and no sample to the others.
        assert_eq!(seen.parts[3..], [0.3; 5]);
        assert!(!seen.is_even() && PartVisibility::even(0.3).is_even());
    }

    #[test]
    fn a_second_set_that_stands_for_four_counts_four_times() {
        let again = PartVisibility {
            whole: 0.75,
            parts: [1.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0],
        };
        let corrected = PartVisibility::CLEAR.corrected(&again, 4.0);
        assert_eq!(corrected.whole, 0.0);
        assert_eq!(corrected.parts[..3], [1.0, -3.0, 1.0]);
    }
}
