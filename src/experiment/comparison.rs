//! The paper's Table 1: techniques side by side on the same work (paper, section 6).
//!
//! Every technique's pass k starts from the state that `normal` left after its pass k - 1, so that the
//! rows compare the same work. Techniques are interleaved and repeated, since machines are noisy;
//! counts must not differ between repeats.

use crate::solve::{
    Observer, PassStatistics, PreparedScene, SolveConfig, SolveError, Solver, Technique,
};
use serde::ser::Error as _;
use serde::{Serialize, Serializer};

/// What to compare.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparisonConfig {
    /// The techniques; `normal` is always run, and so is `unoccluded`, the yardstick.
    pub techniques: Vec<Technique>,
    /// Passes.
    pub passes: u32,
    /// Repeats, at least 1.
    pub repeat: u32,
}

/// Times of the repeats, in seconds.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Times {
    /// Median.
    pub median: f64,
    /// Lower quartile.
    pub lower_quartile: f64,
    /// Upper quartile.
    pub upper_quartile: f64,
    /// In the order in which they ran.
    pub all: Vec<f64>,
}

impl Times {
    /// Order statistics of at least one time.
    pub fn new(all: Vec<f64>) -> Self {
        let mut sorted = all.clone();
        sorted.sort_unstable_by(f64::total_cmp);
        let quantile = |share: f64| {
            let at = share * (sorted.len() - 1) as f64;
            let (low, high) = (at.floor() as usize, at.ceil() as usize);
            sorted[low] + (sorted[high] - sorted[low]) * (at - at.floor())
        };
        Self {
            median: quantile(0.5),
            lower_quartile: quantile(0.25),
            upper_quartile: quantile(0.75),
            all,
        }
    }
}

/// One technique in one pass of one scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ComparisonRow {
    /// The scene.
    pub scene: String,
    /// The pass.
    pub pass: u32,
    /// The technique.
    pub technique: Technique,
    /// Time of the pass's exchanges; pushing and pulling are the same for all and left out.
    pub seconds: Times,
    /// Its counts. A trial has no time of its own beside `seconds`, and shoots nothing that could be left unshot.
    #[serde(serialize_with = "counts_alone")]
    pub counts: PassStatistics,
    /// Of all exchanges of `normal`, those whose rays were all blocked, in percent.
    pub max_occlusion_percent: f64,
    /// Of those, the share that disappeared in this technique, in percent.
    pub detected_occlusion_percent: f64,
    /// Exchanges proved visible, over the exchanges of `normal`, in percent.
    pub full_visibility_percent: f64,
    /// Time saved over the time that `unoccluded` saves, in percent; 0 if that saves none.
    pub visibility_cost_removed_percent: f64,
    /// Median time of `normal` over this one's.
    pub speedup: f64,
}

/// The counts without what only a pass of a solve has.
fn counts_alone<S: Serializer>(counts: &PassStatistics, serializer: S) -> Result<S::Ok, S::Error> {
    let mut tree = serde_json::to_value(counts).map_err(S::Error::custom)?;
    if let Some(entries) = tree.as_object_mut() {
        entries.remove("seconds");
        entries.remove("unshot");
    }
    tree.serialize(serializer)
}

/// Compares techniques on a scene that is prepared with guarantees for all of them.
///
/// # Errors
/// A setting out of range, or an interruption by the observer.
pub fn compare(
    prepared: &PreparedScene,
    config: &SolveConfig,
    what: &ComparisonConfig,
    observer: &dyn Observer,
) -> Result<Vec<ComparisonRow>, SolveError> {
    config.validate()?;
    match prepared.scene.channels() {
        1 => compare_channels::<1>(prepared, config, what, observer),
        _ => compare_channels::<3>(prepared, config, what, observer),
    }
}

fn compare_channels<const C: usize>(
    prepared: &PreparedScene,
    config: &SolveConfig,
    what: &ComparisonConfig,
    observer: &dyn Observer,
) -> Result<Vec<ComparisonRow>, SolveError> {
    let with = |technique| SolveConfig {
        technique,
        ..config.clone()
    };
    let mut techniques = vec![Technique::Normal];
    let asked = what.techniques.iter().copied();
    for technique in asked.chain([Technique::Unoccluded]) {
        if !techniques.contains(&technique) {
            techniques.push(technique);
        }
    }
    let normal = with(Technique::Normal);
    let mut solver = Solver::<C>::new(prepared, &normal, observer);
    let mut rows = Vec::new();
    for pass in 1..=what.passes {
        let mut times = vec![Vec::new(); techniques.len()];
        let mut counts = vec![PassStatistics::default(); techniques.len()];
        for repeat in 0..what.repeat.max(1) {
            // Back and forth, so that a drift of the machine's speed weighs on all alike.
            for i in 0..techniques.len() {
                let i = match repeat % 2 {
                    0 => i,
                    _ => techniques.len() - 1 - i,
                };
                let statistics = solver.trial(pass, &with(techniques[i]))?.statistics;
                times[i].push(statistics.seconds);
                let seen = PassStatistics {
                    seconds: 0.0,
                    ..statistics
                };
                assert!(
                    repeat == 0 || counts[i] == seen,
                    "counts are the same in every repeat"
                );
                counts[i] = seen;
            }
        }
        let times: Vec<Times> = times.into_iter().map(Times::new).collect();
        rows.extend(rows_of_pass(prepared, pass, &techniques, times, &counts));
        if pass < what.passes {
            solver.advance(pass)?;
        }
    }
    Ok(rows)
}

