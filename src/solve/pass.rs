//! One pass: the scene's unshot radiosity is shot onto the scene itself (paper, sections 4 and 6.1).
//!
//! Every task owns its receivers and reads sources from the state frozen before the pass, so the
//! result has the same bits at any number of threads.

use super::claims::ClaimSample;
use super::config::SolveConfig;
use super::oracle::Oracle;
use super::pass_context::{Pass, SolveContext};
use super::query_schedule::QuerySchedule;
use super::radiosity::Radiosity;
use super::task::{PassOutcome, Task};
use super::walk::TaskOutcome;
use crate::math::hash_u64;
use pulp::Arch;
use rayon::prelude::*;

/// How much coarser a gradient reflected light may leave on a receiver: its sources are large, and what one of them
/// leaves unresolved others fill in. Measured: the same error, 8 to 9 % fewer exchanges in
/// cornell, d and two-rooms (`bench/runs/`, accuracy).
const REFLECTED_GRADIENT: f64 = 4.0;

/// Share of the mean irradiance that an exchange of pass `pass` may leave unresolved on its receiver.
fn gradient(config: &SolveConfig, pass: u32) -> f64 {
    match pass {
        1 => config.gradient,
        _ => REFLECTED_GRADIENT * config.gradient,
    }
}

/// How much more than the gradient a pair that was played for may leave on its receiver. Measured (`bench/runs/`, peers): four
/// leaves the error of cornell, d, f and two-rooms the same within the noise for 4 to 17 % fewer exchanges.
const LOT_GRADIENT: f64 = 4.0;

/// The epsilon above which lots grow as its root. In scenes of many small faces this limit alone decides how
/// many lots fall on each, and epsilon would change nothing: an office of 21,000 faces took half of the time of 1e-5 at
/// 1e-2.
const LOT_EPSILON: f64 = 1.0e-5;

/// Share of the mean irradiance that a pair which was played for may leave on its receiver.
fn lot_irradiance(config: &SolveConfig) -> f64 {
    LOT_GRADIENT * config.gradient * (config.epsilon / LOT_EPSILON).max(1.0).sqrt()
}

/// Share of the emitted power that a pair which was played for may carry, whatever epsilon: lots of so much move the
/// power of the whole scene by less than a per cent (the root of it), were all pairs played for.
const MOST_PLAYED: f64 = 1.0e-4;

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
        node_moment,
        power_before,
        is_even,
        owner_of_facet,
        first_facets,
    } = light;
    let pass_data = Pass {
        context,
        shooters,
        node_unshot,
        node_variance,
        node_moment,
        power_before,
        is_even,
        owner_of_facet,
        first_facets,
        oracle: Oracle {
            threshold: config.epsilon * emitted,
            irradiance_tolerance: gradient(config, pass) * emitted / context.polygon_area,
            played_power: MOST_PLAYED * emitted,
            played_irradiance: lot_irradiance(config) * emitted / context.polygon_area,
            min_area: (config.min_area * context.polygon_area) as f32,
            tau: context.tau,
        },
        config,
        pass,
        key: hash_u64(config.seed ^ hash_u64(u64::from(pass))),
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
                let mut task = Task::new(&pass_data, gatherer, schedule).run(owner);
                task.schedule = task.schedule.filter(|_| is_first);
                context
                    .observer
                    .task_done(task.outcome.statistics.exchanges);
                task
            })
            .collect()
    };
    let mut outcomes = run_some(true, &QuerySchedule::new(config.technique));
    let learned = QuerySchedule::after(
        config.technique,
        outcomes.iter().filter_map(|t| t.schedule.as_ref()),
    );
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
        sum.interrupted |= outcome.interrupted;
        sum.claims.merge(outcome.claims);
        sum.check.merge(outcome.check);
        sum.blocked.merge(outcome.blocked);
    }
    sum.statistics.pass = pass;
    sum
}
