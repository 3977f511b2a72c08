//! A solve: passes until the light is spent.

use super::claim_check::ClaimCheck;
use super::claims::{Claim, ClaimSample};
use super::config::{Normalise, SolveConfig, Stop};
use super::element::Element;
use super::error::SolveError;
use super::facet_table::FacetTable;
use super::guarantees::Guarantees;
use super::ledger::{Escape, RadiatingPatch, absorbed_power, escape};
use super::observer::Observer;
use super::pass::run_pass;
use super::pass_context::SolveContext;
use super::prepared::PreparedScene;
use super::push_pull::{FacetProperties, gathered_power, push_pull, sum_leaves};
use super::radiosity::{Light, Radiosity};
use super::snapshot::{Carried, Snapshot, SnapshotError};
use super::solution::{PatchPath, Solution, SolvedPatch};
use super::statistics::{PassStatistics, PowerLedger};
use super::task::PassOutcome;
use crate::cluster::Hierarchy;
use crate::embree::CommittedScene;
use crate::math::{FacetId, NodeId};
use crate::scene::Scene;
use rayon::prelude::*;
use std::time::Instant;

/// A finished solve.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Solved {
    /// The leaf patches with their light.
    pub solution: Solution,
    /// One a pass.
    pub passes: Vec<PassStatistics>,
    /// Where the power went.
    pub power: PowerLedger,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Channels that were carried: 1 or 3.
    pub channels: usize,
    /// Leaf patches.
    pub leaves: usize,
    /// Bytes of the light at the end.
    pub bytes: usize,
    /// Whether passes were scaled to conserve power (row normalisation), and the scales.
    pub normalised: Option<Vec<f64>>,
    /// Claims kept for an audit ([`SolveConfig::keep_claims`]).
    pub claims: Vec<Claim>,
    /// What the rays of claimed exchanges said ([`SolveConfig::check_claims`]).
    pub check: ClaimCheck,
}

/// Solves a prepared scene. What the technique proves, it proves with the scene's guarantees
/// ([`PreparedScene::with_guarantees`]); without them every exchange is sampled.
///
/// # Errors
/// A setting out of range, or an interruption by the observer.
pub fn solve(
    prepared: &PreparedScene,
    config: &SolveConfig,
    observer: &dyn Observer,
) -> Result<Solved, SolveError> {
    config.validate()?;
    match prepared.scene.channels() {
        1 => Solver::<1>::new(prepared, config, observer).run(Carried::default()),
        _ => Solver::<3>::new(prepared, config, observer).run(Carried::default()),
    }
}

/// Goes on from a state that [`Observer::state_reached`] was given, to the same bits as a solve of the same
/// scene with the same settings that was never stopped. Claims are no part of a state, so none may be asked for.
///
/// # Errors
/// As [`solve`], and [`SolveError::Snapshot`] where the state is of another scene or damaged.
pub fn resume(
    prepared: &PreparedScene,
    config: &SolveConfig,
    observer: &dyn Observer,
    snapshot: &Snapshot,
) -> Result<Solved, SolveError> {
    config.validate()?;
    if config.keep_claims > 0 || config.check_claims {
        let reason = "claims of its earlier passes were not kept";
        return Err(SnapshotError(reason.to_owned()).into());
    }
    match prepared.scene.channels() {
        1 => Solver::<1>::new(prepared, config, observer).go_on(snapshot),
        _ => Solver::<3>::new(prepared, config, observer).go_on(snapshot),
    }
}

