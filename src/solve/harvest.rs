//! What a solver's light comes to: the patches with their light, and the account of the power.

use super::ledger::{Escape, RadiatingPatch, absorbed_power, escape};
use super::radiosity::Light;
use super::solution::{PatchPath, Solution, SolvedPatch};
use super::solver::{Solver, mean};
use super::statistics::PowerLedger;
use crate::math::FacetId;

/// Standard error that is good enough for the power that escapes, and for what is swallowed: a share of what was shot.
const ESCAPE_ERROR: f64 = 1.0e-3;

impl<const C: usize> Solver<'_, C> {
    /// Where the power went, with so much left unshot, and so much that arrives in passes that were not made.
    pub(super) fn ledger(&self, unshot: f64, extrapolated: f64) -> PowerLedger {
        let mut absorbed = 0.0;
        let mut radiating = Vec::new();
        self.for_each_leaf(|facet, path, area, owner, at| {
            let irradiance = &self.light.gatherers[owner].total[at];
            absorbed += absorbed_power(&self.table.reflectance[facet.index()], irradiance) * area;
            // What has been shot: the whole radiosity less what has yet to be.
            let left = self.light.shooters[owner].unshot[at].map(f64::from);
            let shot = mean(&self.leaf_radiosity(facet, irradiance)) - mean(&left);
            if shot > 0.0 {
                radiating.push(RadiatingPatch {
                    facet,
                    path,
                    power: shot * area,
                });
            }
        });
        let lost: Escape = escape(
            self.scene,
            self.hierarchy,
            self.embree,
            &self.table.normals,
            &radiating,
            ESCAPE_ERROR,
            self.config.seed,
        );
        let emitted = mean(&self.emitted);
        let absorbed = absorbed + lost.swallowed;
        let imbalance = if emitted > 0.0 {
            (emitted - absorbed - lost.escaped - unshot) / emitted
        } else {
            0.0
        };
        PowerLedger {
            emitted: self.to_watts(emitted),
            absorbed: self.to_watts(absorbed),
            escaped: self.to_watts(lost.escaped),
            escaped_stderr: self.to_watts(lost.escaped_stderr),
            unshot: self.to_watts(unshot),
            imbalance,
            extrapolated: self.to_watts(extrapolated),
            swallowed: self.to_watts(lost.swallowed),
        }
    }

    /// The leaf patches with their light.
    pub(super) fn solution(&self) -> Solution {
        let mut solution = Solution {
            facets: self.hierarchy.facets.clone(),
            patches: Vec::new(),
            first_patch: Vec::with_capacity(self.hierarchy.facets.len() + 1),
        };
        self.for_each_leaf(|facet, path, _, owner, at| {
            while solution.first_patch.len() <= facet.index() {
                solution.first_patch.push(solution.patches.len() as u32);
            }
            let irradiance = &self.light.gatherers[owner].total[at];
            let radiosity = self.leaf_radiosity(facet, irradiance);
            solution.patches.push(SolvedPatch {
                path,
                radiosity: self.to_rgb(&radiosity),
                irradiance: self.to_rgb(irradiance),
            });
        });
        solution.first_patch.push(solution.patches.len() as u32);
        solution
    }

    /// Radiosity of a leaf, emission included, in the solve's unit.
    fn leaf_radiosity(&self, facet: FacetId, irradiance: &Light<C>) -> Light<C> {
        let i = facet.index();
        std::array::from_fn(|c| {
            self.table.emitted[i][c] + self.table.reflectance[i][c] * irradiance[c]
        })
    }

    /// Calls `visit` for every leaf patch in facet order, depth first.
    fn for_each_leaf(&self, mut visit: impl FnMut(FacetId, PatchPath, f64, usize, usize)) {
        for (owner, gatherer) in self.light.gatherers.iter().enumerate() {
            for local in 0..gatherer.facet_count {
                let facet = FacetId(gatherer.first_facet + local);
                let mut stack = vec![(local as usize, PatchPath::ROOT, self.table.area(facet))];
                while let Some((at, path, area)) = stack.pop() {
                    match gatherer.children[at] as usize {
                        0 => visit(facet, path, area, owner, at),
                        first => stack.extend(
                            (0..4)
                                .rev()
                                .map(|k| (first + k, path.child(k as u32), area * 0.25)),
                        ),
                    }
                }
            }
        }
    }

    /// A light of the solve as red, green and blue in W/m2.
    fn to_rgb(&self, light: &Light<C>) -> [f32; 3] {
        std::array::from_fn(|k| (light[k.min(C - 1)] * self.table.unit) as f32)
    }
}
