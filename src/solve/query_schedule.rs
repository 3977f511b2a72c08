//! When a query for a guarantee is likely to pay (design, section 7, points 2 and 3).
//!
//! A proof saves the rays of every exchange below its pair, so what it may save is known beforehand. Whether it will
//! succeed is told for nothing by the exchanges before it in the walk, its neighbours in the scene: next to a mixed one
//! neither guarantee is likely, next to a clear one only visibility and next to a blocked one only occlusion; and by how
//! often queries on pairs of its size succeeded after such neighbours so far in the same task.

use super::config::Technique;
use super::queries::{Evidence, Occasion, Queries};
use super::query_record::QueryRecord;
use crate::visibility::WalkLimits;

/// Parts of a query's cost, in packets of eight rays: what every query costs, a node or full test of the occluders,
/// and a node or leaf of the scene with its polygons. Measured on d, e and f at the fixed stride (`bench/runs/`, compare).
const QUERY_BASE_COST: f32 = 0.4;
const OCCLUDER_STEP_COST: f32 = 0.05;
const NODE_COST: f32 = 0.2;
/// The same of a solid, whose test is in f64: twice that of a rectangle, by the arithmetic and not by a measurement.
const SOLID_STEP_COST: f32 = 0.1;
/// What testing a packet natively saves, in packets.
const NATIVE_GAIN: f32 = 0.25;
/// Nodes and leaves that any walk, and no walk but the paper's, may test.
const LEAST_NODES: f32 = 8.0;
const MOST_NODES: f32 = 32.0;
/// Packets to be saved from which a pair to be split is worth a query: a smaller one is an exchange at once, or nearly.
const LEAST_EXPECTED: f32 = 2.0;
/// Packets to be cast from which a pair is worth a shorter list.
const LEAST_SHORTENED: f32 = 8.0;
/// Least factor between what proofs of nested pairs may save that are both looked at.
const STRIDE_FACTOR: f32 = 2.0;
/// Pairs looked at in vain for each that is then passed over after one that is looked at, and how many at most: looking
/// costs some hundred instructions, in a walk of two thousand a pair.
const VAIN_BEFORE_REST: u32 = 8;
const MOST_REST: u32 = 15;
/// Packets spent on queries from which what they saved says whether to go on: fewer say too little, and cost too little.
const TELLING: f64 = 1_000.0;
/// Least packets saved for each that was spent: below it queries are left to the first tasks of a pass.
const LEAST_SAVED: f64 = 1.25;
/// What proofs of occlusion save of the packets that were expected: pairs that are hidden are split less than others.
/// Measured from 0.12 (the second pass of c) to 0.6 (the first of e); `bench/runs/`, compare.
const HIDDEN_SAVED: f64 = 1.0 / 3.0;
/// Sizes of pairs told apart: powers of four of the packets that a proof may save.
const SIZES: usize = 8;
/// What the last two exchanges can have been.
const HISTORIES: usize = 16;
/// Two bits of a history.
const MIXED: usize = 0;
const BLOCKED: usize = 1;
const CLEAR: usize = 2;

/// One record for each size of pair after each history.
type Records = [[QueryRecord; HISTORIES]; SIZES];

/// The schedule of one task.
#[derive(Clone, Debug)]
pub struct QuerySchedule {
    technique: Technique,
    occlusion: Records,
    visibility: Records,
    shortening: [QueryRecord; SIZES],
    /// Of solids, where no rectangle was found.
    solids: [QueryRecord; SIZES],
    history: usize,
    /// Pairs that were looked at since a query last paid.
    vain: u32,
    /// How many pairs to pass over.
    rest: u32,
    /// Packets that queries cost.
    spent: f64,
    /// Packets that were expected below pairs proved occluded.
    hidden: f64,
    /// True where queries have been found not to pay: none is asked.
    gave_up: bool,
}

impl QuerySchedule {
    /// Before anything is learned.
    pub fn new(technique: Technique) -> Self {
        Self {
            technique,
            occlusion: [[QueryRecord::PRIOR; HISTORIES]; SIZES],
            visibility: [[QueryRecord::PRIOR; HISTORIES]; SIZES],
            shortening: [QueryRecord::PRIOR; SIZES],
            solids: [QueryRecord::PRIOR; SIZES],
            history: MIXED,
            vain: 0,
            rest: 0,
            spent: 0.0,
            hidden: 0.0,
            gave_up: false,
        }
    }