/// A solve under way. Public to the experiments, which run single passes from given states.
pub struct Solver<'a, const C: usize> {
    scene: &'a Scene,
    hierarchy: &'a Hierarchy,
    embree: &'a CommittedScene,
    guarantees: Option<&'a Guarantees>,
    config: &'a SolveConfig,
    observer: &'a dyn Observer,
    table: FacetTable<C>,
    /// The element of each node: the walk meets each of them many times.
    elements: Vec<Element>,
    /// Emitted power of each channel, in units of the table's radiosity times normalised area.
    emitted: Light<C>,
    light: Radiosity<C>,
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
            table,
            emitted,
            light,
        }
    }

    fn go_on(mut self, snapshot: &Snapshot) -> Result<Solved, SolveError> {
        let carried = snapshot.restore(self.hierarchy, &mut self.light)?;
        self.run(carried)
    }

    fn run(mut self, mut carried: Carried) -> Result<Solved, SolveError> {
        let mut warnings = Vec::new();
        let mut claims = ClaimSample::new(self.config.keep_claims);
        let mut check = ClaimCheck::default();
        let normalise = self.normalises();
        let mut unshot = self.unshot_power();
        while !self.is_done(&carried.passes, unshot, &mut warnings) {
            let pass = carried.passes.len() as u32 + 1;
            let (outcome, scale) = self.pass(pass, normalise)?;
            let mut statistics = outcome.statistics;
            carried.dropped += outcome.dropped;
            carried.scales.push(scale);
            claims.merge(outcome.claims);
            check.merge(outcome.check);
            unshot = self.unshot_power();
            statistics.unshot = self.to_watts(unshot);
            carried.passes.push(statistics);
            self.observer
                .pass_done(&statistics, self.share_of_emitted(unshot));
            self.observer
                .state_reached(&|| Snapshot::take(&carried, &self.light));
        }
        let power = self.ledger(unshot + self.dropped_mean(carried.dropped));
        let solution = self.solution();
        Ok(Solved {
            leaves: solution.patches.len(),
            solution,
            passes: carried.passes,
            power,
            warnings,
            channels: C,
            bytes: self.light.bytes(),
            normalised: normalise.then_some(carried.scales),
            claims: claims.into_claims(),
            check,
        })
    }

    /// Whether so many passes are enough, with a warning where they are too many.
    fn is_done(&self, passes: &[PassStatistics], unshot: f64, warnings: &mut Vec<String>) -> bool {
        let made = passes.len() as u32;
        let fraction = self.share_of_emitted(unshot);
        let done = match self.config.stop {
            Stop::Passes(n) => made >= n || unshot == 0.0,
            Stop::Converged(x) => fraction < x,
        };
        if !done && made >= SolveConfig::MAX_PASSES {
            warnings.push(self.not_converged(passes, fraction));
            return true;
        }
        made > 0 && done
    }

    fn share_of_emitted(&self, power: f64) -> f64 {
        let emitted = mean(&self.emitted);
        if emitted > 0.0 { power / emitted } else { 0.0 }
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
            normals: &self.table.normals,
            frames: &self.table.frames,
            area_before: &self.table.area_before,
            polygon_area: self.table.polygon_area,
            tau: self.scene.tau(),
            observer: self.observer,
        }
    }

    /// Runs one pass and pushes its light: its outcome and the normalising scale.
    fn pass(&mut self, pass: u32, normalise: bool) -> Result<(PassOutcome, f64), SolveError> {
        let start = Instant::now();
        let shot = self.unshot_power();
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
        self.light.pull_nodes(self.hierarchy);
        outcome.statistics.seconds = start.elapsed().as_secs_f64();
        Ok((outcome, scale))
    }

    /// Dropped power is bounded in the greatest channel; the ledger is a mean of the channels.
    fn dropped_mean(&self, dropped: f64) -> f64 {
        let greatest = self.emitted.iter().copied().fold(0.0, f64::max);
        if greatest > 0.0 {
            dropped * mean(&self.emitted) / greatest
        } else {
            0.0
        }
    }

    /// Mean of the channels of the power that has yet to be shot.
    fn unshot_power(&self) -> f64 {
        self.light
            .gatherers
            .par_iter()
            .zip(&self.light.shooters)
            .map(|(gatherer, shooter)| {
                let mut sum = 0.0;
                sum_leaves(
                    gatherer,
                    |f| self.table.area(f),
                    |_, at, area| {
                        sum += area * mean(&shooter.unshot[at].map(f64::from));
                    },
                );
                sum
            })
            .collect::<Vec<f64>>()
            .iter()
            .sum()
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

    fn push(&mut self, scale: f64) {
        let properties = FacetProperties {
            reflectance: &self.table.reflectance,
            normals: &self.table.normals,
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

    /// Row normalisation is on: asked for, or a bright closed scene.
    fn normalises(&self) -> bool {
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
            self.config.seed,
        );
        let area: f64 = self.table.areas.iter().sum();
        lost.escaped + lost.swallowed <= SLIPS * area
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

    /// Radiosity of a leaf, emission included, in the solve's unit.
    fn leaf_radiosity(&self, facet: FacetId, irradiance: &Light<C>) -> Light<C> {
        let i = facet.index();
        std::array::from_fn(|c| {
            self.table.emitted[i][c] + self.table.reflectance[i][c] * irradiance[c]
        })
    }

    fn ledger(&self, unshot: f64) -> PowerLedger {
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
        }
    }

    fn solution(&self) -> Solution {
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

    /// A light of the solve as red, green and blue in W/m2.
    fn to_rgb(&self, light: &Light<C>) -> [f32; 3] {
        std::array::from_fn(|k| (light[k.min(C - 1)] * self.table.unit) as f32)
    }

    /// A power of the solve in W.
    fn to_watts(&self, power: f64) -> f64 {
        self.scene.normalisation.area_to_file(power) * self.table.unit
    }

    fn not_converged(&self, passes: &[PassStatistics], fraction: f64) -> String {
        let ratio = match passes {
            [.., a, b] if a.unshot > 0.0 => b.unshot / a.unshot,
            _ => 1.0,
        };
        let asked = match self.config.stop {
            Stop::Converged(x) => x,
            Stop::Passes(_) => fraction,
        };
        if ratio < 1.0 {
            let more = ((asked / fraction).ln() / ratio.ln()).ceil();
            format!(
                "stopped after {} passes with {:.3e} of the emitted power unshot; about {} more passes would be needed to reach {asked:e}",
                passes.len(),
                fraction,
                more
            )
        } else {
            format!(
                "stopped after {} passes with {:.3e} of the emitted power unshot, which no longer falls",
                passes.len(),
                fraction
            )
        }
    }
}

/// Share of the rays of a closed scene that may seem to leave it: Embree's own test of watertightness allows as many to
/// slip through shared edges. Scaling a scene that is open by no more than this adds as little light to a pass.
const SLIPS: f64 = 2.0e-5;

/// Mean of the channels.
fn mean<const C: usize>(light: &Light<C>) -> f64 {
    light.iter().sum::<f64>() / C as f64
}
