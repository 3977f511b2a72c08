//! One pass: the scene's unshot radiosity is shot onto the scene itself (paper, sections 4 and 6.1).
//!
//! Pairs (source, receiver) are walked from the root down without storing links (Stamminger et al.
//! 1998). Every task owns its receivers and reads sources from the state frozen before the pass, so the
//! result has the same bits at any number of threads.

use super::claim_check::{ClaimCheck, Recording};
use super::claims::{Claim, ClaimSample};
use super::config::{SolveConfig, Technique};
use super::element::{Element, Shape};
use super::form_factor::{Arrival, Flatness, Space, arrival};
use super::guarantees::Guarantees;
use super::observer::Observer;
use super::oracle::{Decision, Oracle};
use super::prover::{Knowledge, Proof, Prover};
use super::push_pull::local_children;
use super::query_schedule::{Evidence, Queries, QuerySchedule};
use super::radiosity::{Gatherer, Radiosity, Shooter};
use super::sampled_element::{ReceiverSurface, SourceSurface};
use super::statistics::PassStatistics;
use crate::cluster::{Hierarchy, NodeKind};
use crate::embree::CommittedScene;
use crate::math::{NodeId, hash_u64};
use crate::scene::Scene;
use crate::visibility::{
    AllClear, LEAST_COSINE, SampleCount, SampledVisibility, SegmentTest, Verdict, sample_visibility,
};
use glam::Vec3;
use pulp::Arch;
use rayon::prelude::*;

/// What stays the same during a solve.
#[derive(Clone, Copy)]
pub struct SolveContext<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its hierarchy.
    pub hierarchy: &'a Hierarchy,
    /// Its polygons, in Embree.
    pub embree: &'a CommittedScene,
    /// What the guaranteed tests stand on, where the technique asks for them.
    pub guarantees: Option<&'a Guarantees>,
    /// The element of each node.
    pub elements: &'a [Element],
    /// Unit normal of each facet.
    pub normals: &'a [Vec3],
    /// Sum of the areas of the facets before each facet, and of all at the end.
    pub area_before: &'a [f64],
    /// Area of the scene, one side of each polygon, normalised.
    pub polygon_area: f64,
    /// Depth below a surface within which nothing blocks, normalised.
    pub tau: f32,
    /// Who watches.
    pub observer: &'a dyn Observer,
}

/// What stays the same during a pass.
#[derive(Clone, Copy)]
struct Pass<'a, const C: usize> {
    context: SolveContext<'a>,
    shooters: &'a [Shooter<C>],
    node_unshot: &'a [[f32; C]],
    node_variance: &'a [f32],
    power_before: &'a [f64],
    owner_of_facet: &'a [u32],
    first_facets: &'a [u32],
    oracle: Oracle,
    config: &'a SolveConfig,
    pass: u32,
    /// Hash of the seed and the pass.
    key: u64,
    /// Power that all owners together may drop.
    drop_budget: f64,
    arch: Arch,
}

/// What a pass did.
#[derive(Clone, Debug, Default)]
pub struct PassOutcome {
    /// Counts; `seconds` and `unshot` are left to the caller.
    pub statistics: PassStatistics,
    /// Power dropped, greatest channel, an upper bound.
    pub dropped: f64,
    /// True when the observer asked to stop: the light is then worth nothing.
    pub interrupted: bool,
    /// Claims kept for an audit.
    pub claims: ClaimSample,
    /// What the rays of claimed exchanges said, where they were cast.
    pub check: ClaimCheck,
    /// Exchanges kept whose rays were all blocked.
    pub blocked: ClaimSample,
}

/// Share of the emitted power that may be dropped in pass `k`: all passes together stay below 1e-3 (design,
/// section 6), and halving follows the unshot power down.
fn drop_share(pass: u32) -> f64 {
    1.0e-3 * 0.5f64.powi(pass.min(1000) as i32)
}

/// Packets of eight rays that an exchange casts: schedules weigh queries in packets. Some exchanges cast a second
/// set of samples.
fn packets_of_exchange(rays: u32) -> f32 {
    1.2 * rays.div_ceil(8) as f32
}

