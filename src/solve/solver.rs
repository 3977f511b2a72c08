//! The state of a solve, and its passes.

use super::config::{Normalise, SolveConfig};
use super::element::Element;
use super::error::SolveError;
use super::facet_table::FacetTable;
use super::flux_tree::FluxTree;
use super::guarantees::Guarantees;
use super::ledger::{RadiatingPatch, escape};
use super::observer::Observer;
use super::pass::run_pass;
use super::pass_context::SolveContext;
use super::prepared::PreparedScene;
use super::push_pull::{FacetProperties, gathered_power, push_pull, sum_leaves};
use super::radiosity::{Light, Radiosity};
use super::solution::PatchPath;
use super::task::PassOutcome;
use crate::cluster::Hierarchy;
use crate::embree::CommittedScene;
use crate::math::{FacetId, NodeId};
use crate::scene::Scene;
use rayon::prelude::*;
use std::time::Instant;

/// A solve under way. Public to the experiments, which run single passes from given states.
pub struct Solver<'a, const C: usize> {
    pub(super) scene: &'a Scene,
    pub(super) hierarchy: &'a Hierarchy,
    pub(super) embree: &'a CommittedScene,
    pub(super) guarantees: Option<&'a Guarantees>,
    pub(super) config: &'a SolveConfig,
    pub(super) observer: &'a dyn Observer,
    pub(super) table: FacetTable<C>,
    /// The element of each node: the walk meets each of them many times.
    pub(super) elements: Vec<Element>,
    pub(super) flux_tree: FluxTree,
    /// Emitted power of each channel, in units of the table's radiosity times normalised area.
    pub(super) emitted: Light<C>,
    pub(super) light: Radiosity<C>,
}

impl<'a, const C: usize> Solver<'a, C> {
    /// Prepares a solve.
    pub fn new(
        prepared: &'a PreparedScene,
        config: &'a SolveConfig,
        observer: &'a dyn Observer,
    ) -> Self {
        let PreparedScene {
            scene,
            hierarchy,
            embree,
            guarantees,
            ..
        } = prepared;
        let table = FacetTable::<C>::new(scene, hierarchy);
        let light = Radiosity::new(hierarchy, |f| table.emitted[f.index()]);
        let mut emitted = [0.0; C];
        for (power, area) in table.emitted.iter().zip(&table.areas) {
            for c in 0..C {
                emitted[c] += power[c] * area;
            }
        }
        Self {
            scene,
            hierarchy,
            embree,
            guarantees: guarantees.as_ref(),
            config,
            observer,
            elements: (0..hierarchy.nodes.len())
                .map(|n| Element::of_node(scene, hierarchy, NodeId::new(n)))
                .collect(),
            flux_tree: FluxTree::new(scene, hierarchy),
            table,
            emitted,
            light,
        }
    }

    /// Runs pass number `pass` with this solve's own settings: the light after it is what the next
    /// starts from.
    ///
    /// # Errors
    /// An interruption by the observer.
    pub fn advance(&mut self, pass: u32) -> Result<PassOutcome, SolveError> {
        let normalise = self.normalises();
        self.pass(pass, normalise).map(|(outcome, _)| outcome)
    }

    /// Runs pass number `pass` with other settings from the present light, which stays as it is.
    ///
    /// # Errors
    /// An interruption by the observer.
    pub fn trial(&self, pass: u32, config: &SolveConfig) -> Result<PassOutcome, SolveError> {
        let mut light = self.light.clone();
        let start = Instant::now();
        let greatest = self.emitted.iter().copied().fold(0.0, f64::max);
        let mut outcome = run_pass(self.context(), config, &mut light, pass, greatest);
        outcome.statistics.seconds = start.elapsed().as_secs_f64();
        match outcome.interrupted {
            false => Ok(outcome),
            true => Err(SolveError::Interrupted {
                pass,
                completed: pass - 1,
            }),
        }
    }