fn rows_of_pass(
    prepared: &PreparedScene,
    pass: u32,
    techniques: &[Technique],
    times: Vec<Times>,
    counts: &[PassStatistics],
) -> Vec<ComparisonRow> {
    // `normal` is the first, `unoccluded` always there.
    let normal = counts[0];
    let free = techniques.iter().position(|&t| t == Technique::Unoccluded);
    let slowest = times[0].median;
    let removable = free.map_or(0.0, |i| slowest - times[i].median);
    let rows = techniques.iter().zip(times).zip(counts);
    rows.map(|((&technique, seconds), &counts)| ComparisonRow {
        scene: prepared.scene.name.clone(),
        pass,
        technique,
        max_occlusion_percent: percent(normal.exchanges_blocked as f64, normal.exchanges as f64),
        detected_occlusion_percent: match technique {
            Technique::Unoccluded => 0.0,
            _ => percent(
                normal.exchanges_blocked as f64 - counts.exchanges_blocked as f64,
                normal.exchanges_blocked as f64,
            ),
        },
        full_visibility_percent: percent(counts.exchanges_visible as f64, normal.exchanges as f64),
        visibility_cost_removed_percent: percent(slowest - seconds.median, removable),
        speedup: if seconds.median > 0.0 {
            slowest / seconds.median
        } else {
            1.0
        },
        seconds,
        counts,
    })
    .collect()
}

fn percent(part: f64, whole: f64) -> f64 {
    if whole > 0.0 {
        100.0 * part / whole
    } else {
        0.0
    }
}

/// What a comparison says in a few numbers: geometric means over the rows of one technique.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ComparisonSummary {
    /// The technique.
    pub technique: Technique,
    /// Rows.
    pub rows: usize,
    /// Geometric mean of the speed-ups.
    pub speedup: f64,
    /// Of first passes alone; 0 without any.
    pub speedup_first: f64,
    /// Of later passes alone; 0 without any.
    pub speedup_later: f64,
    /// The least speed-up.
    pub worst: f64,
    /// The greatest.
    pub best: f64,
    /// Geometric mean of the rays of `normal` over this technique's; none where one of the two casts no ray.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fewer_rays: Option<f64>,
}

/// Sums rows up, technique by technique in the order of their first rows; `normal` is left out.
pub fn summarise(rows: &[ComparisonRow]) -> Vec<ComparisonSummary> {
    let mut techniques: Vec<Technique> = Vec::new();
    for row in rows {
        if row.technique != Technique::Normal && !techniques.contains(&row.technique) {
            techniques.push(row.technique);
        }
    }
    techniques
        .into_iter()
        .map(|technique| {
            let of: Vec<&ComparisonRow> =
                rows.iter().filter(|r| r.technique == technique).collect();
            let speedups = |wanted: &dyn Fn(&ComparisonRow) -> bool| -> Vec<f64> {
                let chosen = of.iter().filter(|r| wanted(r));
                chosen.map(|r| r.speedup).collect()
            };
            let all = speedups(&|_| true);
            let fewer: Option<Vec<f64>> = of
                .iter()
                .filter_map(|r| {
                    let normal = rows.iter().find(|n| {
                        n.technique == Technique::Normal && n.scene == r.scene && n.pass == r.pass
                    })?;
                    Some(times_fewer(normal.counts.rays, r.counts.rays))
                })
                .collect();
            ComparisonSummary {
                technique,
                rows: of.len(),
                speedup: geometric_mean(&all),
                speedup_first: geometric_mean(&speedups(&|r| r.pass == 1)),
                speedup_later: geometric_mean(&speedups(&|r| r.pass > 1)),
                worst: all.iter().copied().fold(f64::INFINITY, f64::min),
                best: all.iter().copied().fold(0.0, f64::max),
                fewer_rays: fewer.map(|ratios| geometric_mean(&ratios)),
            }
        })
        .collect()
}

/// How many times fewer rays are cast than by `normal`; none where the ratio has no logarithm.
fn times_fewer(normal: u64, own: u64) -> Option<f64> {
    match (normal, own) {
        (0, 0) => Some(1.0),
        (0, _) | (_, 0) => None,
        _ => Some(normal as f64 / own as f64),
    }
}

/// Geometric mean of positive numbers; 0 of none.
fn geometric_mean(values: &[f64]) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let logs: f64 = values.iter().map(|v| v.ln()).sum();
    (logs / values.len() as f64).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_lie_between_the_times() {
        let times = Times::new(vec![4.0, 1.0, 3.0, 2.0, 5.0]);
        assert_eq!(times.median, 3.0);
        assert_eq!((times.lower_quartile, times.upper_quartile), (2.0, 4.0));
        assert_eq!(Times::new(vec![1.0, 2.0]).median, 1.5);
    }

    #[test]
    fn no_rays_are_no_number_of_times_fewer() {
        assert_eq!(times_fewer(30, 10), Some(3.0));
        assert_eq!(times_fewer(0, 0), Some(1.0));
        assert_eq!((times_fewer(30, 0), times_fewer(0, 30)), (None, None));
    }

    #[test]
    fn geometric_means_weigh_ratios() {
        assert!((geometric_mean(&[0.5, 2.0]) - 1.0).abs() < 1.0e-12);
        assert!((geometric_mean(&[8.0, 1.0, 1.0]) - 2.0).abs() < 1.0e-12);
    }
}