/// One in how many exchanges whose first samples agree, and that would have been split had they not, is measured by
/// a second set: what the second set adds counts for the others too, so that the mean is that of the second set.
const MEASURED_ONE_IN: u64 = 4;

/// One in how many tasks goes before the others.
const FIRST_TASKS: usize = 16;

/// Visits between two questions to the observer: a few hundred microseconds.
const VISITS_BETWEEN_QUESTIONS: u32 = 4096;

/// Runs pass number `pass`. `emitted` is the emitted power, greatest channel, in the normalised units of the
/// light; gathered irradiance is left in `light.gatherers`, to be pushed by the caller.
pub fn run_pass<const C: usize>(
    context: SolveContext<'_>,
    config: &SolveConfig,
    light: &mut Radiosity<C>,
    pass: u32,
    emitted: f64,
) -> PassOutcome {
    let Radiosity {
        shooters,
        gatherers,
        node_unshot,
        node_variance,
        power_before,
        owner_of_facet,
        first_facets,
    } = light;
    let pass_data = Pass {
        context,
        shooters,
        node_unshot,
        node_variance,
        power_before,
        owner_of_facet,
        first_facets,
        oracle: Oracle {
            threshold: config.epsilon * emitted,
            irradiance_tolerance: config.gradient * emitted / context.polygon_area,
            min_area: (config.min_area * context.polygon_area) as f32,
            tau: context.tau,
        },
        config,
        pass,
        key: hash_u64(config.seed ^ hash_u64(u64::from(pass))),
        drop_budget: drop_share(pass) * emitted,
        arch: Arch::new(),
    };
    context.observer.pass_started(pass, gatherers.len());
    // Each owner is one task. A few go first, and the others start from what those learned of queries.
    let mut run_some = |is_first: bool, schedule: &QuerySchedule| -> Vec<TaskOutcome> {
        gatherers
            .par_iter_mut()
            .with_max_len(1)
            .enumerate()
            .filter(|(owner, _)| owner.is_multiple_of(FIRST_TASKS) == is_first)
            .map(|(owner, gatherer)| {
                let task = Task::new(&pass_data, gatherer, schedule.clone()).run(owner);
                context
                    .observer
                    .task_done(task.outcome.statistics.exchanges);
                task
            })
            .collect()
    };
    let mut outcomes = run_some(true, &QuerySchedule::new(config.technique));
    let learned = QuerySchedule::after(config.technique, outcomes.iter().map(|t| &t.schedule));
    outcomes.extend(run_some(false, &learned));
    // Summed in order, so that the sums have the same bits at any number of threads.
    outcomes.sort_unstable_by_key(|task| task.owner);
    let mut sum = PassOutcome {
        claims: ClaimSample::new(config.keep_claims),
        blocked: ClaimSample::new(config.keep_blocked),
        ..PassOutcome::default()
    };
    for TaskOutcome { outcome, .. } in outcomes {
        sum.statistics.add_counts(&outcome.statistics);
        sum.dropped += outcome.dropped;
        sum.interrupted |= outcome.interrupted;
        sum.claims.merge(outcome.claims);
        sum.check.merge(outcome.check);
        sum.blocked.merge(outcome.blocked);
    }
    sum.statistics.pass = pass;
    sum
}

impl<const C: usize> Pass<'_, C> {
    /// Casts the samples of a pair.
    fn sample(
        &self,
        test: impl SegmentTest,
        source: &Source,
        receiver: &Element,
        samples: SampleCount,
        round: u64,
    ) -> SampledVisibility {
        let context = self.context;
        let key = exchange_key(self.key.wrapping_add(round), &source.element, receiver);
        sample_visibility(
            self.arch,
            test,
            &SourceSurface {
                element: &source.element,
                scene: context.scene,
                hierarchy: context.hierarchy,
                normals: context.normals,
                power_before: self.power_before,
                shooters: self.shooters,
                owner_of_facet: self.owner_of_facet,
                first_facets: self.first_facets,
                owner: source.owner,
                slot: source.slot,
            },
            &ReceiverSurface {
                element: receiver,
                scene: context.scene,
                hierarchy: context.hierarchy,
                normals: context.normals,
                area_before: context.area_before,
            },
            samples,
            key,
            self.oracle.tau,
        )
    }
}

