//! One task's guaranteed tests: when to ask, what to hand down (paper, section 5.3; design, section 7).
//!
//! Full occlusion is asked first, and ends a pair; then full visibility, which all pairs below
//! inherit. What is left of the scene in a pair's shaft is handed down to them as a list.

use super::config::{SolveConfig, Stride, Technique};
use super::element::{Element, Shape};
use super::guarantees::Guarantees;
use super::queries::{Evidence, Occasion, Queries};
use super::query_schedule::QuerySchedule;
use super::statistics::PassStatistics;
use crate::math::Aabb;
use crate::visibility::{
    BlockerList, ElementBounds, NearbyBoxes, OcclusionScratch, SurvivorList, Verdict,
    VisibilityQuery, VisibilityScratch,
};

/// What is known of a pair by the pairs above it.
#[derive(Clone, Copy, Debug)]
pub struct Knowledge {
    /// Proved for a pair above, or for this one.
    pub verdict: Verdict,
    /// How many splits lie above.
    pub(super) level: u32,
    /// Which of the task's lists holds what may block.
    list: u32,
    /// Packets of rays that a proof could have saved below the pair that was last asked about.
    asked_at: f32,
}

impl Knowledge {
    /// The same, but visible.
    #[must_use]
    pub fn visible(self) -> Self {
        Self {
            verdict: Verdict::Visible,
            ..self
        }
    }

    /// Of the topmost pair.
    pub const NOTHING: Self = Self {
        verdict: Verdict::Unknown,
        level: 0,
        list: 0,
        asked_at: f32::INFINITY,
    };
}

/// What a query found.
#[derive(Clone, Copy, Debug)]
pub struct Proof {
    /// What is known now.
    pub knowledge: Knowledge,
    /// What hides the pair.
    pub hiding: Hiding,
}

/// What hides a pair.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hiding {
    /// The occluder of a pair proved occluded.
    pub occluder: Option<u32>,
    /// Some occluder crosses the segment between the centres, so several may hide what none hides alone.
    pub may_hide: bool,
}

impl Proof {
    /// Nothing new.
    pub fn none(knowledge: Knowledge) -> Self {
        Self {
            knowledge,
            hiding: Hiding::default(),
        }
    }
}

/// A list of what may block, and its polygons prepared for segments.
#[derive(Clone, Debug)]
struct Remaining {
    survivors: SurvivorList,
    blockers: BlockerList,
    /// Whether `blockers` holds the list; `None` until someone asks.
    is_short: Option<bool>,
}

impl Remaining {
    /// True where the list holds few polygons, which are then prepared.
    fn is_short(&mut self, guarantees: &Guarantees) -> bool {
        *self.is_short.get_or_insert_with(|| {
            self.survivors.len() <= MOST_BLOCKERS
                && self
                    .blockers
                    .fill(&guarantees.scene, &self.survivors, MOST_BLOCKERS)
        })
    }
}

/// The guaranteed tests of one task.
pub struct Prover<'a> {
    guarantees: &'a Guarantees,
    query: VisibilityQuery<'a>,
    technique: Technique,
    stride: Stride,
    /// Lists in use, one nested in the other.
    lists: Vec<Remaining>,
    last_occluder: Option<u32>,
    occlusion: OcclusionScratch,
    visibility: VisibilityScratch,
    schedule: QuerySchedule,
    /// Empty boxes that reach the task's receivers.
    boxes: NearbyBoxes,
}

