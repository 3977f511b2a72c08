//! Regression suites: counts that have to be the same, times that have to be alike.
//!
//! A solve is deterministic, so any count that differs from the baseline's is a change of behaviour.
//! Times are compared as ratios to `normal` in the same run, since machines differ and are noisy; the
//! tolerance of a ratio is what its repeats spread.

use super::baseline_key::BaselineKey;
use super::comparison::{ComparisonRow, Times};
use super::instruction_counts::{InstructionCounts, dearer};
use crate::solve::{PassStatistics, Technique};
use serde::{Deserialize, Serialize};

/// One scene of a suite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SuiteCase {
    /// Name of the built-in scene.
    pub scene: &'static str,
    /// The BFA threshold.
    pub epsilon: f64,
    /// Rays an exchange.
    pub rays: u32,
    /// Passes.
    pub passes: u32,
    /// Repeats.
    pub repeat: u32,
}

const fn case(scene: &'static str, epsilon: f64, rays: u32, passes: u32, repeat: u32) -> SuiteCase {
    SuiteCase {
        scene,
        epsilon,
        rays,
        passes,
        repeat,
    }
}

/// Under a minute on one core: rooms, furniture, curved clusters, many rooms.
const CI: [SuiteCase; 4] = [
    case("cornell", 1.0e-5, 8, 2, 5),
    case("cornell-spheres", 1.0e-4, 8, 2, 5),
    case("d", 2.2e-5, 8, 2, 3),
    case("f", 1.0e-5, 8, 2, 3),
];

/// The built-in analogues of the paper's scenes at its settings.
const PAPER: [SuiteCase; 6] = [
    case("a", 1.35e-6, 8, 1, 7),
    case("b", 1.6e-6, 8, 1, 7),
    case("c", 2.95e-5, 10, 3, 7),
    case("d", 2.2e-5, 20, 3, 7),
    case("e", 6.2e-6, 8, 3, 7),
    case("f", 5.0e-7, 8, 3, 7),
];

/// A second on one core: enough to see whether a check itself works.
const SMOKE: [SuiteCase; 1] = [case("d", 1.0e-3, 8, 2, 1)];

/// The cases of a suite: `smoke`, `ci` or `paper`.
pub fn suite(name: &str) -> Option<&'static [SuiteCase]> {
    match name {
        "smoke" => Some(&SMOKE),
        "ci" => Some(&CI),
        "paper" => Some(&PAPER),
        _ => None,
    }
}

/// The counts of one technique in one pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct BaselineCounts {
    /// As in [`PassStatistics`].
    pub exchanges: u64,
    /// As in [`PassStatistics`].
    pub exchanges_blocked: u64,
    /// As in [`PassStatistics`].
    pub exchanges_visible: u64,
    /// As in [`PassStatistics`].
    pub rays: u64,
    /// As in [`PassStatistics`].
    pub rays_blocked: u64,
    /// As in [`PassStatistics`].
    pub native_rays: u64,
    /// As in [`PassStatistics`].
    pub shafts: u64,
    /// As in [`PassStatistics`].
    pub occluded_claims: u64,
    /// As in [`PassStatistics`].
    pub visible_claims: u64,
}

impl From<&PassStatistics> for BaselineCounts {
    fn from(s: &PassStatistics) -> Self {
        Self {
            exchanges: s.exchanges,
            exchanges_blocked: s.exchanges_blocked,
            exchanges_visible: s.exchanges_visible,
            rays: s.rays,
            rays_blocked: s.rays_blocked,
            native_rays: s.native_rays,
            shafts: s.shafts,
            occluded_claims: s.occluded_claims,
            visible_claims: s.visible_claims,
        }
    }
}

impl BaselineCounts {
    fn named(&self) -> [(&'static str, u64); 9] {
        [
            ("exchanges", self.exchanges),
            ("exchanges_blocked", self.exchanges_blocked),
            ("exchanges_visible", self.exchanges_visible),
            ("rays", self.rays),
            ("rays_blocked", self.rays_blocked),
            ("native_rays", self.native_rays),
            ("shafts", self.shafts),
            ("occluded_claims", self.occluded_claims),
            ("visible_claims", self.visible_claims),
        ]
    }
}

/// One technique in one pass of one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BaselineRow {
    /// The scene.
    pub scene: String,
    /// The pass.
    pub pass: u32,
    /// The technique's name.
    pub technique: String,
    /// Its counts.
    pub counts: BaselineCounts,
    /// Median time over the median time of `normal`.
    pub ratio: f64,
    /// Half of the interquartile range of the ratio's repeats, over the ratio.
    pub spread: f64,
    /// Median time in seconds: for the record, never compared.
    pub seconds: f64,
}