    fn context(&self) -> SolveContext<'_> {
        SolveContext {
            scene: self.scene,
            hierarchy: self.hierarchy,
            embree: self.embree,
            guarantees: self.guarantees,
            elements: &self.elements,
            flux_tree: &self.flux_tree,
            frames: &self.table.frames,
            touched_before: &self.table.touched_before,
            area_before: &self.table.area_before,
            polygon_area: self.table.polygon_area,
            tau: self.scene.tau(),
            observer: self.observer,
        }
    }

    /// Runs one pass and pushes its light: its outcome and the normalising scale.
    pub(super) fn pass(
        &mut self,
        pass: u32,
        normalise: bool,
    ) -> Result<(PassOutcome, f64), SolveError> {
        let start = Instant::now();
        let shot = mean(&self.unshot_power());
        let greatest = self.emitted.iter().copied().fold(0.0, f64::max);
        let mut light = std::mem::take(&mut self.light);
        let mut outcome = run_pass(self.context(), self.config, &mut light, pass, greatest);
        self.light = light;
        if outcome.interrupted {
            return Err(SolveError::Interrupted {
                pass,
                completed: pass - 1,
            });
        }
        let scale = if normalise {
            let arrived = self.gathered_power();
            if arrived > 0.0 { shot / arrived } else { 1.0 }
        } else {
            1.0
        };
        self.push(scale);
        self.light.pull_nodes(self.hierarchy, &self.table.frames);
        outcome.statistics.seconds = start.elapsed().as_secs_f64();
        Ok((outcome, scale))
    }

    fn push(&mut self, scale: f64) {
        let properties = FacetProperties {
            reflectance: &self.table.reflectance,
            frames: &self.table.frames,
        };
        let hierarchy = self.hierarchy;
        self.light
            .gatherers
            .par_iter_mut()
            .zip(&mut self.light.shooters)
            .for_each(|(gatherer, shooter)| {
                push_pull(hierarchy, &properties, gatherer, shooter, scale);
            });
    }

    /// Power of each channel that has yet to be shot.
    pub(super) fn unshot_power(&self) -> Light<C> {
        let parts: Vec<Light<C>> = self
            .light
            .gatherers
            .par_iter()
            .zip(&self.light.shooters)
            .map(|(gatherer, shooter)| {
                let mut sum = [0.0; C];
                sum_leaves(
                    gatherer,
                    |f| self.table.area(f),
                    |_, at, area| {
                        for (sum, unshot) in sum.iter_mut().zip(shooter.unshot[at]) {
                            *sum += area * f64::from(unshot);
                        }
                    },
                );
                sum
            })
            .collect();
        std::array::from_fn(|c| parts.iter().map(|part| part[c]).sum())
    }

    /// Mean of the channels of the power that this pass brought, before it is pushed.
    fn gathered_power(&self) -> f64 {
        self.light
            .gatherers
            .par_iter()
            .map(|gatherer| {
                mean(&gathered_power(self.hierarchy, gatherer, |f| {
                    self.table.area(f)
                }))
            })
            .collect::<Vec<f64>>()
            .iter()
            .sum()
    }

    pub(super) fn share_of_emitted(&self, power: f64) -> f64 {
        let emitted = mean(&self.emitted);
        if emitted > 0.0 { power / emitted } else { 0.0 }
    }

    /// Row normalisation is on: asked for, or a bright closed scene.
    pub(super) fn normalises(&self) -> bool {
        let bright = self
            .table
            .reflectance
            .iter()
            .flatten()
            .any(|&r| r >= SolveConfig::NORMALISE_FROM);
        match self.config.normalise {
            Normalise::Off => false,
            Normalise::On => self.is_closed(),
            Normalise::Auto => bright && self.is_closed(),
        }
    }

    /// True when no more probe rays than slip through edges leave the scene or end on a back without a side.
    fn is_closed(&self) -> bool {
        let weights: Vec<RadiatingPatch> = (0..self.hierarchy.facets.len())
            .map(|f| RadiatingPatch {
                facet: FacetId::new(f),
                path: PatchPath::ROOT,
                power: self.table.areas[f],
            })
            .collect();
        let lost = escape(
            self.scene,
            self.hierarchy,
            self.embree,
            &self.table.normals,
            &weights,
            0.0,
            self.config.seed,
        );
        let area: f64 = self.table.areas.iter().sum();
        lost.escaped + lost.swallowed <= SLIPS * area
    }

    /// A power of the solve in W.
    pub(super) fn to_watts(&self, power: f64) -> f64 {
        self.scene.normalisation.area_to_file(power) * self.table.unit
    }
}

/// Share of the rays of a closed scene that may seem to leave it: Embree's own test of watertightness allows as many to
/// slip through shared edges. Scaling a scene that is open by no more than this adds as little light to a pass.
const SLIPS: f64 = 2.0e-5;

/// Mean of the channels.
pub(super) fn mean<const C: usize>(light: &Light<C>) -> f64 {
    light.iter().sum::<f64>() / C as f64
}