impl<'a> Prover<'a> {
    /// Ready for the topmost pair; `None` for techniques that prove nothing.
    /// `schedule` holds what other tasks learned; all receivers lie in `receivers`.
    pub fn new(
        guarantees: Option<&'a Guarantees>,
        config: &SolveConfig,
        schedule: &QuerySchedule,
        receivers: Aabb,
    ) -> Option<Self> {
        let guarantees = guarantees.filter(|_| config.technique.proves_visibility())?;
        let mut prover = Self {
            guarantees,
            query: guarantees.visibility_query(),
            technique: config.technique,
            stride: config.stride,
            lists: Vec::new(),
            last_occluder: None,
            occlusion: OcclusionScratch::default(),
            visibility: VisibilityScratch::default(),
            schedule: schedule.clone(),
            boxes: match config.stride {
                Stride::Auto => guarantees.empty_boxes.near(receivers),
                // The paper's schedule, as the paper has it.
                Stride::Every(_) => NearbyBoxes::default(),
            },
        };
        prover.make_list(0);
        prover.lists[0].survivors = guarantees.whole_scene.clone();
        Some(prover)
    }

    /// Whether any box of air may hold a pair.
    pub fn has_air(&self) -> bool {
        self.boxes.any()
    }

    /// Whether a box of air holds the pair, of which nothing was known: then it is proved visible.
    pub fn finds_air(&self, source: &Element, receiver: &Element, knowledge: Knowledge) -> bool {
        // Nothing holds the boxes of what volume clusters bundle.
        knowledge.verdict == Verdict::Unknown
            && source.shape != Shape::Volume
            && receiver.shape != Shape::Volume
            && self.boxes.hold(source.bounds, receiver.bounds)
    }

    /// Whether a pair that is about to be split may be asked about, of which nothing was known; `is_played` if it has won
    /// a lot. Says so of most pairs at next to no cost.
    #[inline(always)]
    pub fn may_ask(&mut self, knowledge: Knowledge, is_played: bool) -> bool {
        match self.stride {
            Stride::Every(levels) => knowledge.level.is_multiple_of(levels),
            // A pair that has been played for is worth about one exchange, which is no query's price.
            Stride::Auto => !is_played && self.schedule.may_ask(),
        }
    }

    /// What to ask about a pair that is about to be split and that [`Self::may_ask`] let pass. `expected` is how many
    /// packets of eight rays are likely to be cast below it, given the gap between its ends; worked out only where the
    /// answer hangs on it.
    pub fn plan_before_split(
        &mut self,
        source: &Element,
        receiver: &Element,
        knowledge: Knowledge,
        expected: impl FnOnce(f32) -> f32,
    ) -> (Queries, Occasion) {
        let never = (Queries::None, Occasion::Split(0.0));
        // A pair that shares surface has neither a plane between its ends nor an empty shaft.
        if source.overlaps(receiver) {
            return never;
        }
        let gap = source.bounds.distance(receiver.bounds);
        // Boxes that meet are rarely parted by one plane, and each is in the other's way.
        if gap <= 0.0 && self.stride == Stride::Auto {
            return never;
        }
        let expected = expected(gap);
        let queries = match self.stride {
            Stride::Every(_) => Queries::Both,
            Stride::Auto => self.schedule.before_split(expected, knowledge.asked_at),
        };
        (queries, Occasion::Split(expected))
    }

    /// What to ask about a pair that is about to exchange.
    /// `packets` of eight rays are what a proof would save.
    pub fn plan_before_exchange(&mut self, knowledge: Knowledge, packets: f32) -> Queries {
        match self.stride {
            _ if knowledge.verdict != Verdict::Unknown => Queries::None,
            Stride::Every(_) => Queries::Both,
            Stride::Auto => self.schedule.before_exchange(packets),
        }
    }

    /// Takes note of what an exchange was found to be.
    pub fn observe(&mut self, evidence: Evidence) {
        self.schedule.observe(evidence);
    }