/// A recorded run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Baseline {
    /// Version of this layout: [`Baseline::FORMAT`].
    pub format: u32,
    /// The suite.
    pub suite: String,
    /// On what the counts depend.
    pub key: BaselineKey,
    /// Occluders of each scene, in the suite's order.
    pub occluders: Vec<usize>,
    /// The rows.
    pub rows: Vec<BaselineRow>,
    /// Instructions, where they were counted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub instructions: Option<InstructionCounts>,
}

impl BaselineRow {
    /// The row of a comparison, with `normal`'s times of the same pass.
    pub fn new(row: &ComparisonRow, normal: &Times) -> Self {
        let ratios: Vec<f64> = (row.seconds.all.iter().zip(&normal.all))
            .map(|(own, base)| own / base.max(f64::MIN_POSITIVE))
            .collect();
        let ratios = Times::new(ratios);
        let ratio = ratios.median.max(f64::MIN_POSITIVE);
        Self {
            scene: row.scene.clone(),
            pass: row.pass,
            technique: row.technique.name().to_owned(),
            counts: BaselineCounts::from(&row.counts),
            ratio,
            spread: 0.5 * (ratios.upper_quartile - ratios.lower_quartile) / ratio,
            seconds: row.seconds.median,
        }
    }

    /// The rows of one scene's comparison.
    pub fn of_comparison(rows: &[ComparisonRow]) -> Vec<Self> {
        rows.iter()
            .filter_map(|row| {
                let normal = rows
                    .iter()
                    .find(|n| n.technique == Technique::Normal && n.pass == row.pass)?;
                Some(Self::new(row, &normal.seconds))
            })
            .collect()
    }

    fn is_same_as(&self, other: &Self) -> bool {
        (&self.scene, self.pass, &self.technique) == (&other.scene, other.pass, &other.technique)
    }

    fn label(&self) -> String {
        format!("{} pass {} {}", self.scene, self.pass, self.technique)
    }
}

/// Share by which counts may differ under a foreign key: other instruction sets round other rays.
const FOREIGN_SHARE: f64 = 1.0e-3;
/// Spreads by which a ratio may exceed the baseline's.
const SPREADS: f64 = 4.0;
/// Least tolerance of a ratio: below it two runs of the same program on a shared machine differ.
const LEAST_TOLERANCE: f64 = 0.4;

/// Seconds below which a pass that takes longer is the clock's noise.
const LEAST_SECONDS: f64 = 0.03;

impl Baseline {
    /// Version of the layout.
    pub const FORMAT: u32 = 1;

    /// Takes over the ratios of another run of the same suite where they are smaller: what disturbs a run makes it
    /// slower, and rarely the same rows twice.
    pub fn keep_faster(&mut self, other: &Self) {
        for row in &mut self.rows {
            if let Some(again) = other.rows.iter().find(|again| again.is_same_as(row)) {
                row.ratio = row.ratio.min(again.ratio);
            }
        }
    }

    /// True if nothing but times differs from `now`.
    pub fn differs_in_times_only(&self, now: &Self) -> bool {
        let mut fast = now.clone();
        fast.rows.iter_mut().for_each(|row| row.ratio = 0.0);
        regressions(self, &fast).is_empty() && !regressions(self, now).is_empty()
    }
}

