//! Where the error of a solve comes from: each approximation in turn is made nearly exact, all others left as they
//! are, and what that takes off the error is what it was worth.

use super::processor_time::processor_seconds;
use super::sweep::SweepError;
use crate::reference::{SolvedLights, TrueFace, solution_error, solution_lights};
use crate::solve::{Observer, PreparedScene, SolveConfig, Stop, Technique, solve};
use serde::Serialize;

/// One approximation switched to a nearly exact one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Approximation {
    /// Exchanges are refined until they carry a tenth of epsilon: clusters and patches stand for less, contacts are
    /// resolved further.
    Oracle,
    /// A tenth of the gradient: irradiance that is linear on its receiver.
    LinearIrradiance,
    /// Patches of any size: radiosity that is constant on the smallest.
    SmallestPatch,
    /// Sixteen times the rays: sampled visibility.
    SampledVisibility,
    /// A hundredth of the unshot power: light that is never shot.
    UnshotLight,
    /// Rays for every exchange: proofs of occlusion and visibility, which shall be worth nothing.
    Proofs,
    /// All of the above at once, but for the proofs.
    All,
}

impl Approximation {
    /// All of them, in the order of a table.
    pub const EACH: [Self; 7] = [
        Self::Oracle,
        Self::LinearIrradiance,
        Self::SmallestPatch,
        Self::SampledVisibility,
        Self::UnshotLight,
        Self::Proofs,
        Self::All,
    ];

    /// What is changed, in the words of the command line.
    pub fn change(self) -> &'static str {
        match self {
            Self::Oracle => "oracle and contacts: epsilon / 10",
            Self::LinearIrradiance => "linear irradiance: gradient / 10",
            Self::SmallestPatch => "smallest patch: min-area 0",
            Self::SampledVisibility => "sampled visibility: rays x 16",
            Self::UnshotLight => "unshot light: converge / 100",
            Self::Proofs => "proofs: technique normal",
            Self::All => "all but the proofs",
        }
    }

    /// `config` with this approximation nearly exact.
    pub fn made_exact(self, config: &SolveConfig) -> SolveConfig {
        let mut config = config.clone();
        match self {
            Self::Oracle => config.epsilon *= 0.1,
            Self::LinearIrradiance => config.gradient *= 0.1,
            Self::SmallestPatch => config.min_area = 0.0,
            Self::SampledVisibility => {
                config.rays = config.rays.saturating_mul(16).min(SolveConfig::MAX_RAYS);
            }
            Self::UnshotLight => {
                config.stop = match config.stop {
                    Stop::Converged(x) => Stop::Converged(0.01 * x),
                    Stop::Passes(n) => Stop::Passes(n.saturating_mul(2)),
                }
            }
            Self::Proofs => config.technique = Technique::Normal,
            Self::All => {
                let each = Self::EACH.into_iter();
                config = each
                    .filter(|a| !matches!(a, Self::Proofs | Self::All))
                    .fold(config, |config, a| a.made_exact(&config));
            }
        }
        config
    }
}

/// The error of one solve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BudgetedError {
    /// Relative RMS error, the reference's noise taken off as a root of the difference of squares.
    pub relative_rms: f64,
    /// Bias.
    pub bias: f64,
    /// Processor time of the solve.
    pub processor_seconds: f64,
}

/// What one approximation is worth.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BudgetLine {
    /// Which.
    pub approximation: Approximation,
    /// The error without it.
    pub error: BudgetedError,
    /// Share of the squared error that went; negative where the error grew.
    pub removed: f64,
}

/// The budget of one scene at one setting.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ErrorBudget {
    /// The error at the given settings.
    pub error: BudgetedError,
    /// The reference's noise in the metric of the error.
    pub reference_noise: f64,
    /// Share of the squared error that differs from seed to seed: chance, of whatever origin.
    pub chance: f64,
    /// Solves with different seeds that `chance` is measured by.
    pub seeds: u32,
    /// One an approximation.
    pub lines: Vec<BudgetLine>,
}

