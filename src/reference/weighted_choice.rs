//! A choice among weighted things by one uniform number.

/// Things with positive weights, chosen in proportion to them.
#[derive(Clone, Debug)]
pub(super) struct WeightedChoice {
    /// Sums of the weights up to and including each.
    sums: Vec<f64>,
}

impl WeightedChoice {
    /// Weights must be finite and at least 0; those of 0 are never chosen.
    pub fn new(weights: impl IntoIterator<Item = f64>) -> Self {
        let mut total = 0.0;
        Self {
            sums: weights
                .into_iter()
                .map(|w| {
                    total += w;
                    total
                })
                .collect(),
        }
    }

    /// Sum of all weights.
    pub fn total(&self) -> f64 {
        self.sums.last().copied().unwrap_or(0.0)
    }

    /// The choice made by `u` in [0, 1), and what is left of `u`: again uniform in [0, 1). Must not be
    /// asked where the total is 0.
    pub fn choose(&self, u: f64) -> (usize, f64) {
        let at = u * self.total();
        let index = self.sums.partition_point(|&sum| sum <= at);
        // Rounding of the product may reach the total itself: the last of positive weight is meant.
        let index = if index < self.sums.len() {
            index
        } else {
            self.sums.partition_point(|&sum| sum < self.total())
        };
        let before = if index == 0 {
            0.0
        } else {
            self.sums[index - 1]
        };
        let rest = (at - before) / (self.sums[index] - before);
        (index, rest.clamp(0.0, 1.0 - f64::EPSILON))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_the_weights() {
        let choice = WeightedChoice::new([0.0, 1.0, 3.0, 0.0, 4.0, 0.0]);
        let n = 8_000;
        let mut counts = [0; 6];
        for i in 0..n {
            let (index, rest) = choice.choose((f64::from(i) + 0.5) / f64::from(n));
            assert!((0.0..1.0).contains(&rest));
            counts[index] += 1;
        }
        assert_eq!(counts, [0, 1000, 3000, 0, 4000, 0]);
    }

    #[test]
    fn the_ends_are_of_positive_weight() {
        let choice = WeightedChoice::new([0.0, 0.1, 0.2, 0.7, 0.0]);
        assert_eq!(choice.choose(0.0).0, 1);
        assert_eq!(choice.choose(1.0 - f64::EPSILON / 2.0).0, 3);
        let (index, rest) = choice.choose(0.2);
        assert_eq!(index, 2);
        assert!((rest - 0.5).abs() < 1e-12);
    }
}
