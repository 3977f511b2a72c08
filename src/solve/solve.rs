//! A solve: passes until the light is spent.

use super::claim_check::ClaimCheck;
use super::claims::{ClaimSample, ProvedPair};
use super::config::{SolveConfig, Stop, Technique};
use super::error::SolveError;
use super::observer::Observer;
use super::prepared::PreparedScene;
use super::snapshot::{Carried, Snapshot, SnapshotError};
use super::solution::Solution;
use super::solver::{Solver, mean};
use super::statistics::{PassStatistics, PowerLedger};

/// Share of the emitted power unaccounted for from which a solve warns: default settings promise less, and the ledger's
/// own noise stays below it.
const IMBALANCE_TO_WARN_OF: f64 = 0.01;
/// Share of the emitted power that may end where no face receives it before a warning says so.
const SWALLOWED_TO_WARN_OF: f64 = 0.01;

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
    pub claims: Vec<ProvedPair>,
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

impl<const C: usize> Solver<'_, C> {
    fn go_on(mut self, snapshot: &Snapshot) -> Result<Solved, SolveError> {
        let carried = snapshot.restore(self.hierarchy, &self.table.frames, &mut self.light)?;
        self.run(carried)
    }

    fn run(mut self, mut carried: Carried) -> Result<Solved, SolveError> {
        let mut warnings = Vec::new();
        let mut claims = ClaimSample::new(self.config.keep_claims);
        let mut check = ClaimCheck::default();
        let normalise = self.normalises();
        let mut unshot = self.unshot_power();
        while !self.is_done(&carried.passes, mean(&unshot), &mut warnings) {
            let pass = carried.passes.len() as u32 + 1;
            let (outcome, scale) = self.pass(pass, normalise)?;
            let mut statistics = outcome.statistics;
            carried.scales.push(scale);
            claims.merge(outcome.claims);
            check.merge(outcome.check);
            carried.shot = unshot.to_vec();
            unshot = self.unshot_power();
            statistics.unshot = self.to_watts(mean(&unshot));
            carried.passes.push(statistics);
            self.observer
                .pass_done(&statistics, self.share_of_emitted(mean(&unshot)));
            self.observer
                .state_reached(&|| Snapshot::take(&carried, &self.light));
        }
        let extrapolated = match (self.config.stop, carried.shot.as_slice().try_into()) {
            // At the cap of passes the tail would be most of the light.
            (Stop::Converged(x), Ok(shot)) if self.share_of_emitted(mean(&unshot)) < x => {
                self.add_tail(&shot)
            }
            _ => 0.0,
        };
        let unshot = mean(&self.unshot_power());
        let power = self.ledger(unshot, extrapolated);
        let is_off = power.imbalance.abs() > IMBALANCE_TO_WARN_OF;
        if is_off && self.config.technique != Technique::Unoccluded {
            warnings.push(format!(
                "{:+.2} % of the power is unaccounted for: a smaller epsilon brings it down",
                100.0 * power.imbalance
            ));
        }
        if power.swallowed > SWALLOWED_TO_WARN_OF * power.emitted {
            warnings.push(format!(
                "{:.2} % of the power ends on backs that have no side, or between surfaces that touch: is a lamp covered, or a face turned about?",
                100.0 * power.swallowed / power.emitted
            ));
        }
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
