//! Pairs hidden by several occluders: every part of one end from every part of the other, each by an occluder of its own
//! (design, section 7, point 6). What one occluder leaves of a shaft is no product of two sets; the parts of two ends
//! are.
//!
//! Above exchanges the walk itself splits pairs and asks again, so this is for exchanges alone, and only under a fixed
//! stride, which asks for all that can be proved: it takes some ten queries to save one exchange.

use super::claims::Claim;
use super::element::Element;
use super::pair::exchange_key;
use super::pass_context::SolveContext;
use super::prover::Prover;
use super::statistics::PassStatistics;
use super::task::Task;

/// How often a pair is split, its two ends together. Measured (`bench/runs/`, audit/hidden_parts.csv): four splits find
/// 2.5 to 4 points of the blocked exchanges of c, eight 5 to 7, twelve 7 to 9 in more than three times the time of eight.
const MOST_SPLITS: u32 = 8;
/// Queries after which a pair is left to its rays, however near to a proof it is.
const MOST_QUERIES: u32 = 256;
/// Parts of so small a radius, in tau, are not split: rounding would weigh on them as much as what they show.
const LEAST_RADIUS_IN_TAU: f32 = 16.0;

/// The end of a pair that is split next, true for the source.
pub(super) fn splits_source(source: &Element, receiver: &Element) -> bool {
    source.area >= receiver.area
}

/// A search for occluders between the parts of a pair.
struct PartSearch<'s, 'p, 'a> {
    context: &'s SolveContext<'a>,
    prover: &'s mut Prover<'p>,
    statistics: &'s mut PassStatistics,
    pass: u32,
    queries: u32,
    /// What has been found so far.
    found: Vec<Claim>,
}

impl PartSearch<'_, '_, '_> {
    /// True if every part of the pair is hidden, or faces away.
    fn hides(&mut self, source: &Element, receiver: &Element, splits: u32) -> bool {
        if splits == 0 {
            return false;
        }
        let by_source = splits_source(source, receiver);
        let parts = self.parts_of(if by_source { source } else { receiver });
        let whole = parts.iter().all(|part| {
            let (from, to) = if by_source {
                (part, receiver)
            } else {
                (source, part)
            };
            self.hides_one(from, to, splits - 1)
        });
        whole && !parts.is_empty()
    }

    fn hides_one(&mut self, from: &Element, to: &Element, splits: u32) -> bool {
        let tau = self.context.tau;
        // As the oracle ends such pairs.
        if from.faces_away(to, tau) || to.faces_away(from, tau) {
            return true;
        }
        if self.queries == MOST_QUERIES {
            return false;
        }
        self.queries += 1;
        self.statistics.shafts += 1;
        let hiding = self.prover.occluder_between(from, to);
        if let Some(by) = hiding.by {
            self.found.push(Claim {
                pass: self.pass,
                source: from.name(),
                receiver: to.name(),
                occluder: Some(by),
            });
            return true;
        }
        // What nothing crosses in the middle is hidden by nothing, nor by several.
        hiding.may_hide && self.hides(from, to, splits)
    }

    /// The next smaller parts of an element, which cover it; none of one that is not to be split.
    fn parts_of(&self, element: &Element) -> Vec<Element> {
        if element.radius < LEAST_RADIUS_IN_TAU * self.context.tau {
            return Vec::new();
        }
        let mut parts = element.parts(self.context.hierarchy, self.context.elements);
        if self.prover.forgets_a_part() {
            parts.pop();
        }
        parts
    }
}

impl<const C: usize> Task<'_, '_, C> {
    /// Tries to hide the parts of a pair. If it could, the claim: the pair, and one of the occluders.
    pub(super) fn hide_parts(&mut self, source: &Element, receiver: &Element) -> Option<Claim> {
        let mut search = PartSearch {
            context: &self.pass.context,
            prover: self.prover.as_mut()?,
            statistics: &mut self.outcome.statistics,
            pass: self.pass.pass,
            queries: 0,
            found: Vec::new(),
        };
        if !search.hides(source, receiver, MOST_SPLITS) {
            return None;
        }
        let parts = search.found;
        let claim = Claim {
            source: source.name(),
            receiver: receiver.name(),
            ..*parts.first()?
        };
        self.outcome.statistics.occluded_claims += 1;
        if self.outcome.claims.is_wanted() {
            let key = exchange_key(self.pass.key, source, receiver);
            self.outcome.claims.offer(key, claim, &parts);
        }
        Some(claim)
    }
}

