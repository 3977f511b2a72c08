//! One task's guaranteed tests: when to ask, what to hand down (paper, section 5.3; design, section 7).
//!
//! Full occlusion is asked first, and ends a pair; then full visibility, which all pairs below
//! inherit. What is left of the scene in a pair's shaft is handed down to them as a list.

use super::claims::HiddenBy;
use super::config::{SolveConfig, Stride, Technique};
use super::element::{Element, Shape};
use super::guarantees::Guarantees;
use super::knowledge::{Hiding, Knowledge, Proof};
use super::queries::{Evidence, Occasion, Queries};
use super::query_schedule::QuerySchedule;
use super::statistics::PassStatistics;
use crate::math::Aabb;
use crate::visibility::{
    AirBetween, BlockerList, ElementBounds, NearbyBoxes, OcclusionScratch, SurfaceQuery,
    SurfaceScratch, SurvivorList, Verdict, VisibilityQuery, VisibilityScratch,
};

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
    /// Under a fixed stride, which asks for all that can be proved, surfaces of any shape as well: they take microseconds.
    surfaces: Option<Surfaces<'a>>,
}

struct Surfaces<'a> {
    query: SurfaceQuery<'a>,
    scratch: SurfaceScratch,
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
        let boxes = match config.stride {
            Stride::Auto => guarantees.empty_boxes.near(receivers),
            // The paper's schedule, as the paper has it.
            Stride::Every(_) => NearbyBoxes::default(),
        };
        // Where the whole scene is a short list, that is tested natively.
        let is_small = || guarantees.scene.polygons().nth(MOST_BLOCKERS).is_none();
        let is_idle = config.stride == Stride::Auto && schedule.gave_up() && !boxes.any();
        if is_idle && !(config.technique == Technique::Blockers && is_small()) {
            return None;
        }
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
            boxes,
            surfaces: (config.stride != Stride::Auto && config.technique.proves_occlusion()).then(
                || Surfaces {
                    query: guarantees.surface_query(),
                    scratch: SurfaceScratch::default(),
                },
            ),
        };
        prover.make_list(0);
        prover.lists[0].survivors = guarantees.whole_scene.clone();
        Some(prover)
    }

    /// Whether a box of air may hold the pair.
    #[inline(always)]
    pub fn may_find_air(&self, source: &Element, receiver: &Element, knowledge: Knowledge) -> bool {
        // Nothing holds the boxes of what volume clusters bundle.
        self.boxes.any()
            && knowledge.verdict == Verdict::Unknown
            && source.shape != Shape::Volume
            && receiver.shape != Shape::Volume
    }

    /// Whether a box of air holds the pair that [`Self::may_find_air`] let pass: then it is proved visible.
    pub fn finds_air(&self, source: &Element, receiver: &Element) -> bool {
        self.boxes.hold(source.bounds, receiver.bounds)
    }

    /// The boxes of air that reach to both ends of a pair.
    #[inline]
    pub fn air_between(&self, source: &Element, receiver: &Element) -> Option<AirBetween<'_>> {
        self.boxes.between(source.bounds, receiver.bounds)
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

    /// Takes note of an exchange of `packets` that was proved visible.
    pub fn book_visible(&mut self, knowledge: Knowledge, packets: f32) {
        if !knowledge.by_air {
            self.schedule.book_visible(packets);
        }
    }

    /// Takes note of what was cast below a pair of which a query found in vain what hides it, where so many packets were
    /// `expected`.
    pub fn book_below(&mut self, expected: f32, packets: f32) {
        self.schedule.book_below(expected, packets);
    }

    /// Takes note of packets that were tested natively.
    pub fn book_native(&mut self, packets: f32) {
        self.schedule.book_native(packets);
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
            // Parts of a pair are not asked about: 0.1 to 2 points more for half as much time again (`bench/runs/`, audit).
            if hiding.by.is_none() && matches!(occasion, Occasion::Exchange(_)) {
                let surface = self.find_surface(&a, &b);
                hiding.by = surface.by;
                hiding.may_hide |= surface.may_hide;
            }
            if hiding.by.is_some() {
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
            by: found.map(HiddenBy::Occluder),
            may_hide: rectangles.centre_blocked,
        }
    }

    /// A surface that hides a pair that is about to exchange and that no occluder hides.
    fn find_surface(&mut self, a: &ElementBounds, b: &ElementBounds) -> Hiding {
        let Some(surfaces) = &mut self.surfaces else {
            return Hiding::default();
        };
        let answer = surfaces.query.run(a, b, &mut surfaces.scratch);
        Hiding {
            by: answer.surface.map(HiddenBy::Surface),
            may_hide: answer.probe_blocked,
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
