//! One task of a pass: an owner's receivers, what it knows of its pairs, and when it asks for guarantees (paper,
//! section 5.3).

use super::claim_check::ClaimCheck;
use super::claims::{Claim, ClaimSample, HiddenBy};
use super::config::Stride;
use super::element::Element;
use super::knowledge::Proof;
use super::pair::{Known, Receiver, Source, exchange_key};
use super::pass_context::Pass;
use super::prover::Prover;
use super::queries::{Evidence, Occasion, Queries};
use super::query_schedule::QuerySchedule;
use super::radiosity::Gatherer;
use super::statistics::PassStatistics;
use crate::cluster::NodeKind;
use crate::math::NodeId;
use crate::visibility::{SampledVisibility, ShadowCache, Verdict};
use glam::Vec3;

/// Packets of eight rays that an exchange casts: schedules weigh queries in packets. Some exchanges cast a second
/// set of samples; a packet that is not full costs less than a whole one, but its traversal at least.
pub(super) fn packets_of_exchange(rays: u32) -> f32 {
    let (begun, full) = (rays.div_ceil(8) as f32, rays as f32 / 8.0);
    1.2 * 0.5 * (begun + full)
}

/// What a pass did.
#[derive(Clone, Debug, Default)]
pub struct PassOutcome {
    /// Counts; `seconds` and `unshot` are left to the caller.
    pub statistics: PassStatistics,
    /// True when the observer asked to stop: the light is then worth nothing.
    pub interrupted: bool,
    /// Claims kept for an audit.
    pub claims: ClaimSample,
    /// What the rays of claimed exchanges said, where they were cast.
    pub check: ClaimCheck,
    /// Exchanges kept whose rays were all blocked.
    pub blocked: ClaimSample,
}

/// One owner's share of a pass.
pub(super) struct Task<'a, 'g, const C: usize> {
    pub(super) pass: &'a Pass<'a, C>,
    pub(super) gatherer: &'g mut Gatherer<C>,
    pub(super) prover: Option<Prover<'a>>,
    pub(super) outcome: PassOutcome,
    /// Segments of the exchange that is being checked; empty in between.
    pub(super) segments: Vec<(Vec3, Vec3, bool)>,
    /// Where the technique tests rays natively and has occluders: those that blocked last.
    pub(super) shadow_cache: Option<ShadowCache>,
    pub(super) visits: u32,
    counts_rays: bool,
}

impl<'a, 'g, const C: usize> Task<'a, 'g, C> {
    pub(super) fn new(
        pass: &'a Pass<'a, C>,
        gatherer: &'g mut Gatherer<C>,
        schedule: &QuerySchedule,
    ) -> Self {
        let receivers = pass.context.elements[gatherer.root.index()].bounds;
        let has_occluders = (pass.context.guarantees).is_some_and(|g| !g.occluders.is_empty());
        Self {
            pass,
            gatherer,
            prover: Prover::new(pass.context.guarantees, pass.config, schedule, receivers),
            outcome: PassOutcome {
                claims: ClaimSample::new(pass.config.keep_claims),
                blocked: ClaimSample::new(pass.config.keep_blocked),
                ..PassOutcome::default()
            },
            segments: Vec::new(),
            shadow_cache: (schedule.screens_rays() && has_occluders).then(ShadowCache::default),
            visits: 0,
            counts_rays: pass.context.observer.counts_rays(),
        }
    }

