//! When a query for a guarantee is likely to pay (design, section 7, points 2 and 3).
//!
//! A proof saves the rays of every exchange below its pair, so what it may save is known beforehand;
//! whether it will succeed is told by a few probe rays, since no pair with both blocked and clear
//! ones can be proved either way, and by how often queries on pairs of its size succeeded so far in
//! the same task. Costs are committed constants, never clocks, so that schedules repeat.

use super::config::Technique;
use crate::visibility::WalkLimits;

/// Which guarantees to ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Queries {
    /// None.
    None,
    /// Cast probe rays first, and ask [`QuerySchedule::after_evidence`].
    Probe,
    /// Full occlusion alone.
    Occlusion,
    /// Full visibility alone.
    Visibility,
    /// Not a proof but a shorter list of what may block.
    Shorten,
    /// Occlusion, then visibility.
    Both,
}

impl Queries {
    /// True where full occlusion is asked.
    pub fn occlusion(self) -> bool {
        matches!(self, Self::Occlusion | Self::Both)
    }

    /// True where the shaft is walked.
    pub fn visibility(self) -> bool {
        matches!(self, Self::Visibility | Self::Shorten | Self::Both)
    }
}

/// What probe rays said of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Evidence {
    /// All blocked.
    Blocked,
    /// All clear.
    Clear,
    /// Some of each.
    Mixed,
    /// None carries light.
    Dark,
}

/// Attempts and successes of one kind of query at one size of pair.
#[derive(Clone, Copy, Debug)]
struct Record {
    attempts: f32,
    successes: f32,
    /// What the attempts cost together, in packets of eight rays.
    cost: f32,
    /// How often a query was left out since the last one.
    skipped: u32,
}

impl Record {
    /// Half of two imaginary attempts succeeded.
    const PRIOR: Self = Self {
        attempts: 2.0,
        successes: 1.0,
        cost: 2.0 * QUERY_COST,
        skipped: 0,
    };

    /// The mean of what several records learned, with the weight of all their attempts up to a limit.
    fn after(records: impl Iterator<Item = Self>) -> Self {
        let mut sum = Self {
            attempts: 0.0,
            successes: 0.0,
            cost: 0.0,
            skipped: 0,
        };
        for record in records {
            sum.attempts += record.attempts - Self::PRIOR.attempts;
            sum.successes += record.successes - Self::PRIOR.successes;
            sum.cost += record.cost - Self::PRIOR.cost;
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
            skipped: 0,
        }
    }

    fn learn(&mut self, success: bool, cost: f32) {
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

    /// True if the mean gain clearly exceeds the mean cost; now and then in any case, lest a bad start lasts.
    fn pays(&mut self, gain: f32) -> bool {
        let pays = self.successes * gain > CLEARLY * self.cost;
        if pays || self.skipped >= RETRY_AFTER {
            self.skipped = 0;
            return true;
        }
        self.skipped += 1;
        false
    }
}

/// Attempts that a record remembers.
const MEMORY: f32 = 64.0;
/// Attempts of others that a record starts with at most.
const LEARNED: f32 = 32.0;
/// Queries left out in a row before one is made all the same.
const RETRY_AFTER: u32 = 64;
/// Gain over cost from which a query pays: walks also push out of the caches what the exchanges need.
const CLEARLY: f32 = 2.0;
/// Sizes of pairs told apart: powers of two of the packets that a proof may save.
const SIZES: usize = 16;
/// Cost of eight probe rays and of a query, in packets of eight rays.
const PROBE_COST: f32 = 1.0;
const QUERY_COST: f32 = 1.5;
/// Parts of a query's cost, in packets of eight rays: what every query costs, a node or full test of the occluders,
/// and a node or leaf of the scene with its polygons.
const QUERY_BASE_COST: f32 = 0.5;
const OCCLUDER_STEP_COST: f32 = 0.05;
const NODE_COST: f32 = 0.5;
/// Nodes and leaves that any walk, and no walk but the paper's, may test.
const LEAST_NODES: f32 = 8.0;
const MOST_NODES: f32 = 32.0;
/// Packets to be saved from which a pair is worth a look.
const LEAST_EXPECTED: f32 = 8.0;
/// Least factor between what proofs of nested pairs may save that are both looked at.
const STRIDE_FACTOR: f32 = 4.0;

/// The schedule of one task.
#[derive(Clone, Debug)]
pub struct QuerySchedule {
    technique: Technique,
    occlusion: [Record; SIZES],
    visibility: [Record; SIZES],
    either: [Record; SIZES],
}

impl QuerySchedule {
    /// Before anything is learned.
    pub fn new(technique: Technique) -> Self {
        Self {
            technique,
            occlusion: [Record::PRIOR; SIZES],
            visibility: [Record::PRIOR; SIZES],
            either: [Record::PRIOR; SIZES],
        }
    }

    /// What several schedules learned together, to start others with.
    pub fn after<'a>(
        technique: Technique,
        schedules: impl Iterator<Item = &'a Self> + Clone,
    ) -> Self {
        let together = |records: fn(&Self) -> &[Record; SIZES]| {
            std::array::from_fn(|size| Record::after(schedules.clone().map(|s| records(s)[size])))
        };
        Self {
            technique,
            occlusion: together(|s| &s.occlusion),
            visibility: together(|s| &s.visibility),
            either: together(|s| &s.either),
        }
    }

