//! Mean and variance of independent batches, in one pass (Welford 1962).

/// The batches seen so far, in three channels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Estimate {
    /// Number of batches.
    pub count: u64,
    /// Their mean.
    pub mean: [f64; 3],
    /// Sum of their squared deviations from it.
    squares: [f64; 3],
}

impl Estimate {
    /// Adds the mean of a batch.
    pub fn push(&mut self, batch: [f64; 3]) {
        self.count += 1;
        for (c, x) in batch.into_iter().enumerate() {
            let delta = x - self.mean[c];
            self.mean[c] += delta / self.count as f64;
            self.squares[c] += delta * (x - self.mean[c]);
        }
    }

    /// Variance of one batch; 0 until there are two.
    pub fn variance(&self) -> [f64; 3] {
        if self.count < 2 {
            return [0.0; 3];
        }
        self.squares.map(|s| s / (self.count - 1) as f64)
    }

    /// Standard error of the mean; 0 until there are two batches.
    pub fn standard_error(&self) -> [f64; 3] {
        self.variance()
            .map(|v| (v / self.count.max(1) as f64).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn four_numbers_by_hand() {
        let mut estimate = Estimate::default();
        for x in [1.0, 2.0, 4.0, 5.0] {
            estimate.push([x, 7.0, 1e9 + x]);
        }
        assert_eq!(estimate.mean, [3.0, 7.0, 1e9 + 3.0]);
        // Deviations -2, -1, 1, 2: squares 10, over 3, over 4.
        assert_eq!(estimate.variance()[0], 10.0 / 3.0);
        assert!((estimate.standard_error()[0] - (10.0f64 / 12.0).sqrt()).abs() < 1e-15);
        assert_eq!(estimate.standard_error()[1], 0.0);
        assert!((estimate.variance()[2] - 10.0 / 3.0).abs() < 1e-6);
    }
}