    /// Asks for guarantees about a pair.
    pub fn ask(
        &mut self,
        source: &Element,
        receiver: &Element,
        knowledge: Knowledge,
        queries: Queries,
        occasion: Occasion,
        statistics: &mut PassStatistics,
    ) -> Proof {
        let mut known = knowledge;
        if let Occasion::Split(expected) = occasion {
            known.asked_at = expected;
        }
        if queries == Queries::None {
            return Proof::none(known);
        }
        statistics.shafts += 1;
        let (a, b) = (source.shaft_bounds(), receiver.shaft_bounds());
        let mut hiding = Hiding::default();
        if queries.occlusion() && self.technique.proves_occlusion() {
            hiding = self.find_occluder(&a, &b, occasion);
            if hiding.occluder.is_some() {
                statistics.occluded_claims += 1;
                known.verdict = Verdict::Occluded;
                return Proof {
                    knowledge: known,
                    hiding,
                };
            }
        }
        if !queries.visibility() {
            return Proof {
                knowledge: known,
                hiding,
            };
        }
        let next = knowledge.list as usize + 1;
        if self.lists.len() == next {
            self.make_list(next);
        }
        let (above, below) = self.lists.split_at_mut(next);
        let answer = self.query.run(
            &a,
            &b,
            &above[next - 1].survivors,
            &mut below[0].survivors,
            self.schedule.limits(queries, occasion),
            &mut self.visibility,
        );
        below[0].is_short = None;
        let visible = answer.verdict == Verdict::Visible;
        let success = visible || queries == Queries::Shorten && below[0].is_short(self.guarantees);
        self.schedule
            .learn_walk(queries, occasion, success, answer.nodes);
        known.list = next as u32;
        known.verdict = answer.verdict;
        statistics.visible_claims += u64::from(visible);
        Proof {
            knowledge: known,
            hiding,
        }
    }

    /// A planted fault.
    pub fn forgets_a_part(&self) -> bool {
        self.guarantees.occluders.forgets_a_part()
    }

    /// What hides a part of a pair that was asked about before it exchanges.
    pub fn occluder_between(&mut self, source: &Element, receiver: &Element) -> Hiding {
        let (a, b) = (source.shaft_bounds(), receiver.shaft_bounds());
        self.find_occluder(&a, &b, Occasion::Exchange(1.0))
    }

    /// A rectangle, or where that may pay a solid, that hides the pair.
    fn find_occluder(
        &mut self,
        a: &ElementBounds,
        b: &ElementBounds,
        occasion: Occasion,
    ) -> Hiding {
        let (tree, last) = (&self.guarantees.occluders, &mut self.last_occluder);
        let rectangles = tree.query(a, b, last, &mut self.occlusion);
        let mut found = rectangles.occluder;
        let mut steps = rectangles.nodes + rectangles.tests;
        let asks = match self.stride {
            Stride::Every(_) => true,
            Stride::Auto => self.schedule.solids_may_pay(occasion),
        };
        if found.is_none() && rectangles.centre_blocked && asks {
            let solids = tree.query_solids(a, b, last, &mut self.occlusion);
            let own = solids.nodes + solids.tests;
            found = solids.occluder;
            steps += own;
            self.schedule.learn_solids(occasion, found.is_some(), own);
        }
        self.schedule
            .learn_occlusion(occasion, found.is_some(), steps);
        Hiding {
            occluder: found,
            may_hide: rectangles.centre_blocked,
        }
    }

    /// The few polygons that may block a pair, or `None` if they are many.
    pub fn blockers(&mut self, knowledge: Knowledge) -> Option<&BlockerList> {
        let remaining = &mut self.lists[knowledge.list as usize];
        remaining
            .is_short(self.guarantees)
            .then_some(&remaining.blockers)
    }

    /// What was learned of queries.
    pub fn into_schedule(self) -> QuerySchedule {
        self.schedule
    }

    fn make_list(&mut self, index: usize) {
        debug_assert_eq!(self.lists.len(), index);
        self.lists.push(Remaining {
            survivors: SurvivorList::new(),
            blockers: BlockerList::new(&self.guarantees.scene),
            is_short: None,
        });
    }
}

/// Polygons up to which testing eight segments natively is cheaper than asking Embree.
const MOST_BLOCKERS: usize = 16;
