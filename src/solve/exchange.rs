//! One exchange: radiosity x form factor x visibility, and where its visibility comes from (paper, section 4;
//! design, section 6).

use super::arrival::arrival;
use super::claim_check::Recording;
use super::claims::Claim;
use super::config::Technique;
use super::element::{Element, Shape};
use super::element_vector::Space;
use super::pair::{Known, Receiver, Source, Target, exchange_key};
use super::queries::{Evidence, Occasion, Queries};
use super::task::{Task, packets_of_exchange};
use super::uneven_source;
use crate::math::hash_u64;
use crate::visibility::{AllClear, LEAST_COSINE, PartVisibility, SampledLight, Verdict};

/// One in how many exchanges whose first samples agree, and that would have been split had they not, is measured by
/// a second set: what the second set adds counts for the others too, so that the mean is that of the second set.
const MEASURED_ONE_IN: u64 = 4;

/// What becomes of a pair that was to exchange.
#[derive(Clone, Copy)]
pub(super) enum Next {
    /// Nothing more.
    Done,
    /// The source's light is too uneven: on with its children.
    SplitSource,
    /// What arrives is too uneven: on with the receiver's children.
    SplitReceiver,
    /// A shadow's edge runs through the receiver: on with its children, with what is known now.
    SplitShadow(Known),
}

impl<const C: usize> Task<'_, '_, C> {
    /// Transfers energy: radiosity x form factor x visibility, where the oracle expects `carried`. Or
    /// says that the pair has to be split after all. `greatest` and `carried` leave the source's weight out.
    pub(super) fn exchange(
        &mut self,
        source: &Source,
        receiver: &Receiver,
        greatest: f64,
        carried: f64,
        known: &Known,
    ) -> Next {
        let context = self.pass.context;
        let oracle = self.pass.oracle;
        let (unoccluded, residual) = arrival(
            &Space {
                scene: context.scene,
                hierarchy: context.hierarchy,
                flux_tree: context.flux_tree,
                frames: context.frames,
                tau: context.tau,
            },
            source.element,
            receiver.element,
            receiver.local,
        );
        if unoccluded.is_zero() {
            return Next::Done;
        }
        if oracle.refines_source(
            source.element,
            receiver.element,
            carried,
            self.variance(source),
        ) {
            return Next::SplitSource;
        }
        if oracle.refines_receiver(receiver.element, greatest, residual) {
            return Next::SplitReceiver;
        }
        let mut known = *known;
        self.look_for_air(source, receiver, &mut known);
        let packets = packets_of_exchange(self.pass.config.rays);
        let queries = match &mut self.prover {
            Some(prover) => prover.plan_before_exchange(known.knowledge, packets),
            None => Queries::None,
        };
        self.prove(
            source,
            receiver,
            &mut known,
            queries,
            Occasion::Exchange(packets),
        );
        if known.knowledge.verdict == Verdict::Occluded {
            self.observe(Evidence::Blocked);
        }
        if known.ends_the_pair(self.pass.config) {
            return Next::Done;
        }
        let target = Target {
            element: receiver.element,
            parts: unoccluded.parts(),
        };
        let visibility = match (self.pass.config.technique, known.knowledge.verdict) {
            (Technique::Unoccluded, _) => PartVisibility::CLEAR,
            (_, Verdict::Unknown) => {
                let Some(sampled) = self.sampled(source, target, carried, known) else {
                    return Next::SplitShadow(known);
                };
                sampled
            }
            (_, verdict) => {
                if let Some(claim) = known.claim.filter(|_| self.pass.config.check_claims) {
                    self.check(source, receiver.element, claim);
                }
                match verdict {
                    Verdict::Visible => {
                        self.observe(Evidence::Clear);
                        let Some(share) = self.visible_share(source, target, carried) else {
                            return Next::SplitShadow(known);
                        };
                        self.outcome.statistics.exchanges_visible += 1;
                        if let Some(prover) = &mut self.prover {
                            prover.book_visible(known.knowledge, packets);
                        }
                        share
                    }
                    // Reached only while claims are being checked.
                    _ => return Next::Done,
                }
            }
        };
        self.outcome.statistics.exchanges += 1;
        // Below zero where a second set stands for others that the first overrated.
        if visibility != PartVisibility::even(0.0) {
            let light = self.light_towards(source, receiver.element);
            self.deposit(receiver, &unoccluded, &visibility, light);
        }
        Next::Done
    }