    pub(super) fn source_of_node(&self, id: NodeId) -> Source<'a> {
        let context = &self.pass.context;
        let node = context.hierarchy.node(id);
        let (owner, slot) = if node.kind == NodeKind::Facet {
            let owner = self.pass.owner_of_facet[node.first_facet as usize];
            (
                owner,
                node.first_facet - self.pass.first_facets[owner as usize],
            )
        } else {
            (0, 0)
        };
        Source {
            element: &context.elements[id.index()],
            owner,
            slot,
            weight: 1.0,
        }
    }

    pub(super) fn radiosity(&self, source: &Source) -> &[f32; C] {
        if source.element.is_triangle() {
            &self.pass.shooters[source.owner as usize].unshot[source.slot as usize]
        } else {
            &self.pass.node_unshot[source.element.node.index()]
        }
    }

    /// Unshot radiosity of a source, greatest channel, times its weight.
    pub(super) fn greatest(&self, source: &Source) -> f64 {
        let radiosity = self.radiosity(source).iter().fold(0.0f32, |m, &x| m.max(x));
        source.weight * f64::from(radiosity)
    }

    /// Relative variance of a source's unshot radiosity.
    pub(super) fn variance(&self, source: &Source) -> f32 {
        if source.element.is_triangle() {
            self.pass.shooters[source.owner as usize].splits[source.slot as usize].variance
        } else {
            self.pass.node_variance[source.element.node.index()]
        }
    }

    /// Known to be visible if a box of air holds both.
    pub(super) fn look_for_air(&mut self, source: &Source, receiver: &Receiver, known: &mut Known) {
        let (from, to) = (source.element, receiver.element);
        if let Some(prover) = &self.prover
            && prover.may_find_air(from, to, known.knowledge)
            && prover.finds_air(from, to)
        {
            self.outcome.statistics.visible_claims += 1;
            known.knowledge = known.knowledge.in_air();
            known.claim = Some(self.claim(source, receiver, None));
        }
    }

    /// Asks about a pair that is about to be split and carries `power`, where that is due. If it was asked in vain what
    /// hides the pair: the packets that were expected below it.
    #[inline(always)]
    pub(super) fn prove_before_split(
        &mut self,
        source: &Source,
        receiver: &Receiver,
        power: f64,
        known: &mut Known,
    ) -> Option<f32> {
        let prover = self.prover.as_mut()?;
        if known.knowledge.verdict != Verdict::Unknown {
            return None;
        }
        let may_ask = prover.may_ask(known.knowledge, source.weight > 1.0);
        let (from, to) = (source.element, receiver.element);
        if may_ask || prover.may_find_air(from, to, known.knowledge) {
            self.look_and_ask(source, receiver, power, known, may_ask)
        } else {
            None
        }
    }

    /// Looks for a box of air that holds the pair, and if there is none and it `may_ask`, for another proof.
    #[inline(never)]
    fn look_and_ask(
        &mut self,
        source: &Source,
        receiver: &Receiver,
        power: f64,
        known: &mut Known,
        may_ask: bool,
    ) -> Option<f32> {
        self.look_for_air(source, receiver, known);
        let (from, to, pass) = (source.element, receiver.element, self.pass);
        if let Some(prover) = &mut self.prover
            && may_ask
            && known.knowledge.verdict == Verdict::Unknown
        {
            let (queries, occasion) = prover.plan_before_split(from, to, known.knowledge, |gap| {
                pass.oracle.expected_exchanges(from, to, gap, power)
                    * packets_of_exchange(pass.config.rays)
            });
            self.prove(source, receiver, known, queries, occasion);
            let is_vain = known.knowledge.verdict == Verdict::Unknown;
            if is_vain && queries == Queries::Occlusion {
                return Some(occasion.packets());
            }
        }
        None
    }

    /// Samples tested so far.
    pub(super) fn rays_tested(&self) -> u64 {
        self.outcome.statistics.rays + self.outcome.statistics.native_rays
    }

    /// Lets the schedule know what became of `expected` packets below a pair: the samples tested since there were so many
    /// as `before`.
    pub(super) fn book_below(&mut self, expected: f32, before: u64) {
        let tested = (self.rays_tested() - before) as f32;
        let rays = self.pass.config.rays;
        if let Some(prover) = &mut self.prover {
            prover.book_below(expected, tested / rays as f32 * packets_of_exchange(rays));
        }
    }

    /// Asks the prover, if there is one, and keeps a new claim.
    pub(super) fn prove(
        &mut self,
        source: &Source,
        receiver: &Receiver,
        known: &mut Known,
        queries: Queries,
        occasion: Occasion,
    ) {
        let Some(prover) = self.prover.as_mut().filter(|_| queries != Queries::None) else {
            return;
        };
        let proof: Proof = prover.ask(
            source.element,
            receiver.element,
            known.knowledge,
            queries,
            occasion,
            &mut self.outcome.statistics,
        );
        if proof.knowledge.verdict != known.knowledge.verdict {
            known.claim = Some(self.claim(source, receiver, proof.hiding.by));
        }
        known.knowledge = proof.knowledge;
        let is_last = matches!(occasion, Occasion::Exchange(_))
            && proof.hiding.may_hide
            && known.knowledge.verdict == Verdict::Unknown
            && self.pass.config.stride != Stride::Auto;
        if is_last && let Some(claim) = self.hide_parts(source.element, receiver.element) {
            known.claim = Some(claim);
            known.knowledge.verdict = Verdict::Occluded;
        }
    }

    /// A new claim, kept if an audit wants it.
    fn claim(&mut self, source: &Source, receiver: &Receiver, occluder: Option<HiddenBy>) -> Claim {
        let claim = Claim {
            pass: self.pass.pass,
            source: source.element.name(),
            receiver: receiver.element.name(),
            occluder,
        };
        if self.outcome.claims.is_wanted() {
            let key = exchange_key(self.pass.key, source.element, receiver.element);
            self.outcome.claims.offer(key, claim, &[]);
        }
        claim
    }

    /// Lets the schedule know what an exchange was found to be.
    pub(super) fn observe(&mut self, evidence: Evidence) {
        if let Some(prover) = &mut self.prover {
            prover.observe(evidence);
        }
    }

    /// Counts rays that went through Embree.
    pub(super) fn count_rays(&mut self, receiver: &Element, sampled: &SampledVisibility) {
        self.outcome.statistics.rays += u64::from(sampled.rays);
        self.outcome.statistics.rays_blocked += u64::from(sampled.rays_blocked);
        if self.counts_rays && sampled.rays > 0 {
            let observer = self.pass.context.observer;
            observer.rays_cast(receiver.name(), sampled.rays);
        }
    }
}
