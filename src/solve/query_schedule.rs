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

    /// True if the mean gain exceeds the mean cost; now and then in any case, lest a bad start lasts.
    fn pays(&mut self, gain: f32) -> bool {
        let pays = self.successes * gain > self.cost;
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
/// Queries left out in a row before one is made all the same.
const RETRY_AFTER: u32 = 64;
/// Sizes of pairs told apart: powers of two of the packets that a proof may save.
const SIZES: usize = 16;
/// Cost of eight probe rays and of a query, in packets of eight rays.
const PROBE_COST: f32 = 1.0;
const QUERY_COST: f32 = 1.5;
/// Parts of a query's cost, in packets of eight rays: what every query costs, a node or full test of the occluders,
/// and a node or leaf of the scene with its polygons.
const QUERY_BASE_COST: f32 = 0.5;
const OCCLUDER_STEP_COST: f32 = 0.05;
const NODE_COST: f32 = 1.5;
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
                blocking_leaves: 4,
                nodes: nodes.min(64),
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
