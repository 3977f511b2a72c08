//! When a query for a guarantee is likely to pay (design, section 7, points 2 and 3).
//!
//! A proof saves the rays of every exchange below its pair, so what it may save is known beforehand. Whether it will
//! succeed is told for nothing by the exchanges before it in the walk, its neighbours in the scene: next to a mixed one
//! neither guarantee is likely, next to a clear one only visibility and next to a blocked one only occlusion; and by how
//! often queries on pairs of its size succeeded after such neighbours so far in the same task.

use super::config::Technique;
use super::queries::{Evidence, Occasion, Queries};
use super::query_record::QueryRecord;
use crate::visibility::{Account, WalkLimits};

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
/// Packets spent from which what was saved says whether to go on: on queries, of which few are dear, and on tests of single
/// rays, of which there are many.
const TELLING: f64 = 1_000.0;
const TELLING_OF_RAYS: f64 = 50.0;
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
/// What proofs of occlusion save of the packets that come below pairs of the same size that nothing is found to hide.
/// Measured: 0.3 of that in the second pass of c, 0.7 in its first, 1.3 in the first of b, 2.2 in the first of a real
/// building (duplex; `bench/runs/`, compare). Asking in vain costs a few hundredths of a pass, not asking lost a third of one, so
/// it is rather much.
const HIDDEN_SAVED: f64 = 1.15;
/// Sizes of pairs told apart: powers of four of the packets that a proof may save.
pub(super) const SIZES: usize = 8;
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
    /// Of queries for occlusion; as saved count the single exchanges that they proved occluded, and in the end what `hidden`
    /// comes to.
    occluded: Account,
    /// Packets that were expected below pairs proved occluded, by size.
    hidden: [f64; SIZES],
    /// Packets that were expected below pairs of which it was asked in vain what hides them, and those that were cast
    /// there; by size.
    expected: [f64; SIZES],
    cast: [f64; SIZES],
    /// Of walks for visibility; as saved count the exchanges that they proved visible.
    visible: Account,
    /// Of walks for shorter lists; as saved counts what was tested natively.
    shortened: Account,
    /// Which queries are still asked: all, but where the first tasks of a pass found that a kind does not pay.
    asks_occlusion: bool,
    asks_visibility: bool,
    asks_shortening: bool,
    /// Of rectangles that blocked before, tried on single rays.
    screened: Account,
    screens_rays: bool,
}

impl QuerySchedule {
    /// Before anything is learned.
    pub fn new(technique: Technique) -> Self {
        Self {
            occlusion: [[QueryRecord::PRIOR; HISTORIES]; SIZES],
            visibility: [[QueryRecord::PRIOR; HISTORIES]; SIZES],
            shortening: [QueryRecord::PRIOR; SIZES],
            solids: [QueryRecord::PRIOR; SIZES],
            history: MIXED,
            vain: 0,
            rest: 0,
            occluded: Account::default(),
            hidden: [0.0; SIZES],
            expected: [0.0; SIZES],
            cast: [0.0; SIZES],
            visible: Account::default(),
            shortened: Account::default(),
            asks_occlusion: technique.proves_occlusion(),
            asks_visibility: true,
            asks_shortening: technique == Technique::Blockers,
            screened: Account::default(),
            screens_rays: technique == Technique::Blockers,
        }
    }

