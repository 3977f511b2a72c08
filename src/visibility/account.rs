//! What a way to save rays cost and saved.

/// Least packets saved for each that was spent: below it a way is left to the first tasks of a pass.
const LEAST_SAVED: f64 = 1.25;

/// Packets saved for each that was spent below which there is no hope.
const HOPELESS: f64 = 0.1;

/// What one way to save rays cost and saved, in packets of eight rays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    /// On whatever it asks.
    pub spent: f64,
    /// By rays not cast.
    pub saved: f64,
}

impl Account {
    /// The sum over several tasks.
    pub fn sum(accounts: impl Iterator<Item = Self>) -> Self {
        accounts.fold(Self::default(), |sum, one| Self {
            spent: sum.spent + one.spent,
            saved: sum.saved + one.saved,
        })
    }

    /// Whether to go on; true as long as less than `telling` was spent, which says too little and costs too little, or a
    /// quarter of it where next to nothing was saved.
    pub fn pays(self, telling: f64) -> bool {
        let is_hopeless = self.saved < HOPELESS * self.spent;
        let enough = if is_hopeless { telling / 4.0 } else { telling };
        self.spent < enough || self.saved >= LEAST_SAVED * self.spent
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn little_spending_says_nothing_unless_it_is_hopeless() {
        let pays = |spent, saved| Account { spent, saved }.pays(1_000.0);
        assert!(pays(0.0, 0.0) && pays(240.0, 0.0) && pays(990.0, 100.0));
        assert!(!pays(260.0, 0.0) && !pays(990.0, 90.0));
        assert!(pays(1_010.0, 1_270.0) && !pays(1_010.0, 1_250.0));
    }
}
