//! One pass: the scene's unshot radiosity is shot onto the scene itself (paper, sections 4 and 6.1).
//!
//! Every task owns its receivers and reads sources from the state frozen before the pass, so the
//! result has the same bits at any number of threads.

use super::claim_check::ClaimCheck;
use super::claims::ClaimSample;
use super::config::SolveConfig;
use super::element::Element;
use super::guarantees::Guarantees;
use super::observer::Observer;
use super::oracle::Oracle;
use super::query_schedule::QuerySchedule;
use super::radiosity::{Radiosity, Shooter};
use super::sampled_element::{ReceiverSurface, SourceSurface};
use super::statistics::PassStatistics;
use super::walk::{Source, Task, TaskOutcome};
use crate::cluster::Hierarchy;
use crate::embree::CommittedScene;
use crate::math::hash_u64;
use crate::scene::Scene;
use crate::visibility::{SampleCount, SampledVisibility, SegmentTest, sample_visibility};
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
pub(super) struct Pass<'a, const C: usize> {
    pub(super) context: SolveContext<'a>,
    pub(super) shooters: &'a [Shooter<C>],
    pub(super) node_unshot: &'a [[f32; C]],
    pub(super) node_variance: &'a [f32],
    pub(super) power_before: &'a [f64],
    pub(super) owner_of_facet: &'a [u32],
    pub(super) first_facets: &'a [u32],
    pub(super) oracle: Oracle,
    pub(super) config: &'a SolveConfig,
    pub(super) pass: u32,
    /// Hash of the seed and the pass.
    pub(super) key: u64,
    /// Power that all owners together may drop.
    pub(super) drop_budget: f64,
    pub(super) arch: Arch,
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

/// One in how many tasks goes before the others.
const FIRST_TASKS: usize = 16;

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
    pub(super) fn sample(
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

/// The name of an exchange's samples: (receiver, source, pass, seed).
pub(super) fn exchange_key(pass_key: u64, source: &Element, receiver: &Element) -> u64 {
    let end = |e: &Element| hash_u64(u64::from(e.node.0) ^ e.path.0.rotate_left(32));
    hash_u64(end(receiver).wrapping_add(hash_u64(end(source) ^ pass_key)))
}
