//! Speed against accuracy: the same scene solved at many settings, each timed several times and compared
//! with a reference.

use super::comparison::Times;
use super::pareto::pareto_front;
use super::processor_time::processor_seconds;
use super::sweep_settings::SweepSettings;
use crate::reference::{NothingToCompare, TrueFace, solution_error, solution_lights};
use crate::solve::{
    ConfigError, Observer, PassStatistics, PreparedScene, SolveConfig, SolveError, solve,
};
use serde::{Deserialize, Serialize};
use std::time::Instant;

/// One timing of a solve, what its technique has to build included (occluders, shafts' scene).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepTiming {
    /// Wall time.
    pub seconds: f64,
    /// Processor time, all threads together.
    pub processor_seconds: f64,
}

/// What a solve found: the same in every repeat.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepOutcome {
    /// Passes.
    pub passes: u32,
    /// Sums over the passes, as in [`PassStatistics`].
    pub exchanges: u64,
    /// Those whose rays were all blocked.
    pub exchanges_blocked: u64,
    /// Those that needed no ray because visibility was proved.
    pub exchanges_visible: u64,
    /// Rays cast through Embree.
    pub rays: u64,
    /// Those that were blocked.
    pub rays_blocked: u64,
    /// Segments tested natively.
    pub native_rays: u64,
    /// Pairs queried for a guarantee.
    pub shafts: u64,
    /// Rectangles that the technique had.
    pub occluder_count: usize,
    /// Leaf patches.
    pub leaves: usize,
    /// Relative RMS error against the reference, its noise included.
    pub relative_rms: f64,
    /// Bias against the reference.
    pub bias: f64,
    /// What a perfect solution would show as relative RMS error.
    pub reference_noise: f64,
    /// Power that is missing, over the emitted.
    pub imbalance: f64,
    /// Power yet to be shot, over the emitted.
    pub unshot: f64,
}

/// One point with all that is known of it.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepRow {
    /// Its settings.
    pub settings: SweepSettings,
    /// One a repeat.
    pub timings: Vec<SweepTiming>,
    /// `None` until it has been solved once.
    pub outcome: Option<SweepOutcome>,
}

impl SweepRow {
    /// A point that has not been solved.
    pub fn new(settings: SweepSettings) -> Self {
        Self {
            settings,
            timings: Vec::new(),
            outcome: None,
        }
    }

    /// Order statistics of wall time; `None` before the first solve.
    pub fn seconds(&self) -> Option<Times> {
        self.times(|t| t.seconds)
    }

    /// Order statistics of processor time; `None` before the first solve.
    pub fn processor_seconds(&self) -> Option<Times> {
        self.times(|t| t.processor_seconds)
    }

    fn times(&self, of: impl Fn(&SweepTiming) -> f64) -> Option<Times> {
        let all: Vec<f64> = self.timings.iter().map(of).collect();
        (!all.is_empty()).then(|| Times::new(all))
    }
}

/// For each row, whether it stands on the front of error against processor seconds, and on that of
/// error against rays. Rows that have not been solved do on neither; nor do those of `unoccluded`, which
/// casts no ray and is no way to light a scene.
pub fn sweep_fronts(rows: &[SweepRow]) -> Vec<[bool; 2]> {
    let point = |row: &SweepRow, cost: &dyn Fn(&SweepRow, &SweepOutcome) -> f64| {
        let lights = row.settings.technique != crate::solve::Technique::Unoccluded;
        match &row.outcome {
            Some(outcome) if lights => [cost(row, outcome), outcome.relative_rms],
            _ => [f64::NAN; 2],
        }
    };
    let front = |cost: &dyn Fn(&SweepRow, &SweepOutcome) -> f64| {
        let points: Vec<[f64; 2]> = rows.iter().map(|r| point(r, cost)).collect();
        pareto_front(&points)
    };
    let seconds = front(&|row, _| (row.processor_seconds()).map_or(f64::NAN, |times| times.median));
    let rays = front(&|_, outcome| outcome.rays as f64);
    seconds
        .into_iter()
        .zip(rays)
        .map(|(seconds, rays)| [seconds, rays])
        .collect()
}

/// The error that so many processor seconds buy: between two points of the front, on the straight line in
/// logarithms. `None` outside the front.
pub fn error_at_cost(rows: &[SweepRow], seconds: f64) -> Option<f64> {
    let mut front: Vec<[f64; 2]> = rows
        .iter()
        .zip(sweep_fronts(rows))
        .filter_map(|(row, [on, _])| {
            let error = row.outcome?.relative_rms;
            Some([row.processor_seconds().filter(|_| on)?.median, error])
        })
        .collect();
    front.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let exact = front.iter().find(|p| p[0] == seconds).map(|p| p[1]);
    exact.or_else(|| {
        let pair = front
            .windows(2)
            .find(|pair| pair[0][0] < seconds && seconds < pair[1][0])?;
        let (low, high) = (pair[0], pair[1]);
        let share = (seconds / low[0]).ln() / (high[0] / low[0]).ln();
        Some(low[1] * (high[1] / low[1]).powf(share))
    })
}