    /// Radiosity that counts towards a receiver, times the source's weight.
    fn light_towards(&self, source: &Source, receiver: &Element) -> [f64; C] {
        let mean = self.radiosity(source).map(f64::from);
        let element = source.element;
        let factor = match element.shape {
            Shape::Triangle(corners) => {
                let shooter = &self.pass.shooters[source.owner as usize];
                uneven_source::triangle_towards(shooter, source.slot, (element, corners), receiver)
            }
            Shape::Cluster => {
                let moment = &self.pass.node_moment[element.node.index()];
                uneven_source::cluster_towards(&mean, moment, element, receiver)
            }
            Shape::Volume => [1.0; C],
        };
        std::array::from_fn(|c| mean[c] * source.weight * factor[c])
    }

    /// Visibility by samples, or `None` if the pair is to be split instead.
    fn sampled(
        &mut self,
        source: &Source,
        target: Target,
        carried: f64,
        known: Known,
    ) -> Option<PartVisibility> {
        let mut sampled = self.sample_where_cheapest(source, target, known, 0);
        self.observe(Evidence::of(&sampled));
        if self.pass.oracle.refines_shadow(target.element, carried) {
            if !(sampled.all_blocked || sampled.all_clear) {
                return None;
            }
            // Samples that decide cannot measure as well: a slit that most sets of samples miss would pass light
            // only where it is found and refined, and too little in the mean. What a few second sets find instead
            // stands for all (a control variate, so that the mean is right).
            if sampled.rays > 0 && self.measures_again(source, target.element) {
                let again = self.sample_where_cheapest(source, target, known, 1);
                sampled.visibility = measured(sampled.visibility, again.visibility);
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
            self.keep_blocked(source.element, target.element);
        }
        Some(sampled.visibility)
    }

    /// Whether an exchange whose first samples agree casts a second set, which then counts for all the others.
    fn measures_again(&self, source: &Source, receiver: &Element) -> bool {
        let key = exchange_key(self.pass.key.wrapping_add(2), source.element, receiver);
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
        self.outcome.blocked.offer(key, pair, &[]);
    }

    /// Visibility of a pair that is proved visible: 1, unless samples lie below what stands on an end, where a
    /// technique without proofs finds no light either. `None` where it would split the pair.
    fn visible_share(
        &self,
        source: &Source,
        target: Target,
        carried: f64,
    ) -> Option<PartVisibility> {
        let (from, to) = (source.element, target.element);
        let context = self.pass.context;
        let is_open = context.is_open(from) && context.is_open(to);
        if is_open && from.faces_beyond(to, LEAST_COSINE) && to.faces_beyond(from, LEAST_COSINE) {
            return Some(PartVisibility::CLEAR);
        }
        let rays = self.pass.config.rays;
        let may_measure = self.pass.oracle.refines_shadow(to, carried);
        if is_open {
            let look = |round| self.pass.look_for_light(source, target, rays, round);
            let share =
                |light: SampledLight| PartVisibility::even(f32::from(u8::from(light.carries)));
            let first = look(0);
            if first.casts && may_measure && self.measures_again(source, to) {
                return Some(measured(share(first), share(look(1))));
            }
            return Some(share(first));
        }
        let look = |round| self.pass.sample(AllClear, source, target, rays, round);
        let first = look(0);
        if may_measure && !(first.all_clear || first.all_blocked) {
            return None;
        }
        if may_measure && first.rays > 0 && self.measures_again(source, to) {
            return Some(measured(first.visibility, look(1).visibility));
        }
        Some(first.visibility)
    }

    /// Casts the rays that a claim saves, and judges those that disagree.
    fn check(&mut self, source: &Source, receiver: &Element, claim: Claim) {
        let Some(guarantees) = self.pass.context.guarantees else {
            return;
        };
        let mut segments = std::mem::take(&mut self.segments);
        let rays = self.pass.config.rays;
        // Both sets that a technique without proofs might cast.
        for round in 0..2 {
            let recording = Recording {
                test: self.pass.context.embree,
                segments: &mut segments,
            };
            self.pass
                .sample(recording, source, Target::whole(receiver), rays, round);
        }
        self.outcome
            .check
            .judge(&guarantees.scene, claim, &segments);
        segments.clear();
        self.segments = segments;
    }
}

/// What a second set of samples says for all whose first agree.
fn measured(first: PartVisibility, again: PartVisibility) -> PartVisibility {
    first.corrected(&again, MEASURED_ONE_IN as f32)
}