    /// What several schedules learned together, to start others with.
    pub fn after<'a>(
        technique: Technique,
        schedules: impl Iterator<Item = &'a Self> + Clone,
    ) -> Self {
        let sum = |of: fn(&Self) -> Account| Account::sum(schedules.clone().map(of));
        let total = |of: &dyn Fn(&Self) -> f64| -> f64 { schedules.clone().map(of).sum() };
        let mut occluded = sum(|s| s.occluded);
        // What proofs hid, had as much come of it as came below pairs of the same size that nothing was found to hide.
        for size in 0..SIZES {
            let expected = total(&|s| s.expected[size]);
            let came = match expected > 0.0 {
                true => total(&|s| s.cast[size]) / expected,
                false => 1.0,
            };
            occluded.saved += HIDDEN_SAVED * came * total(&|s| s.hidden[size]);
        }
        let new = Self::new(technique);
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
            asks_occlusion: new.asks_occlusion && occluded.pays(TELLING),
            asks_visibility: new.asks_visibility && sum(|s| s.visible).pays(TELLING),
            asks_shortening: new.asks_shortening && sum(|s| s.shortened).pays(TELLING),
            screens_rays: new.screens_rays && sum(|s| s.screened).pays(TELLING_OF_RAYS),
            ..new
        }
    }

    /// True where no query is asked.
    pub fn gave_up(&self) -> bool {
        !(self.asks_occlusion || self.asks_visibility || self.asks_shortening)
    }

    /// Whether single rays are held against the rectangles that blocked before.
    pub fn screens_rays(&self) -> bool {
        self.screens_rays
    }

    /// Remembers what that cost and saved.
    pub fn book_screened(&mut self, account: Account) {
        self.screened = account;
    }

    /// False where no pair would be asked about, however large, or where so many were looked at in vain that most
    /// are passed over.
    pub fn may_ask(&mut self) -> bool {
        let asks = match self.history % 4 {
            BLOCKED => self.asks_occlusion,
            CLEAR => self.asks_visibility,
            _ => self.asks_shortening,
        };
        if !asks {
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
                if self.asks_shortening
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
        self.likely(packets)
    }

    /// The guarantee that the neighbours make likely, where asking for it pays.
    fn likely(&mut self, packets: f32) -> Queries {
        let (size, history) = (size(packets), self.history);
        match history % 4 {
            CLEAR if self.asks_visibility && self.visibility[size][history].pays(packets) => {
                Queries::Visibility
            }
            BLOCKED if self.asks_occlusion && self.occlusion[size][history].pays(packets) => {
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
        self.occluded.spent += f64::from(cost);
        match occasion {
            Occasion::Split(expected) if success => {
                self.hidden[size(expected)] += f64::from(expected)
            }
            Occasion::Exchange(packets) if success => self.occluded.saved += f64::from(packets),
            _ => {}
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
        self.occluded.spent += f64::from(cost);
        self.solids[size(occasion.packets())].learn(success, cost);
    }

    /// Remembers how a walk through the shaft ended, after so many nodes and leaves.
    pub fn learn_walk(&mut self, queries: Queries, occasion: Occasion, success: bool, nodes: u32) {
        let cost = QUERY_BASE_COST + NODE_COST * nodes as f32;
        let size = size(occasion.packets());
        match queries {
            Queries::Shorten => {
                self.shortened.spent += f64::from(cost);
                self.shortening[size].learn(success, cost);
            }
            _ => {
                self.visible.spent += f64::from(cost);
                self.visibility[size][self.history].learn(success, cost);
            }
        }
    }

    /// Remembers what was cast below a pair of which it was asked in vain what hides it.
    pub fn book_below(&mut self, expected: f32, packets: f32) {
        self.expected[size(expected)] += f64::from(expected);
        self.cast[size(expected)] += f64::from(packets);
    }

    /// Remembers an exchange of `packets` that needed no rays since a walk proved it visible.
    pub fn book_visible(&mut self, packets: f32) {
        self.visible.saved += f64::from(packets);
    }

    /// Remembers packets that were tested natively.
    pub fn book_native(&mut self, packets: f32) {
        self.shortened.saved += f64::from(NATIVE_GAIN * packets);
    }
}

/// Which power of four: half of the binary exponent.
pub(super) fn size(packets: f32) -> usize {
    let exponent = (packets.max(1.0).to_bits() >> (f32::MANTISSA_DIGITS - 1)) as usize;
    ((exponent + 1 - f32::MAX_EXP as usize) / 2).min(SIZES - 1)
}