/// What came of a task.
struct TaskOutcome {
    owner: usize,
    outcome: PassOutcome,
    schedule: QuerySchedule,
}

/// A source in the walk: the element, and where its unshot radiosity stands.
#[derive(Clone, Copy)]
struct Source {
    element: Element,
    /// Owner of the facet; of use to triangles only.
    owner: u32,
    /// Patch of the owner that holds the radiosity: itself, or the frozen leaf that it is a part of.
    slot: u32,
}

/// A receiver in the walk: the element, and a cluster's place in its owner's depth-first order.
#[derive(Clone, Copy)]
struct Receiver {
    element: Element,
    local: u32,
}

/// What is known of a pair, and the claim that it rests on.
#[derive(Clone, Copy)]
struct Known {
    knowledge: Knowledge,
    claim: Option<Claim>,
}

impl Known {
    const NOTHING: Self = Self {
        knowledge: Knowledge::NOTHING,
        claim: None,
    };

    fn below(self) -> Self {
        Self {
            knowledge: self.knowledge.below(),
            ..self
        }
    }

    /// Nothing passes between occluded elements; only a check goes on, to cast their rays.
    fn ends_the_pair(self, config: &SolveConfig) -> bool {
        self.knowledge.verdict == Verdict::Occluded && !config.check_claims
    }
}

/// One owner's share of a pass.
struct Task<'a, 'g, const C: usize> {
    pass: &'a Pass<'a, C>,
    gatherer: &'g mut Gatherer<C>,
    prover: Option<Prover<'a>>,
    outcome: PassOutcome,
    /// Segments of the exchange whose claim is being checked.
    segments: Vec<(Vec3, Vec3, bool)>,
    drop_budget: f64,
    visits: u32,
}

impl<'a, 'g, const C: usize> Task<'a, 'g, C> {
    fn new(pass: &'a Pass<'a, C>, gatherer: &'g mut Gatherer<C>, schedule: QuerySchedule) -> Self {
        let share = f64::from(gatherer.facet_count) / pass.owner_of_facet.len() as f64;
        Self {
            pass,
            gatherer,
            prover: Prover::new(pass.context.guarantees, pass.config, schedule),
            outcome: PassOutcome {
                claims: ClaimSample::new(pass.config.keep_claims),
                blocked: ClaimSample::new(pass.config.keep_blocked),
                ..PassOutcome::default()
            },
            segments: Vec::new(),
            drop_budget: pass.drop_budget * share,
            visits: 0,
        }
    }

    fn run(mut self, owner: usize) -> TaskOutcome {
        let source = self.source_of_node(Hierarchy::ROOT);
        let receiver = Receiver {
            element: self.pass.context.elements[self.gatherer.root.index()],
            local: 0,
        };
        self.walk(&source, &receiver, Known::NOTHING);
        let technique = self.pass.config.technique;
        let unlearned = || QuerySchedule::new(technique);
        TaskOutcome {
            owner,
            outcome: self.outcome,
            schedule: self.prover.map_or_else(unlearned, Prover::into_schedule),
        }
    }

