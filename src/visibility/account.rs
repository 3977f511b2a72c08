//! What a way to save rays cost and saved.

/// Least packets saved for each that was spent: below it a way is left to the first tasks of a pass.
const LEAST_SAVED: f64 = 1.25;

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

    /// Whether to go on; true as long as less than `telling` was spent, which says too little and costs too little.
    pub fn pays(self, telling: f64) -> bool {
        self.spent < telling || self.saved >= LEAST_SAVED * self.spent
    }
}