/// Why a point has no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// A setting is out of range.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The solve ended without a result.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// The reference has nothing to compare with.
    #[error(transparent)]
    NothingToCompare(#[from] NothingToCompare),
    /// An earlier run of the same settings gave something else.
    #[error(
        "{settings:?} gave another result than before: what was kept is of another scene, program or machine"
    )]
    NotRepeatable {
        /// The point.
        settings: Box<SweepSettings>,
    },
}

/// A sweep under way.
pub struct Sweep<'a> {
    prepared: &'a mut PreparedScene,
    truth: &'a [TrueFace],
    base: SolveConfig,
    /// The points, in the order in which they were asked for.
    pub rows: Vec<SweepRow>,
}

impl<'a> Sweep<'a> {
    /// Sweeps over `rows`, which may hold what an earlier run found. `base` says what no point says.
    ///
    /// # Errors
    /// The first setting out of range, before anything is solved.
    pub fn new(
        prepared: &'a mut PreparedScene,
        truth: &'a [TrueFace],
        base: SolveConfig,
        rows: Vec<SweepRow>,
    ) -> Result<Self, ConfigError> {
        for row in &rows {
            row.settings.solve_config(&base).validate()?;
        }
        Ok(Self {
            prepared,
            truth,
            base,
            rows,
        })
    }

    /// The row to solve next, so that each is solved `repeats` times: all rows once, then all once more in
    /// the other direction, and so on. A drift of the machine's speed then weighs on all alike.
    pub fn next(&self, repeats: usize) -> Option<usize> {
        let round = self.rows.iter().map(|r| r.timings.len()).min()?;
        let open = |row: &SweepRow| row.timings.len() == round;
        match (round < repeats, round % 2) {
            (false, _) => None,
            (true, 0) => self.rows.iter().position(open),
            (true, _) => self.rows.iter().rposition(open),
        }
    }

    /// Solves that are left until every row has been solved `repeats` times.
    pub fn left(&self, repeats: usize) -> usize {
        let missing = |row: &SweepRow| repeats.saturating_sub(row.timings.len());
        self.rows.iter().map(missing).sum()
    }

    /// Solves row `index` once more.
    ///
    /// # Errors
    /// An interruption by the observer; a result that differs from that of an earlier repeat.
    pub fn run(&mut self, index: usize, observer: &dyn Observer) -> Result<(), SweepError> {
        let settings = self.rows[index].settings;
        let config = settings.solve_config(&self.base);
        // What another technique built goes before the clock starts.
        self.prepared.guarantees = None;
        let (start, worked) = (Instant::now(), processor_seconds());
        self.prepared
            .make_guarantees(settings.technique, &settings.occluder_config());
        let solved = solve(self.prepared, &config, observer)?;
        let timing = SweepTiming {
            seconds: start.elapsed().as_secs_f64(),
            processor_seconds: processor_seconds() - worked,
        };
        let lights = solution_lights(&self.prepared.scene, &solved.solution);
        let error = solution_error(self.truth, &lights)?;
        let mut total = PassStatistics::default();
        solved.passes.iter().for_each(|p| total.add_counts(p));
        let share = |power: f64| match solved.power.emitted {
            emitted if emitted > 0.0 => power / emitted,
            _ => 0.0,
        };
        let guarantees = self.prepared.guarantees.as_ref();
        let outcome = SweepOutcome {
            passes: solved.passes.len() as u32,
            exchanges: total.exchanges,
            exchanges_blocked: total.exchanges_blocked,
            exchanges_visible: total.exchanges_visible,
            rays: total.rays,
            rays_blocked: total.rays_blocked,
            native_rays: total.native_rays,
            shafts: total.shafts,
            occluder_count: guarantees.map_or(0, |g| g.occluders.len()),
            leaves: solved.leaves,
            relative_rms: error.relative_rms,
            bias: error.bias,
            reference_noise: error.noise,
            imbalance: solved.power.imbalance,
            unshot: share(solved.power.unshot),
        };
        let row = &mut self.rows[index];
        if row.outcome.is_some_and(|before| before != outcome) {
            return Err(SweepError::NotRepeatable {
                settings: Box::new(settings),
            });
        }
        row.outcome = Some(outcome);
        row.timings.push(timing);
        Ok(())
    }
}