    /// What several schedules learned together, to start others with. `seen` is how many packets the pairs that were
    /// proved visible would have cast.
    pub fn after<'a>(
        technique: Technique,
        schedules: impl Iterator<Item = &'a Self> + Clone,
        seen: f64,
    ) -> Self {
        let spent: f64 = schedules.clone().map(|s| s.spent).sum();
        let hidden: f64 = schedules.clone().map(|s| s.hidden).sum();
        let mean = |record: &dyn Fn(&Self) -> QueryRecord| {
            QueryRecord::after(schedules.clone().map(record))
        };
        let all = |records: fn(&Self) -> &Records| -> Records {
            std::array::from_fn(|size| {
                std::array::from_fn(|history| mean(&|s| records(s)[size][history]))
            })
        };
        Self {
            occlusion: all(|s| &s.occlusion),
            visibility: all(|s| &s.visibility),
            shortening: std::array::from_fn(|size| mean(&|s| s.shortening[size])),
            solids: std::array::from_fn(|size| mean(&|s| s.solids[size])),
            gave_up: spent >= TELLING && seen + HIDDEN_SAVED * hidden < LEAST_SAVED * spent,
            ..Self::new(technique)
        }
    }

    /// False where no pair would be asked about, however large, or where so many were looked at in vain that most
    /// are passed over.
    pub fn may_ask(&mut self) -> bool {
        if self.gave_up || self.history % 4 == MIXED && self.technique != Technique::Blockers {
            return false;
        }
        let rests = self.rest > 0;
        self.rest -= u32::from(rests);
        !rests
    }

    /// What to ask about a pair with `expected` packets to be cast below it, where the last one asked about above had
    /// `asked_at`.
    pub fn before_split(&mut self, expected: f32, asked_at: f32) -> Queries {
        if expected < LEAST_EXPECTED || expected * STRIDE_FACTOR > asked_at {
            return Queries::None;
        }
        let queries = match self.likely(expected) {
            Queries::None
                if self.technique == Technique::Blockers
                    && self.history % 4 == MIXED
                    && expected >= LEAST_SHORTENED
                    && self.shortening[size(expected)].pays(NATIVE_GAIN * expected) =>
            {
                Queries::Shorten
            }
            queries => queries,
        };
        self.vain = match queries {
            Queries::None => self.vain + 1,
            _ => 0,
        };
        self.rest = (self.vain / VAIN_BEFORE_REST).min(MOST_REST);
        queries
    }

    /// What to ask about an exchange of `packets`.
    pub fn before_exchange(&mut self, packets: f32) -> Queries {
        if self.gave_up {
            return Queries::None;
        }
        self.likely(packets)
    }

    /// The guarantee that the neighbours make likely, where asking for it pays.
    fn likely(&mut self, packets: f32) -> Queries {
        let (size, history) = (size(packets), self.history);
        match history % 4 {
            CLEAR if self.visibility[size][history].pays(packets) => Queries::Visibility,
            BLOCKED
                if self.technique.proves_occlusion()
                    && self.occlusion[size][history].pays(packets) =>
            {
                Queries::Occlusion
            }
            _ => Queries::None,
        }
    }

    /// Remembers what an exchange was found to be.
    pub fn observe(&mut self, evidence: Evidence) {
        let outcome = match evidence {
            Evidence::Blocked => BLOCKED,
            Evidence::Clear => CLEAR,
            Evidence::Mixed => MIXED,
            Evidence::Dark => return,
        };
        self.history = (4 * self.history + outcome) % HISTORIES;
    }

    /// How far a walk may go: it may cost what it can save. Walks at a fixed stride are the paper's and go to their
    /// ends.
    pub fn limits(&self, queries: Queries, occasion: Occasion) -> WalkLimits {
        match queries {
            Queries::Both => WalkLimits::default(),
            Queries::Shorten => WalkLimits {
                blocking_leaves: 6,
                nodes: 32,
            },
            _ => WalkLimits {
                nodes: occasion.packets().clamp(LEAST_NODES, MOST_NODES) as u32,
                ..WalkLimits::default()
            },
        }
    }

    /// Remembers how a query for occlusion ended, after so many nodes and full tests.
    pub fn learn_occlusion(&mut self, occasion: Occasion, success: bool, steps: u32) {
        let cost = QUERY_BASE_COST + OCCLUDER_STEP_COST * steps as f32;
        self.spent += f64::from(cost);
        if success {
            self.hidden += f64::from(occasion.packets());
        }
        self.occlusion[size(occasion.packets())][self.history].learn(success, cost);
    }

    /// Whether to look for a solid where no rectangle hides a pair.
    pub fn solids_may_pay(&mut self, occasion: Occasion) -> bool {
        self.solids[size(occasion.packets())].pays(occasion.packets())
    }

    /// Remembers how a query for a solid ended, after so many nodes and full tests.
    pub fn learn_solids(&mut self, occasion: Occasion, success: bool, steps: u32) {
        let cost = SOLID_STEP_COST * (1 + steps) as f32;
        self.spent += f64::from(cost);
        self.solids[size(occasion.packets())].learn(success, cost);
    }

    /// Remembers how a walk through the shaft ended, after so many nodes and leaves.
    pub fn learn_walk(&mut self, queries: Queries, occasion: Occasion, success: bool, nodes: u32) {
        let cost = QUERY_BASE_COST + NODE_COST * nodes as f32;
        self.spent += f64::from(cost);
        let size = size(occasion.packets());
        match queries {
            Queries::Shorten => self.shortening[size].learn(success, cost),
            _ => self.visibility[size][self.history].learn(success, cost),
        }
    }
}

