//! One task's guaranteed tests: when to ask, what to hand down (paper, section 5.3).
//!
//! Full occlusion is asked first, and ends a pair; then full visibility, which all pairs below
//! inherit. What is left of the scene in a pair's shaft is handed down to them as a list.

use super::config::{SolveConfig, Stride, Technique};
use super::element::Element;
use super::guarantees::Guarantees;
use super::statistics::PassStatistics;
use crate::visibility::{
    BlockerList, OcclusionScratch, SurvivorList, Verdict, VisibilityQuery, VisibilityScratch,
    WalkLimits,
};

/// What is known of a pair by the pairs above it.
#[derive(Clone, Copy, Debug)]
pub struct Knowledge {
    /// Proved for a pair above, or for this one.
    pub verdict: Verdict,
    /// How many splits lie above.
    level: u32,
    /// Which of the task's lists holds what may block.
    list: u32,
}

impl Knowledge {
    /// Of the topmost pair.
    pub const NOTHING: Self = Self {
        verdict: Verdict::Unknown,
        level: 0,
        list: 0,
    };

    /// Of a pair one split further down.
    #[must_use]
    pub fn below(self) -> Self {
        Self {
            level: self.level + 1,
            ..self
        }
    }
}

/// What a query found.
#[derive(Clone, Copy, Debug)]
pub struct Proof {
    /// What is known now.
    pub knowledge: Knowledge,
    /// The occluder of a pair proved occluded.
    pub occluder: Option<u32>,
}

/// The guaranteed tests of one task.
pub struct Prover<'a> {
    guarantees: &'a Guarantees,
    query: VisibilityQuery<'a>,
    technique: Technique,
    stride: Stride,
    /// Lists in use, one nested in the other.
    lists: Vec<SurvivorList>,
    last_occluder: Option<u32>,
    occlusion: OcclusionScratch,
    visibility: VisibilityScratch,
    blockers: BlockerList,
}

impl<'a> Prover<'a> {
    /// Ready for the topmost pair; `None` for techniques that prove nothing.
    pub fn new(guarantees: Option<&'a Guarantees>, config: &SolveConfig) -> Option<Self> {
        let guarantees = guarantees.filter(|_| config.technique.proves_visibility())?;
        Some(Self {
            guarantees,
            query: VisibilityQuery::new(&guarantees.scene),
            technique: config.technique,
            stride: config.stride,
            lists: vec![guarantees.whole_scene.clone()],
            last_occluder: None,
            occlusion: OcclusionScratch::default(),
            visibility: VisibilityScratch::default(),
            blockers: BlockerList::new(&guarantees.scene),
        })
    }

    /// Asks about a pair that is about to be split, if its level is one at which to ask.
    pub fn before_split(
        &mut self,
        source: &Element,
        receiver: &Element,
        knowledge: Knowledge,
        statistics: &mut PassStatistics,
    ) -> Proof {
        let due = match self.stride {
            Stride::Every(levels) => knowledge.level.is_multiple_of(levels),
            Stride::Auto => true,
        };
        // A pair that shares surface has neither a plane between its ends nor an empty shaft.
        if !due || knowledge.verdict != Verdict::Unknown || source.overlaps(receiver) {
            return Proof {
                knowledge,
                occluder: None,
            };
        }
        self.ask(source, receiver, knowledge, statistics)
    }

    /// Asks about a pair that is about to exchange.
    pub fn before_exchange(
        &mut self,
        source: &Element,
        receiver: &Element,
        knowledge: Knowledge,
        statistics: &mut PassStatistics,
    ) -> Proof {
        if knowledge.verdict != Verdict::Unknown {
            return Proof {
                knowledge,
                occluder: None,
            };
        }
        self.ask(source, receiver, knowledge, statistics)
    }

    fn ask(
        &mut self,
        source: &Element,
        receiver: &Element,
        knowledge: Knowledge,
        statistics: &mut PassStatistics,
    ) -> Proof {
        statistics.shafts += 1;
        let (a, b) = (source.shaft_bounds(), receiver.shaft_bounds());
        let mut known = knowledge;
        if self.technique.proves_occlusion() {
            let answer = self.guarantees.occluders.query(
                &a,
                &b,
                &mut self.last_occluder,
                &mut self.occlusion,
            );
            if answer.occluder.is_some() {
                statistics.occluded_claims += 1;
                known.verdict = Verdict::Occluded;
                return Proof {
                    knowledge: known,
                    occluder: answer.occluder,
                };
            }
        }
        let next = knowledge.list as usize + 1;
        if self.lists.len() == next {
            self.lists.push(SurvivorList::new());
        }
        let (above, below) = self.lists.split_at_mut(next);
        let answer = self.query.run(
            &a,
            &b,
            &above[next - 1],
            &mut below[0],
            WalkLimits::default(),
            &mut self.visibility,
        );
        known.list = next as u32;
        known.verdict = answer.verdict;
        statistics.visible_claims += u64::from(answer.verdict == Verdict::Visible);
        Proof {
            knowledge: known,
            occluder: None,
        }
    }

    /// The few polygons that may block a pair, or `None` if they are many.
    pub fn blockers(&mut self, knowledge: Knowledge) -> Option<&BlockerList> {
        let list = &self.lists[knowledge.list as usize];
        self.blockers
            .fill(&self.guarantees.scene, list, MOST_BLOCKERS)
            .then_some(&self.blockers)
    }
}

/// Polygons up to which testing eight segments natively is cheaper than asking Embree.
const MOST_BLOCKERS: usize = 8;