    /// Whether to look at a pair with `expected` packets to be cast below it, where the last one looked at
    /// above had `asked_at`.
    pub fn before_split(&mut self, expected: f32, asked_at: f32) -> Queries {
        if expected < LEAST_EXPECTED || expected * STRIDE_FACTOR > asked_at {
            return Queries::None;
        }
        match self.either[size(expected)].pays(expected) {
            true => Queries::Probe,
            false => Queries::None,
        }
    }

    /// Which query can succeed at all.
    pub fn after_evidence(&mut self, evidence: Evidence, expected: f32) -> Queries {
        let size = size(expected);
        match evidence {
            Evidence::Blocked
                if self.technique.proves_occlusion() && self.occlusion[size].pays(expected) =>
            {
                Queries::Occlusion
            }
            Evidence::Clear if self.visibility[size].pays(expected) => Queries::Visibility,
            Evidence::Dark => {
                self.either[size].learn(false, PROBE_COST);
                Queries::None
            }
            Evidence::Mixed => {
                self.either[size].learn(false, PROBE_COST);
                self.shorten()
            }
            _ => self.shorten(),
        }
    }

    fn shorten(&self) -> Queries {
        match self.technique {
            Technique::Blockers => Queries::Shorten,
            _ => Queries::None,
        }
    }

    /// How far a walk may go: it may cost what it can save, about the rays of one exchange a node. Walks at a
    /// fixed stride are the paper's and go to their ends.
    pub fn limits(&self, queries: Queries, expected: f32) -> WalkLimits {
        let nodes = expected.clamp(LEAST_NODES, MOST_NODES) as u32;
        match queries {
            Queries::Both => WalkLimits::default(),
            Queries::Shorten => WalkLimits {
                blocking_leaves: 6,
                nodes: 32,
            },
            _ => WalkLimits {
                nodes,
                ..WalkLimits::default()
            },
        }
    }

    /// Remembers how a query for occlusion ended, after so many nodes and full tests.
    pub fn learn_occlusion(&mut self, expected: f32, success: bool, steps: u32) {
        let cost = QUERY_BASE_COST + OCCLUDER_STEP_COST * steps as f32;
        self.occlusion[size(expected)].learn(success, cost);
        self.either[size(expected)].learn(success, PROBE_COST + cost);
    }

    /// Remembers how a query for visibility ended, after so many nodes and leaves.
    pub fn learn_visibility(&mut self, expected: f32, success: bool, nodes: u32) {
        let cost = QUERY_BASE_COST + NODE_COST * nodes as f32;
        self.visibility[size(expected)].learn(success, cost);
        self.either[size(expected)].learn(success, PROBE_COST + cost);
    }
}

/// Which power of two.
fn size(expected: f32) -> usize {
    (expected.max(1.0).log2() as usize).min(SIZES - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn evidence_rules_out_what_cannot_succeed() {
        let mut schedule = QuerySchedule::new(Technique::Occlusion);
        assert_eq!(
            schedule.after_evidence(Evidence::Blocked, 1.0e3),
            Queries::Occlusion
        );
        assert_eq!(
            schedule.after_evidence(Evidence::Clear, 1.0e3),
            Queries::Visibility
        );
        assert_eq!(
            schedule.after_evidence(Evidence::Mixed, 1.0e3),
            Queries::None
        );
        let mut schedule = QuerySchedule::new(Technique::Visibility);
        assert_eq!(
            schedule.after_evidence(Evidence::Blocked, 1.0e3),
            Queries::None
        );
        let mut schedule = QuerySchedule::new(Technique::Blockers);
        assert_eq!(
            schedule.after_evidence(Evidence::Mixed, 1.0e3),
            Queries::Shorten
        );
    }

    #[test]
    fn small_pairs_and_pairs_just_below_one_looked_at_are_passed_over() {
        let mut schedule = QuerySchedule::new(Technique::Occlusion);
        assert_eq!(schedule.before_split(7.0, f32::INFINITY), Queries::None);
        assert_eq!(schedule.before_split(100.0, 399.0), Queries::None);
        assert_eq!(schedule.before_split(100.0, 400.0), Queries::Probe);
    }

    #[test]
    fn where_no_query_succeeds_they_all_but_cease() {
        let mut schedule = QuerySchedule::new(Technique::Occlusion);
        let mut asked = 0;
        for _ in 0..10_000 {
            if schedule.before_split(20.0, f32::INFINITY) == Queries::Probe {
                asked += 1;
                schedule.learn_visibility(20.0, false, 8);
            }
        }
        assert!((10_000 / 66..10_000 / 40).contains(&asked), "{asked}");
        // What succeeds is asked again.
        for _ in 0..64 {
            schedule.learn_visibility(20.0, true, 8);
        }
        assert_eq!(schedule.before_split(20.0, f32::INFINITY), Queries::Probe);
    }
}