    fn source_of_node(&self, id: NodeId) -> Source {
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
            element: context.elements[id.index()],
            owner,
            slot,
        }
    }

    fn radiosity(&self, source: &Source) -> &[f32; C] {
        if source.element.is_triangle() {
            &self.pass.shooters[source.owner as usize].unshot[source.slot as usize]
        } else {
            &self.pass.node_unshot[source.element.node.index()]
        }
    }

    /// Relative variance of a source's unshot radiosity.
    fn variance(&self, source: &Source) -> f32 {
        if source.element.is_triangle() {
            self.pass.shooters[source.owner as usize].splits[source.slot as usize].variance
        } else {
            self.pass.node_variance[source.element.node.index()]
        }
    }

    fn walk(&mut self, source: &Source, receiver: &Receiver, known: Known) {
        let greatest = self.greatest(source);
        if greatest <= 0.0 || self.is_interrupted() {
            return;
        }
        let decision = self
            .pass
            .oracle
            .decide(&source.element, &receiver.element, greatest);
        match decision {
            Decision::Nothing => {}
            Decision::Drop(power) if self.outcome.dropped + power <= self.drop_budget => {
                self.outcome.dropped += power;
            }
            // The budget is spent: go on down where something can be split.
            Decision::Drop(_) => {
                let by_source = source.element.radius >= receiver.element.radius
                    && !source.element.is_triangle()
                    || receiver.element.is_triangle();
                self.split(source, receiver, known, by_source);
            }
            Decision::Exchange => self.exchange(source, receiver, greatest, known),
            Decision::SplitSource => self.split(source, receiver, known, true),
            Decision::SplitReceiver => self.split(source, receiver, known, false),
        }
    }

    /// Asks for a guarantee where it is due, and goes on with the children of one end.
    fn split(&mut self, source: &Source, receiver: &Receiver, known: Known, by_source: bool) {
        let known = self.prove_before_split(source, receiver, known);
        if known.ends_the_pair(self.pass.config) {
            return;
        }
        if by_source {
            self.split_source(source, receiver, known.below());
        } else {
            self.split_receiver(source, receiver, known.below());
        }
    }

    fn prove_before_split(&mut self, source: &Source, receiver: &Receiver, known: Known) -> Known {
        if self.prover.is_none() || known.knowledge.verdict != Verdict::Unknown {
            return known;
        }
        let greatest = self.greatest(source);
        let Some(prover) = &mut self.prover else {
            return known;
        };
        let (from, to) = (&source.element, &receiver.element);
        let expected = self.pass.oracle.expected_exchanges(from, to, greatest)
            * packets_of_exchange(self.pass.config.rays);
        let mut queries = prover.plan_before_split(from, to, known.knowledge, expected);
        if queries == Queries::Probe {
            let evidence = self.probe(source, to);
            queries = self.after(evidence, expected);
        }
        self.prove(source, receiver, known, queries, expected)
    }

    fn after(&mut self, evidence: Evidence, expected: f32) -> Queries {
        match &mut self.prover {
            Some(prover) => prover.after_evidence(evidence, expected),
            None => Queries::None,
        }
    }

    /// What eight rays say of a pair.
    fn probe(&mut self, source: &Source, receiver: &Element) -> Evidence {
        let sampled = self.pass.sample(
            self.pass.context.embree,
            source,
            receiver,
            SampleCount::PROBE,
            0,
        );
        self.outcome.statistics.rays += u64::from(sampled.rays);
        self.outcome.statistics.rays_blocked += u64::from(sampled.rays_blocked);
        match sampled.rays {
            0 => Evidence::Dark,
            n if sampled.rays_blocked == n => Evidence::Blocked,
            _ if sampled.rays_blocked == 0 => Evidence::Clear,
            _ => Evidence::Mixed,
        }
    }

    /// Asks the prover, if there is one, and keeps a new claim.
    fn prove(
        &mut self,
        source: &Source,
        receiver: &Receiver,
        known: Known,
        queries: Queries,
        expected: f32,
    ) -> Known {
        let Some(prover) = self.prover.as_mut().filter(|_| queries != Queries::None) else {
            return known;
        };
        let proof: Proof = prover.ask(
            &source.element,
            &receiver.element,
            known.knowledge,
            queries,
            expected,
            &mut self.outcome.statistics,
        );
        let is_new = proof.knowledge.verdict != known.knowledge.verdict;
        let claim = match is_new {
            true => Some(Claim {
                pass: self.pass.pass,
                source: source.element.name(),
                receiver: receiver.element.name(),
                occluder: proof.occluder,
            }),
            false => known.claim,
        };
        if let Some(claim) = claim.filter(|_| is_new && self.outcome.claims.is_wanted()) {
            let key = exchange_key(self.pass.key, &source.element, &receiver.element);
            self.outcome.claims.offer(key, claim);
        }
        Known {
            knowledge: proof.knowledge,
            claim,
        }
    }

    /// Unshot radiosity of a source, greatest channel.
    fn greatest(&self, source: &Source) -> f64 {
        f64::from(self.radiosity(source).iter().fold(0.0f32, |m, &x| m.max(x)))
    }

    fn is_interrupted(&mut self) -> bool {
        self.visits = self.visits.wrapping_add(1);
        if self.visits.is_multiple_of(VISITS_BETWEEN_QUESTIONS) {
            self.outcome.interrupted |= self.pass.context.observer.interrupted();
        }
        self.outcome.interrupted
    }

    fn split_source(&mut self, source: &Source, receiver: &Receiver, known: Known) {
        if let Shape::Triangle(corners) = source.element.shape {
            let first =
                self.pass.shooters[source.owner as usize].splits[source.slot as usize].first;
            for which in 0..4 {
                let child = Source {
                    element: source.element.triangle_child(corners, which),
                    owner: source.owner,
                    // Below a frozen leaf the source is split virtually: the leaf's radiosity serves.
                    slot: if first == 0 {
                        source.slot
                    } else {
                        first + which
                    },
                };
                self.walk(&child, receiver, known);
            }
        } else if let Some(children) = self.pass.context.hierarchy.children(source.element.node) {
            for child in children {
                let child = self.source_of_node(child);
                self.walk(&child, receiver, known);
            }
        }
    }

    fn split_receiver(&mut self, source: &Source, receiver: &Receiver, known: Known) {
        let context = self.pass.context;
        if let Shape::Triangle(corners) = receiver.element.shape {
            for which in 0..4 {
                let child = Receiver {
                    element: receiver.element.triangle_child(corners, which),
                    local: 0,
                };
                self.walk(source, &child, known);
            }
        } else if let Some(children) = context.hierarchy.children(receiver.element.node) {
            let locals = local_children(context.hierarchy, children[0], receiver.local as usize);
            for (child, local) in children.into_iter().zip(locals) {
                let child = Receiver {
                    element: context.elements[child.index()],
                    local: local as u32,
                };
                self.walk(source, &child, known);
            }
        }
    }

    /// Transfers energy: radiosity x form factor x visibility.
    fn exchange(&mut self, source: &Source, receiver: &Receiver, greatest: f64, known: Known) {
        let context = self.pass.context;
        let oracle = self.pass.oracle;
        let (unoccluded, residual) = arrival(
            &Space {
                scene: context.scene,
                hierarchy: context.hierarchy,
                elements: context.elements,
                normals: context.normals,
                power_before: self.pass.power_before,
                tau: context.tau,
            },
            &source.element,
            &receiver.element,
            Flatness {
                source: oracle.is_flat_towards(&source.element, &receiver.element),
                receiver: oracle.is_flat_towards(&receiver.element, &source.element),
            },
        );
        if unoccluded.is_zero() {
            return;
        }
        if oracle.refines_source(
            &source.element,
            &receiver.element,
            greatest,
            self.variance(source),
        ) {
            return self.split(source, receiver, known, true);
        }
        if oracle.refines_receiver(&receiver.element, greatest, residual) {
            return self.split(source, receiver, known, false);
        }
        let queries = match &self.prover {
            Some(prover) => prover.plan_before_exchange(known.knowledge),
            None => Queries::None,
        };
        let known = self.prove(source, receiver, known, queries, 1.0);
        let visibility = match (self.pass.config.technique, known.knowledge.verdict) {
            (Technique::Unoccluded, _) => 1.0,
            (_, Verdict::Unknown) => {
                let Some(sampled) = self.sampled(source, receiver, greatest, known) else {
                    return;
                };
                sampled
            }
            (_, verdict) => {
                if let Some(claim) = known.claim.filter(|_| self.pass.config.check_claims) {
                    self.check(source, &receiver.element, claim);
                }
                match verdict {
                    Verdict::Visible => {
                        self.outcome.statistics.exchanges_visible += 1;
                        self.visible_share(source, &receiver.element, greatest)
                    }
                    // Reached only while claims are being checked.
                    _ => return,
                }
            }
        };
        self.outcome.statistics.exchanges += 1;
        // Below zero where a second set stands for others that the first overrated.
        if visibility != 0.0 {
            let radiosity = self.radiosity(source).map(f64::from);
            let light = radiosity.map(|b| b * f64::from(visibility));
            self.deposit(receiver, unoccluded, light);
        }
    }

    /// Visibility by samples, or `None` if the pair was split instead.
    fn sampled(
        &mut self,
        source: &Source,
        receiver: &Receiver,
        greatest: f64,
        known: Known,
    ) -> Option<f32> {
        let mut sampled = self.sample_where_cheapest(source, &receiver.element, known, 0);
        if self.refines_if_partial(source, &receiver.element, greatest) {
            if !(sampled.all_blocked || sampled.all_clear) {
                self.split_receiver(source, receiver, known.below());
                return None;
            }
            // Samples that decide cannot measure as well: a slit that most sets of samples miss would pass light
            // only where it is found and refined, and too little in the mean. What a few second sets find instead
            // stands for all (a control variate, so that the mean is right).
            if sampled.rays > 0 && self.measures_again(source, &receiver.element) {
                let again = self.sample_where_cheapest(source, &receiver.element, known, 1);
                sampled.visibility +=
                    MEASURED_ONE_IN as f32 * (again.visibility - sampled.visibility);
                sampled.all_blocked &= again.all_blocked;
                sampled.all_clear &= again.all_clear;
                sampled.rays_blocked += again.rays_blocked;
            }
        }
        let statistics = &mut self.outcome.statistics;
        // Where no sample carries light there was no ray, and nothing that stands in its way.
        let blocked = sampled.all_blocked && sampled.rays_blocked > 0;
        statistics.exchanges_blocked += u64::from(blocked);
        statistics.exchanges_sampled_clear += u64::from(sampled.all_clear);
        if blocked && self.outcome.blocked.is_wanted() {
            self.keep_blocked(&source.element, &receiver.element);
        }
        Some(sampled.visibility)
    }

    /// Whether an exchange whose first samples agree casts a second set, which then counts for all the others.
    fn measures_again(&self, source: &Source, receiver: &Element) -> bool {
        let key = exchange_key(self.pass.key.wrapping_add(2), &source.element, receiver);
        hash_u64(key).is_multiple_of(MEASURED_ONE_IN)
    }

    fn keep_blocked(&mut self, source: &Element, receiver: &Element) {
        let pair = Claim {
            pass: self.pass.pass,
            source: source.name(),
            receiver: receiver.name(),
            occluder: None,
        };
        let key = exchange_key(self.pass.key, source, receiver);
        self.outcome.blocked.offer(key, pair);
    }

    /// Casts an exchange's samples: natively against a short list of polygons, else through Embree.
    fn sample_where_cheapest(
        &mut self,
        source: &Source,
        receiver: &Element,
        known: Known,
        round: u64,
    ) -> SampledVisibility {
        let rays = SampleCount::of_exchange(self.pass.config.rays);
        if self.pass.config.technique == Technique::Blockers {
            let list = self
                .prover
                .as_mut()
                .and_then(|p| p.blockers(known.knowledge));
            if let Some(list) = list {
                let sampled = self.pass.sample(list, source, receiver, rays, round);
                let statistics = &mut self.outcome.statistics;
                statistics.native_rays += u64::from(sampled.rays);
                statistics.native_rays_blocked += u64::from(sampled.rays_blocked);
                return sampled;
            }
        }
        let sampled = self
            .pass
            .sample(self.pass.context.embree, source, receiver, rays, round);
        let statistics = &mut self.outcome.statistics;
        statistics.rays += u64::from(sampled.rays);
        statistics.rays_blocked += u64::from(sampled.rays_blocked);
        sampled
    }

    /// Whether the pair would be split were its samples partly blocked.
    fn refines_if_partial(&self, source: &Source, receiver: &Element, greatest: f64) -> bool {
        let oracle = &self.pass.oracle;
        oracle.refines_shadow(&source.element, receiver, greatest)
    }

    /// Visibility of a pair that is proved visible: 1, unless no sample carries any light, when a
    /// technique without proofs would find none either.
    fn visible_share(&self, source: &Source, receiver: &Element, greatest: f64) -> f32 {
        let is_open = |element: &Element| {
            let context = self.pass.context;
            let facet = context.hierarchy.facets[element.first_facet as usize];
            !(element.is_triangle() && context.scene.contacts.touches(facet, &element.bounds))
        };
        if is_open(&source.element)
            && is_open(receiver)
            && source.element.faces_beyond(receiver, LEAST_COSINE)
            && receiver.faces_beyond(&source.element, LEAST_COSINE)
        {
            return 1.0;
        }
        let rays = SampleCount::of_exchange(self.pass.config.rays);
        let first = self.pass.sample(AllClear, source, receiver, rays, 0);
        if (first.all_clear || first.all_blocked)
            && first.rays > 0
            && self.refines_if_partial(source, receiver, greatest)
            && self.measures_again(source, receiver)
        {
            let again = self.pass.sample(AllClear, source, receiver, rays, 1);
            return first.visibility
                + MEASURED_ONE_IN as f32 * (again.visibility - first.visibility);
        }
        first.visibility
    }

    /// Casts the rays that a claim saves, and judges those that disagree.
    fn check(&mut self, source: &Source, receiver: &Element, claim: Claim) {
        let Some(guarantees) = self.pass.context.guarantees else {
            return;
        };
        let mut segments = std::mem::take(&mut self.segments);
        segments.clear();
        let rays = SampleCount::of_exchange(self.pass.config.rays);
        // Both sets that a technique without proofs might cast.
        for round in 0..2 {
            let recording = Recording {
                test: self.pass.context.embree,
                segments: &mut segments,
            };
            self.pass.sample(recording, source, receiver, rays, round);
        }
        self.outcome
            .check
            .judge(&guarantees.scene, claim, &segments);
        self.segments = segments;
    }

    fn deposit(&mut self, receiver: &Receiver, unoccluded: Arrival, light: [f64; C]) {
        match unoccluded {
            Arrival::Linear(irradiance) => {
                let element = &receiver.element;
                let at = self.gatherer.patch(element.facet(), element.path);
                for (corner, value) in self.gatherer.gathered[at].iter_mut().zip(irradiance) {
                    for (sum, b) in corner.iter_mut().zip(light) {
                        *sum += b * f64::from(value);
                    }
                }
            }
            Arrival::Field(vector) => {
                let first = self.gatherer.first_facet as usize;
                for facet in receiver.element.facet_range() {
                    let irradiance = self.pass.context.normals[facet].dot(vector).max(0.0);
                    for corner in &mut self.gatherer.gathered[facet - first] {
                        for (sum, b) in corner.iter_mut().zip(light) {
                            *sum += b * f64::from(irradiance);
                        }
                    }
                }
            }
            Arrival::Vector(vector) => {
                let vector = vector.as_dvec3();
                let sums = &mut self.gatherer.vectors[receiver.local as usize];
                for (sum, b) in sums.iter_mut().zip(light) {
                    *sum += vector * b;
                }
            }
        }
    }
}

/// The name of an exchange's samples: (receiver, source, pass, seed).
fn exchange_key(pass_key: u64, source: &Element, receiver: &Element) -> u64 {
    let end = |e: &Element| hash_u64(u64::from(e.node.0) ^ e.path.0.rotate_left(32));
    hash_u64(end(receiver).wrapping_add(hash_u64(end(source) ^ pass_key)))
}