/// What differs from the baseline; nothing if all is well.
pub fn regressions(baseline: &Baseline, now: &Baseline) -> Vec<String> {
    let mut found = Vec::new();
    if baseline.format != now.format || baseline.suite != now.suite {
        found.push(format!(
            "the baseline is of suite {:?}, format {}; this run of suite {:?}, format {}",
            baseline.suite, baseline.format, now.suite, now.format
        ));
        return found;
    }
    let share = match baseline.key == now.key {
        true => 0.0,
        false => FOREIGN_SHARE,
    };
    if baseline.occluders != now.occluders {
        found.push(format!(
            "occluders: {:?} in the baseline, {:?} now",
            baseline.occluders, now.occluders
        ));
    }
    for old in &baseline.rows {
        let Some(new) = now.rows.iter().find(|new| new.is_same_as(old)) else {
            found.push(format!("{}: in the baseline, but not run", old.label()));
            continue;
        };
        for ((name, was), (_, is)) in old.counts.named().into_iter().zip(new.counts.named()) {
            // One ray more or less may decide a query: small counts move by what large ones may.
            let least = was.max(old.counts.exchanges) as f64;
            if was.abs_diff(is) as f64 > share * least {
                found.push(format!("{}: {name} was {was}, is {is}", old.label()));
            }
        }
        let tolerance = LEAST_TOLERANCE.max(SPREADS * old.spread.max(new.spread));
        let longer = (1.0 - old.ratio / new.ratio) * new.seconds;
        if new.ratio > old.ratio * (1.0 + tolerance) && longer > LEAST_SECONDS {
            found.push(format!(
                "{}: takes {:.3} of the time of normal, was {:.3}; tolerance {:.0} %",
                old.label(),
                new.ratio,
                old.ratio,
                100.0 * tolerance
            ));
        }
    }
    if let (Some(old), Some(new)) = (&baseline.instructions, &now.instructions) {
        found.extend(dearer((&baseline.key, old), (&now.key, new)).unwrap_or_default());
    }
    for new in &now.rows {
        if !baseline.rows.iter().any(|old| old.is_same_as(new)) {
            found.push(format!("{}: run, but not in the baseline", new.label()));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn baseline() -> Baseline {
        let row = |technique: &str, ratio: f64| BaselineRow {
            scene: "builtin:x".to_owned(),
            pass: 1,
            technique: technique.to_owned(),
            counts: BaselineCounts {
                exchanges: 10_000,
                rays: 80_000,
                ..BaselineCounts::default()
            },
            ratio,
            spread: 0.02,
            seconds: 1.0,
        };
        Baseline {
            format: 1,
            suite: "ci".to_owned(),
            key: BaselineKey::here("4.3.3".to_owned(), "avx2"),
            occluders: vec![3],
            rows: vec![row("normal", 1.0), row("occlusion", 0.5)],
            instructions: None,
        }
    }

    #[test]
    fn a_disturbed_run_is_told_from_a_slow_one_by_another_run() {
        let mut now = baseline();
        assert!(!baseline().differs_in_times_only(&now));
        now.rows[1].ratio = 2.0;
        assert!(baseline().differs_in_times_only(&now));
        let slow = now.clone();
        now.keep_faster(&slow);
        assert!(baseline().differs_in_times_only(&now), "slow both times");
        now.keep_faster(&baseline());
        assert!(regressions(&baseline(), &now).is_empty());
        now = slow;
        now.rows[1].counts.rays += 1;
        assert!(!baseline().differs_in_times_only(&now));
    }

    #[test]
    fn the_same_run_is_no_regression() {
        assert!(regressions(&baseline(), &baseline()).is_empty());
    }

    #[test]
    fn one_ray_more_is_found_unless_the_key_is_foreign() {
        let mut now = baseline();
        now.rows[1].counts.rays += 1;
        let found = regressions(&baseline(), &now);
        assert_eq!(found.len(), 1);
        assert!(found[0].contains("rays was 80000, is 80001"), "{found:?}");
        now.key.embree = "4.4.0".to_owned();
        assert!(regressions(&baseline(), &now).is_empty());
        now.rows[1].counts.rays += 81;
        assert_eq!(regressions(&baseline(), &now).len(), 1);
        // A thousandth of the exchanges, of which every one may be settled the other way.
        now = baseline();
        now.key.libm = "another".to_owned();
        now.rows[1].counts.shafts += 10;
        assert!(regressions(&baseline(), &now).is_empty());
        now.rows[1].counts.shafts += 1;
        assert_eq!(regressions(&baseline(), &now).len(), 1);
    }

    #[test]
    fn slower_rows_missing_rows_and_other_occluders_are_found() {
        let mut now = baseline();
        now.rows[1].ratio = 0.5 * 1.5;
        assert!(regressions(&baseline(), &now)[0].contains("was 0.500"));
        now.rows[1].ratio = 0.5 * 1.3;
        assert!(regressions(&baseline(), &now).is_empty());
        // Hundredths of a second say nothing.
        now.rows[1].ratio = 0.5 * 1.5;
        now.rows[1].seconds = 0.05;
        assert!(regressions(&baseline(), &now).is_empty());
        now = baseline();
        now.rows.pop();
        assert!(regressions(&baseline(), &now)[0].contains("not run"));
        assert!(regressions(&now, &baseline())[0].contains("not in the baseline"));
        now = baseline();
        now.occluders[0] = 4;
        assert_eq!(regressions(&baseline(), &now).len(), 1);
    }
}