#[cfg(test)]
mod tests {
    use crate::cluster::Hierarchy;
    use crate::math::FacetId;
    use crate::solve::config::{SolveConfig, Stop, Stride};
    use crate::solve::element_name::ElementName;
    use crate::solve::fixture::{add_plate, grey, prepare, scene};
    use crate::solve::observer::Observer;
    use crate::solve::solve::{Solved, solve};
    use glam::Vec3;
    use std::sync::atomic::{AtomicU64, Ordering};

    /// The plate that the lamp faces: the second, of two triangles.
    const LIT: std::ops::Range<usize> = 2..4;

    /// Counts the rays to that plate.
    struct RaysToPlate<'a> {
        hierarchy: &'a Hierarchy,
        rays: AtomicU64,
    }

    impl Observer for RaysToPlate<'_> {
        fn counts_rays(&self) -> bool {
            true
        }

        fn rays_cast(&self, receiver: ElementName, rays: u32) {
            let first = self.hierarchy.node(receiver.node).first_facet as usize;
            if LIT.contains(&self.hierarchy.facets[first].polygon.index()) {
                self.rays.fetch_add(u64::from(rays), Ordering::Relaxed);
            }
        }
    }

    /// A lamp and a plate face each other past two walls, one up to `overlap`, the other down to minus that. Rays to the
    /// plate, and what it receives.
    fn past_two_walls(overlap: f32, stride: Stride) -> (u64, f64) {
        let mut s = scene(vec![grey(0.0, 0.0), grey(0.0, 1.0)]);
        let mut plate = |x: f32, from: f32, to: f32, half: f32, faces_up: bool, surface| {
            let (u, v) = (Vec3::Y * (to - from), Vec3::Z * (2.0 * half));
            let (u, v) = if faces_up { (u, v) } else { (v, u) };
            add_plate(&mut s, Vec3::new(x, from, -half), u, v, 1, surface);
        };
        // `faces_up`: the front towards +x.
        plate(-0.4, -0.15, 0.15, 0.1, true, 1);
        plate(0.4, -0.15, 0.15, 0.1, false, 0);
        plate(-0.1, -0.4, overlap, 0.4, true, 0);
        plate(0.1, -overlap, 0.4, 0.4, true, 0);
        // What lies on the scene's bounds is no occluder.
        plate(-0.45, -0.45, 0.45, 0.45, true, 0);
        plate(0.45, -0.45, 0.45, 0.45, false, 0);
        let prepared = prepare(&s);
        let observer = RaysToPlate {
            hierarchy: &prepared.hierarchy,
            rays: AtomicU64::new(0),
        };
        let config = SolveConfig {
            stride,
            stop: Stop::Passes(1),
            ..SolveConfig::default()
        };
        let Solved { solution, .. } = solve(&prepared, &config, &observer).expect("solves");
        let mut light = 0.0;
        for (f, facet) in solution.facets.iter().enumerate() {
            if LIT.contains(&facet.polygon.index()) {
                let patches = solution.facet_patches(FacetId::new(f));
                light += patches
                    .iter()
                    .map(|p| f64::from(p.irradiance[0]))
                    .sum::<f64>();
            }
        }
        (observer.rays.into_inner(), light)
    }

    /// A segment from y = a on the lamp to b on the plate is at (5 a + 3 b) / 8 and (3 a + 5 b) / 8 above the walls, at most
    /// 0.075 apart: walls that overlap by more leave no way through, though each leaves open what the other closes.
    #[test]
    fn two_walls_hide_what_neither_hides_alone() {
        let (rays, light) = past_two_walls(0.045, Stride::Every(1));
        assert_eq!((rays, light), (0, 0.0));
        let (rays, light) = past_two_walls(0.045, Stride::Auto);
        assert!(rays > 0 && light == 0.0, "{rays} rays, {light}");
    }

    #[test]
    fn a_way_between_two_walls_is_found() {
        let (rays, light) = past_two_walls(0.03, Stride::Every(1));
        let (rays_asked_less, same) = past_two_walls(0.03, Stride::Auto);
        assert!(light > 0.0 && light == same, "{light} {same}");
        assert!(
            0 < rays && rays < rays_asked_less,
            "{rays} {rays_asked_less}"
        );
    }
}