/// Draws up the budget of `config`. The scene needs the guarantees of its technique. `seeds`, at least 2, are solved to tell chance from
/// the rest.
///
/// # Errors
/// A setting out of range; an interruption by the observer; nothing to compare with.
pub fn error_budget(
    prepared: &PreparedScene,
    truth: &[TrueFace],
    config: &SolveConfig,
    seeds: u32,
    observer: &dyn Observer,
) -> Result<ErrorBudget, SweepError> {
    let mut noise = 0.0;
    let mut run = |config: &SolveConfig| -> Result<(BudgetedError, SolvedLights), SweepError> {
        let worked = processor_seconds();
        let solved = solve(prepared, config, observer)?;
        let seconds = processor_seconds() - worked;
        let lights = solution_lights(&prepared.scene, &solved.solution);
        let error = solution_error(truth, &lights)?;
        noise = error.noise;
        let squares = error.relative_rms * error.relative_rms - noise * noise;
        let error = BudgetedError {
            relative_rms: squares.max(0.0).sqrt(),
            bias: error.bias,
            processor_seconds: seconds,
        };
        Ok((error, lights))
    };
    let mut by_seed = Vec::new();
    for seed in 0..u64::from(seeds.max(2)) {
        let config = SolveConfig {
            seed: config.seed.wrapping_add(seed),
            ..config.clone()
        };
        by_seed.push(run(&config)?);
    }
    let (error, _) = by_seed[0];
    // Of the mean square, as single seeds differ in their errors too.
    let squares: Vec<f64> = by_seed
        .iter()
        .map(|(e, _)| e.relative_rms.powi(2))
        .collect();
    let square = squares.iter().sum::<f64>() / squares.len() as f64;
    let lights: Vec<&SolvedLights> = by_seed.iter().map(|(_, lights)| lights).collect();
    let part = |of: f64, whole: f64| if whole > 0.0 { of / whole } else { 0.0 };
    let chance = part(variance(truth, &lights), square);
    let mut lines = Vec::new();
    for approximation in Approximation::EACH {
        let (without, _) = run(&approximation.made_exact(config))?;
        let gone = error.relative_rms.powi(2) - without.relative_rms.powi(2);
        lines.push(BudgetLine {
            approximation,
            error: without,
            removed: part(gone, error.relative_rms.powi(2)),
        });
    }
    Ok(ErrorBudget {
        error,
        reference_noise: noise,
        chance,
        seeds: by_seed.len() as u32,
        lines,
    })
}

/// Mean over the faces of the variance of their radiosity between solutions, weighted by area, over the squared
/// mean radiosity: in the metric of the squared relative RMS error.
fn variance(truth: &[TrueFace], solutions: &[&SolvedLights]) -> f64 {
    let count = solutions.len() as f64;
    let (mut area, mut light, mut sum) = (0.0, 0.0, 0.0);
    for face in truth {
        let values: Vec<f64> = solutions
            .iter()
            .map(|lights| match lights.get(&(face.face, face.side)) {
                Some(light) => light.power / light.area.max(face.area),
                None => 0.0,
            })
            .collect();
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
        sum += face.area * squares / (count - 1.0);
        area += face.area;
        light += face.area * face.reflected;
    }
    sum / area / (light / area).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::SolvedLight;
    use crate::scene::Side;

    #[test]
    fn every_approximation_changes_one_thing_and_all_change_all() {
        let config = SolveConfig::default();
        let changed: Vec<SolveConfig> = Approximation::EACH.map(|a| a.made_exact(&config)).to_vec();
        for (i, one) in changed.iter().enumerate() {
            assert!(one.validate().is_ok());
            assert_ne!(*one, config);
            assert!(changed[..i].iter().all(|other| other != one));
        }
        let all = &changed[6];
        // Products of decimals are right to a rounding.
        let near = |x: f64, y: f64| (x / y - 1.0).abs() < 1.0e-12;
        assert!(near(all.epsilon, 0.1 * config.epsilon));
        assert_eq!((all.rays, all.min_area), (16 * config.rays, 0.0));
        assert_eq!(all.technique, config.technique);
        assert!(matches!(all.stop, Stop::Converged(x) if near(x, 1.0e-5)));
    }

    #[test]
    fn the_variance_of_two_solutions_by_hand() {
        let truth = [1.0, 3.0].map(|area| TrueFace {
            face: area as u32,
            side: Side::Front,
            area,
            reflected: 2.0,
            standard_error: 0.0,
            emitted: 0.0,
        });
        let solution = |first: f64| -> SolvedLights {
            let light = |area: f64, radiosity: f64| SolvedLight {
                area,
                power: area * radiosity,
            };
            [
                ((1, Side::Front), light(1.0, first)),
                ((3, Side::Front), light(3.0, 5.0)),
            ]
            .into()
        };
        // Values 1 and 3 have the variance 2; a quarter of the area, over the square of 2.
        let found = variance(&truth, &[&solution(1.0), &solution(3.0)]);
        assert!((found - 2.0 * 0.25 / 4.0).abs() < 1.0e-15, "{found}");
    }
}