/// Which power of four: half of the binary exponent.
fn size(packets: f32) -> usize {
    let exponent = (packets.max(1.0).to_bits() >> (f32::MANTISSA_DIGITS - 1)) as usize;
    ((exponent + 1 - f32::MAX_EXP as usize) / 2).min(SIZES - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(technique: Technique, evidence: &[Evidence]) -> QuerySchedule {
        let mut schedule = QuerySchedule::new(technique);
        for &e in evidence {
            schedule.observe(e);
        }
        schedule
    }

    #[test]
    fn neighbours_rule_out_what_is_not_likely() {
        use Evidence::{Blocked, Clear, Dark, Mixed};
        let asked = |technique, evidence: &[Evidence]| {
            after(technique, evidence).before_split(100.0, f32::INFINITY)
        };
        assert_eq!(asked(Technique::Occlusion, &[]), Queries::None);
        assert_eq!(asked(Technique::Occlusion, &[Blocked]), Queries::Occlusion);
        assert_eq!(asked(Technique::Occlusion, &[Clear]), Queries::Visibility);
        assert_eq!(asked(Technique::Occlusion, &[Clear, Mixed]), Queries::None);
        assert_eq!(
            asked(Technique::Occlusion, &[Mixed, Clear, Dark]),
            Queries::Visibility
        );
        assert_eq!(asked(Technique::Visibility, &[Blocked]), Queries::None);
        assert_eq!(asked(Technique::Blockers, &[Mixed]), Queries::Shorten);
    }

    #[test]
    fn small_pairs_and_pairs_just_below_one_looked_at_are_passed_over() {
        let asked = |expected, asked_at| {
            after(Technique::Occlusion, &[Evidence::Clear]).before_split(expected, asked_at)
        };
        assert_eq!(asked(1.9, f32::INFINITY), Queries::None);
        assert_eq!(asked(100.0, 199.0), Queries::None);
        assert_eq!(asked(100.0, 200.0), Queries::Visibility);
    }

    #[test]
    fn where_nothing_pays_most_pairs_are_passed_over_until_something_does() {
        let mut schedule = after(Technique::Occlusion, &[Evidence::Blocked]);
        let split = Occasion::Split(100.0);
        let looked_at = |schedule: &mut QuerySchedule, success: bool| -> u32 {
            let look = |_| {
                let looks = schedule.may_ask();
                if looks && schedule.before_split(100.0, f32::INFINITY) != Queries::None {
                    schedule.learn_occlusion(split, success, 100);
                }
                u32::from(looks)
            };
            (0..1_600).map(look).sum()
        };
        looked_at(&mut schedule, false);
        let barren = looked_at(&mut schedule, false);
        assert!((100..130).contains(&barren), "{barren}");
        for _ in 0..64 {
            schedule.learn_occlusion(split, true, 1);
        }
        assert!(looked_at(&mut schedule, true) > 1_580);
    }

    #[test]
    fn where_the_first_tasks_gained_nothing_the_others_do_not_ask() {
        let spent = |queries: u32, success: bool| {
            let mut schedule = after(Technique::Occlusion, &[Evidence::Blocked]);
            for _ in 0..queries {
                schedule.learn_occlusion(Occasion::Split(10.0), success, 12);
            }
            schedule
        };
        let asks = |learned: &QuerySchedule, seen: f64| {
            let schedules = std::iter::once(learned);
            let mut others = QuerySchedule::after(Technique::Occlusion, schedules, seen);
            others.observe(Evidence::Clear);
            let look = others.may_ask();
            // Asked again and again, since a single exchange is asked about only now and then.
            let asked = (0..100).any(|_| others.before_exchange(8.0) != Queries::None);
            assert_eq!(look, asked);
            look
        };
        // Each costs one packet; of ten that a proof hides a third was saved.
        assert!(asks(&spent(900, false), 0.0), "too few to tell");
        assert!(!asks(&spent(1_100, false), 0.0));
        assert!(asks(&spent(1_100, true), 0.0));
        assert!(!asks(&spent(1_100, false), 1_300.0));
        assert!(asks(&spent(1_100, false), 1_500.0));
    }

    #[test]
    fn a_single_exchange_is_asked_about_once_experience_says_that_it_pays() {
        let mut schedule = after(Technique::Occlusion, &[Evidence::Blocked]);
        let exchange = Occasion::Exchange(1.2);
        assert_eq!(schedule.before_exchange(1.2), Queries::None);
        for _ in 0..64 {
            schedule.learn_occlusion(exchange, true, 3);
        }
        assert_eq!(schedule.before_exchange(1.2), Queries::Occlusion);
        // Not for what happened after other neighbours.
        schedule.observe(Evidence::Blocked);
        assert_eq!(schedule.before_exchange(1.2), Queries::None);
    }

    #[test]
    fn sizes_are_powers_of_four() {
        let sizes = [0.0, 1.2, 3.9, 4.1, 17.0, 1.0e30].map(size);
        assert_eq!(sizes, [0, 0, 0, 1, 2, SIZES - 1]);
    }
}
