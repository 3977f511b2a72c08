//! The walk of one task over pairs (source, receiver), from the root down, without storing links (Stamminger et al.
//! 1998): what is split, what is proved, what is exchanged (paper, section 5.3).

use super::claims::{Claim, ClaimSample};
use super::config::SolveConfig;
use super::element::{Element, Shape};
use super::oracle::Decision;
use super::pass::{Pass, PassOutcome, exchange_key};
use super::prover::{Knowledge, Proof, Prover};
use super::push_pull::local_children;
use super::query_schedule::{Evidence, Queries, QuerySchedule};
use super::radiosity::Gatherer;
use crate::cluster::{Hierarchy, NodeKind};
use crate::math::NodeId;
use crate::visibility::{SampleCount, Verdict};
use glam::Vec3;

/// Packets of eight rays that an exchange casts: schedules weigh queries in packets. Some exchanges cast a second
/// set of samples.
fn packets_of_exchange(rays: u32) -> f32 {
    1.2 * rays.div_ceil(8) as f32
}

/// Visits between two questions to the observer: a few hundred microseconds.
const VISITS_BETWEEN_QUESTIONS: u32 = 4096;

/// What came of a task.
pub(super) struct TaskOutcome {
    pub(super) owner: usize,
    pub(super) outcome: PassOutcome,
    pub(super) schedule: QuerySchedule,
}

/// A source in the walk: the element, and where its unshot radiosity stands.
#[derive(Clone, Copy)]
pub(super) struct Source {
    pub(super) element: Element,
    /// Owner of the facet; of use to triangles only.
    pub(super) owner: u32,
    /// Patch of the owner that holds the radiosity: itself, or the frozen leaf that it is a part of.
    pub(super) slot: u32,
}

/// A receiver in the walk: the element, and a cluster's place in its owner's depth-first order.
#[derive(Clone, Copy)]
pub(super) struct Receiver {
    pub(super) element: Element,
    pub(super) local: u32,
}

/// What is known of a pair, and the claim that it rests on.
#[derive(Clone, Copy)]
pub(super) struct Known {
    pub(super) knowledge: Knowledge,
    pub(super) claim: Option<Claim>,
}

impl Known {
    pub(super) const NOTHING: Self = Self {
        knowledge: Knowledge::NOTHING,
        claim: None,
    };

    pub(super) fn below(self) -> Self {
        Self {
            knowledge: self.knowledge.below(),
            ..self
        }
    }

    /// Nothing passes between occluded elements; only a check goes on, to cast their rays.
    pub(super) fn ends_the_pair(self, config: &SolveConfig) -> bool {
        self.knowledge.verdict == Verdict::Occluded && !config.check_claims
    }
}

/// One owner's share of a pass.
pub(super) struct Task<'a, 'g, const C: usize> {
    pub(super) pass: &'a Pass<'a, C>,
    pub(super) gatherer: &'g mut Gatherer<C>,
    pub(super) prover: Option<Prover<'a>>,
    pub(super) outcome: PassOutcome,
    /// Segments of the exchange whose claim is being checked.
    pub(super) segments: Vec<(Vec3, Vec3, bool)>,
    pub(super) drop_budget: f64,
    pub(super) visits: u32,
}

impl<'a, 'g, const C: usize> Task<'a, 'g, C> {
    pub(super) fn new(
        pass: &'a Pass<'a, C>,
        gatherer: &'g mut Gatherer<C>,
        schedule: QuerySchedule,
    ) -> Self {
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

    pub(super) fn run(mut self, owner: usize) -> TaskOutcome {
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

    pub(super) fn radiosity(&self, source: &Source) -> &[f32; C] {
        if source.element.is_triangle() {
            &self.pass.shooters[source.owner as usize].unshot[source.slot as usize]
        } else {
            &self.pass.node_unshot[source.element.node.index()]
        }
    }

    /// Relative variance of a source's unshot radiosity.
    pub(super) fn variance(&self, source: &Source) -> f32 {
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
    pub(super) fn split(
        &mut self,
        source: &Source,
        receiver: &Receiver,
        known: Known,
        by_source: bool,
    ) {
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
    pub(super) fn prove(
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

    pub(super) fn split_receiver(&mut self, source: &Source, receiver: &Receiver, known: Known) {
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
}
