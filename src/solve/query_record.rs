//! What experience says of one kind of query: how often it succeeded, at what cost, and so whether it pays.
//!
//! Costs are committed constants, never clocks, so that what a task learns repeats.

/// Attempts, successes and costs of one kind of query in like circumstances.
#[derive(Clone, Copy, Debug)]
pub struct QueryRecord {
    attempts: f32,
    successes: f32,
    /// What the attempts cost together, in packets of eight rays.
    cost: f32,
    /// How often a query was left out since the last one.
    skipped: u32,
    /// How often one may be left out in a row.
    patience: u32,
}

/// Attempts that a record remembers.
const MEMORY: f32 = 64.0;
/// Attempts of others that a record starts with at most.
const LEARNED: f32 = 32.0;
/// Queries left out in a row before one is made all the same: at first, and after many that were made in vain.
const LEAST_PATIENCE: u32 = 64;
const MOST_PATIENCE: u32 = 4096;
/// Gain over cost from which a query pays: a proof saves the rays, but not always the samples, and walks push out of the
/// caches what the exchanges need.
const CLEARLY: f32 = 1.5;
/// Cost of a query before any was made, in packets of eight rays.
const UNKNOWN_COST: f32 = 1.5;

impl QueryRecord {
    /// Half of two imaginary attempts succeeded.
    pub const PRIOR: Self = Self {
        attempts: 2.0,
        successes: 1.0,
        cost: 2.0 * UNKNOWN_COST,
        skipped: 0,
        patience: LEAST_PATIENCE,
    };

    /// The mean of what several records learned, with the weight of all their attempts up to a limit.
    pub fn after(records: impl Iterator<Item = Self>) -> Self {
        let mut sum = Self {
            attempts: 0.0,
            successes: 0.0,
            cost: 0.0,
            ..Self::PRIOR
        };
        for record in records {
            sum.attempts += record.attempts - Self::PRIOR.attempts;
            sum.successes += record.successes - Self::PRIOR.successes;
            sum.cost += record.cost - Self::PRIOR.cost;
            sum.patience = sum.patience.max(record.patience);
        }
        // Forgetting may leave less than the prior.
        if sum.attempts <= 0.0 {
            return Self::PRIOR;
        }
        let weight = (LEARNED / sum.attempts).min(1.0);
        Self {
            attempts: Self::PRIOR.attempts + weight * sum.attempts,
            successes: Self::PRIOR.successes + weight * sum.successes.max(0.0),
            cost: Self::PRIOR.cost + weight * sum.cost.max(0.0),
            ..sum
        }
    }

    /// Remembers how an attempt ended and what it cost.
    pub fn learn(&mut self, success: bool, cost: f32) {
        self.attempts += 1.0;
        self.cost += cost;
        self.successes += f32::from(u8::from(success));
        // Half of the past is forgotten: the walk moves on to other surfaces.
        if self.attempts > MEMORY {
            self.attempts *= 0.5;
            self.successes *= 0.5;
            self.cost *= 0.5;
        }
    }

    /// True if the mean gain clearly exceeds the mean cost, where a success gains `gain`; now and then in any case, lest a bad start
    /// lasts, and ever more seldom while that finds nothing new.
    pub fn pays(&mut self, gain: f32) -> bool {
        if self.successes * gain > CLEARLY * self.cost {
            self.skipped = 0;
            self.patience = LEAST_PATIENCE;
            return true;
        }
        if self.skipped >= self.patience {
            self.skipped = 0;
            self.patience = (2 * self.patience).min(MOST_PATIENCE);
            return true;
        }
        self.skipped += 1;
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many of `rounds` chances are taken where each attempt ends like this.
    fn taken(record: &mut QueryRecord, rounds: u32, success: bool) -> u32 {
        (0..rounds)
            .map(|_| {
                let pays = record.pays(3.0);
                if pays {
                    record.learn(success, 1.0);
                }
                u32::from(pays)
            })
            .sum()
    }

    #[test]
    fn what_never_succeeds_is_tried_ever_more_seldom() {
        let mut record = QueryRecord::PRIOR;
        let early = taken(&mut record, 1_000, false);
        let late = taken(&mut record, 100_000, false);
        assert!((3..20).contains(&early), "{early}");
        assert!((100_000 / 4_200..100_000 / 1_500).contains(&late), "{late}");
    }

    #[test]
    fn what_begins_to_succeed_is_tried_always() {
        let mut record = QueryRecord::PRIOR;
        taken(&mut record, 1_000, false);
        let until =
            (0..200_000).take_while(|_| taken(&mut record, 1, true) == 0 || !record.pays(3.0));
        assert!(until.count() < 100_000);
        assert_eq!(taken(&mut record, 1_000, true), 1_000);
    }

    #[test]
    fn records_of_others_weigh_no_more_than_their_limit() {
        let mut good = QueryRecord::PRIOR;
        for _ in 0..60 {
            good.learn(true, 1.0);
        }
        let mut learned = QueryRecord::after([good; 100].into_iter());
        assert_eq!(learned.attempts, 2.0 + LEARNED);
        assert!(learned.pays(3.0));
        // As many failures turn it round.
        for _ in 0..MEMORY as u32 {
            learned.learn(false, 1.0);
        }
        assert!(!learned.pays(1.2));
        assert_eq!(
            QueryRecord::after(std::iter::empty()).attempts,
            QueryRecord::PRIOR.attempts
        );
    }
}
