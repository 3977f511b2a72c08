//! How the rays of an exchange are answered: natively where that is surely right and cheaper, else by Embree (design,
//! section 7, point 4).

use super::claim_check::Recording;
use super::config::Technique;
use super::element::Element;
use super::pair::{Known, Source, Target};
use super::task::{Task, packets_of_exchange};
use crate::visibility::{NativeFirst, SampledVisibility};

impl<const C: usize> Task<'_, '_, C> {
    /// Casts an exchange's samples: natively against a short list of polygons; else those that recent occluders leave open
    /// through Embree.
    pub(super) fn sample_where_cheapest(
        &mut self,
        source: &Source,
        target: Target,
        known: Known,
        round: u64,
    ) -> SampledVisibility {
        self.sample_listed(source, target, known, round)
            .or_else(|| self.sample_screened(source, target, round))
            .unwrap_or_else(|| {
                let embree = self.pass.context.embree;
                let rays = self.pass.config.rays;
                let sampled = self.pass.sample(embree, source, target, rays, round);
                self.count_rays(target.element, &sampled);
                sampled
            })
    }

    /// Against a short list of polygons, where there is one.
    fn sample_listed(
        &mut self,
        source: &Source,
        target: Target,
        known: Known,
        round: u64,
    ) -> Option<SampledVisibility> {
        if self.pass.config.technique != Technique::Blockers {
            return None;
        }
        let list = self.prover.as_mut()?.blockers(known.knowledge)?;
        let rays = self.pass.config.rays;
        let sampled = if self.pass.config.check_claims {
            let test = Recording {
                test: list,
                segments: &mut self.segments,
            };
            self.pass.sample(test, source, target, rays, round)
        } else {
            self.pass.sample(list, source, target, rays, round)
        };
        self.check_native(source, target.element, round, sampled.rays);
        let statistics = &mut self.outcome.statistics;
        statistics.native_rays += u64::from(sampled.rays);
        statistics.native_rays_blocked += u64::from(sampled.rays_blocked);
        if let Some(prover) = &mut self.prover {
            prover.book_native(packets_of_exchange(rays));
        }
        Some(sampled)
    }

    /// Against the rectangles that blocked rays before and the boxes of air, and through Embree what they leave open.
    fn sample_screened(
        &mut self,
        source: &Source,
        target: Target,
        round: u64,
    ) -> Option<SampledVisibility> {
        let context = self.pass.context;
        let rays = self.pass.config.rays;
        let mut test = NativeFirst {
            cache: self.shadow_cache.as_mut()?,
            occluders: &context.guarantees?.occluders,
            air: (self.prover.as_ref())
                .and_then(|prover| prover.air_between(source.element, target.element)),
            otherwise: context.embree,
            blocked: 0,
            clear: 0,
        };
        let sampled = if self.pass.config.check_claims {
            let test = Recording {
                test: &mut test,
                segments: &mut self.segments,
            };
            self.pass.sample(test, source, target, rays, round)
        } else {
            self.pass.sample(&mut test, source, target, rays, round)
        };
        let (blocked, clear) = (test.blocked, test.clear);
        self.check_native(source, target.element, round, blocked + clear);
        let statistics = &mut self.outcome.statistics;
        statistics.native_rays += u64::from(blocked + clear);
        statistics.native_rays_blocked += u64::from(blocked);
        let cast = SampledVisibility {
            rays: sampled.rays - blocked - clear,
            rays_blocked: sampled.rays_blocked - blocked,
            ..sampled
        };
        self.count_rays(target.element, &cast);
        Some(sampled)
    }

    /// Where claims are being checked: casts the rays of an exchange of which so many were `answered` natively, and judges
    /// those that disagree.
    fn check_native(&mut self, source: &Source, receiver: &Element, round: u64, answered: u32) {
        if !self.pass.config.check_claims {
            return;
        }
        let mut native = std::mem::take(&mut self.segments);
        let mut cast = Vec::with_capacity(native.len());
        let test = Recording {
            test: self.pass.context.embree,
            segments: &mut cast,
        };
        let rays = self.pass.config.rays;
        self.pass
            .sample(test, source, Target::whole(receiver), rays, round);
        if let Some(guarantees) = self.pass.context.guarantees {
            let check = &mut self.outcome.check;
            check.judge_native(&guarantees.scene, answered, &native, &cast);
        }
        native.clear();
        self.segments = native;
    }
}
