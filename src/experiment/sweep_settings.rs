//! Which settings a sweep tries: lists of values, and the points that they span.

use crate::occluder::OccluderConfig;
use crate::solve::{SolveConfig, Stop, Stride, Technique};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

/// One point of a sweep: what may differ from one solve to another.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepSettings {
    /// How visibility is decided.
    pub technique: Technique,
    /// [`SolveConfig::epsilon`].
    pub epsilon: f64,
    /// [`SolveConfig::rays`].
    pub rays: u32,
    /// [`SolveConfig::stride`].
    #[serde(serialize_with = "stride_as_typed", deserialize_with = "typed_stride")]
    pub stride: Stride,
    /// [`OccluderConfig::per_cluster`].
    pub occluders: usize,
    /// [`OccluderConfig::min_area`].
    pub occluder_size: f64,
    /// [`OccluderConfig::flatness_degrees`].
    pub flatness: f64,
    /// [`SolveConfig::gradient`].
    pub gradient: f64,
    /// [`SolveConfig::min_area`].
    pub min_area: f64,
    /// The unshot fraction at which the solve stops ([`Stop::Converged`]).
    pub converge: f64,
}

/// The words of the command line: a number or `auto`.
pub fn stride_name(stride: Stride) -> String {
    match stride {
        Stride::Auto => "auto".to_owned(),
        Stride::Every(levels) => levels.to_string(),
    }
}

fn stride_as_typed<S: Serializer>(stride: &Stride, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&stride_name(*stride))
}

fn typed_stride<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Stride, D::Error> {
    let name = String::deserialize(deserializer)?;
    match (name.as_str(), name.parse()) {
        ("auto", _) => Ok(Stride::Auto),
        (_, Ok(levels)) => Ok(Stride::Every(levels)),
        (_, Err(_)) => Err(D::Error::custom(format!("{name:?} is no stride"))),
    }
}

impl SweepSettings {
    /// The point that these configurations stand for. Those that stop after a number of passes have no
    /// fraction and get the default's.
    pub fn of(solve: &SolveConfig, occluders: &OccluderConfig) -> Self {
        let converge = |stop: Stop| match stop {
            Stop::Converged(x) => Some(x),
            Stop::Passes(_) => None,
        };
        Self {
            technique: solve.technique,
            epsilon: solve.epsilon,
            rays: solve.rays,
            stride: solve.stride,
            occluders: occluders.per_cluster,
            occluder_size: occluders.min_area,
            flatness: occluders.flatness_degrees,
            gradient: solve.gradient,
            min_area: solve.min_area,
            converge: converge(solve.stop)
                .or_else(|| converge(SolveConfig::default().stop))
                .unwrap_or(f64::NAN),
        }
    }

    /// The configuration of a solve at this point; what a point does not say is as in `base`.
    pub fn solve_config(&self, base: &SolveConfig) -> SolveConfig {
        SolveConfig {
            technique: self.technique,
            epsilon: self.epsilon,
            rays: self.rays,
            stride: self.stride,
            gradient: self.gradient,
            min_area: self.min_area,
            stop: Stop::Converged(self.converge),
            ..base.clone()
        }
    }

    /// The configuration of its occluders.
    pub fn occluder_config(&self) -> OccluderConfig {
        OccluderConfig {
            per_cluster: self.occluders,
            min_area: self.occluder_size,
            flatness_degrees: self.flatness,
            ..OccluderConfig::default()
        }
    }

    /// The same with what its technique does not look at taken from `centre`, so that points that would
    /// solve alike are equal.
    fn without_idle_settings(mut self, centre: &Self) -> Self {
        if !self.technique.proves_visibility() {
            self.stride = centre.stride;
        }
        if !self.technique.proves_occlusion() {
            self.occluders = centre.occluders;
            self.occluder_size = centre.occluder_size;
            self.flatness = centre.flatness;
        }
        self
    }
}

/// Values to try of each setting; an empty list stands for the centre's value.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SweepLists {
    /// Techniques.
    pub techniques: Vec<Technique>,
    /// Epsilons.
    pub epsilons: Vec<f64>,
    /// Rays an exchange.
    pub rays: Vec<u32>,
    /// Strides.
    pub strides: Vec<Stride>,
    /// Occluders of a flat cluster.
    pub occluders: Vec<usize>,
    /// Sizes of the smallest occluder.
    pub occluder_sizes: Vec<f64>,
    /// Flatness in degrees.
    pub flatness: Vec<f64>,
    /// Gradients.
    pub gradients: Vec<f64>,
    /// Smallest patches.
    pub min_areas: Vec<f64>,
    /// Unshot fractions.
    pub converge: Vec<f64>,
}

/// More points than anybody waits for: a slip of the pen in a list.
pub const MAX_POINTS: usize = 10_000;

/// The lists span too many points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the lists span more than {MAX_POINTS} points; shorten them, or do without --cross")]
pub struct TooManyPoints;

/// Puts one value of a list into a point.
type Edit = Box<dyn Fn(&mut SweepSettings)>;

fn edits<T: Copy + 'static>(values: &[T], set: fn(&mut SweepSettings, T)) -> Vec<Edit> {
    values
        .iter()
        .map(|&value| -> Edit { Box::new(move |point| set(point, value)) })
        .collect()
}

/// Every point with every value; the points themselves where there is none.
fn spread(points: &[SweepSettings], values: &[Edit]) -> Result<Vec<SweepSettings>, TooManyPoints> {
    if values.is_empty() {
        return Ok(points.to_vec());
    }
    if points.len() * values.len() > MAX_POINTS {
        return Err(TooManyPoints);
    }
    let pairs = points
        .iter()
        .flat_map(|point| values.iter().map(move |edit| (*point, edit)));
    Ok(pairs
        .map(|(mut point, edit)| {
            edit(&mut point);
            point
        })
        .collect())
}

impl SweepLists {
    /// The points, each once: `centre` first, then technique x epsilon x rays, then the values of the other
    /// lists one at a time from the centre; with `cross`, all lists in every combination.
    ///
    /// # Errors
    /// More than [`MAX_POINTS`].
    pub fn points(
        &self,
        centre: &SweepSettings,
        cross: bool,
    ) -> Result<Vec<SweepSettings>, TooManyPoints> {
        let core = [
            edits(&self.techniques, |p, v| p.technique = v),
            edits(&self.epsilons, |p, v| p.epsilon = v),
            edits(&self.rays, |p, v| p.rays = v),
        ];
        let others = [
            edits(&self.strides, |p, v| p.stride = v),
            edits(&self.occluders, |p, v| p.occluders = v),
            edits(&self.occluder_sizes, |p, v| p.occluder_size = v),
            edits(&self.flatness, |p, v| p.flatness = v),
            edits(&self.gradients, |p, v| p.gradient = v),
            edits(&self.min_areas, |p, v| p.min_area = v),
            edits(&self.converge, |p, v| p.converge = v),
        ];
        let mut points = vec![*centre];
        for list in &core {
            points = spread(&points, list)?;
        }
        for list in &others {
            match cross {
                true => points = spread(&points, list)?,
                false => points.extend(spread(&[*centre], list)?),
            }
        }
        let mut distinct = vec![*centre];
        for point in points {
            let point = point.without_idle_settings(centre);
            if !distinct.contains(&point) {
                distinct.push(point);
            }
        }
        match distinct.len() {
            0..=MAX_POINTS => Ok(distinct),
            _ => Err(TooManyPoints),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn centre() -> SweepSettings {
        SweepSettings::of(&SolveConfig::default(), &OccluderConfig::default())
    }

    fn lists() -> SweepLists {
        SweepLists {
            techniques: vec![Technique::Normal, Technique::Occlusion],
            epsilons: vec![1.0e-4, 1.0e-5, 1.0e-6],
            rays: vec![4, 8],
            strides: vec![Stride::Auto, Stride::Every(4)],
            occluders: vec![2, 8],
            ..SweepLists::default()
        }
    }

    #[test]
    fn settings_go_to_a_solve_and_back() {
        let mut point = centre();
        (point.epsilon, point.rays, point.stride) = (3.0e-5, 24, Stride::Every(2));
        (point.occluders, point.flatness, point.converge) = (3, 0.5, 1.0e-4);
        let base = SolveConfig::default();
        let back = SweepSettings::of(&point.solve_config(&base), &point.occluder_config());
        assert_eq!(back, point);
        assert_eq!(centre().solve_config(&base), base);
    }

    #[test]
    fn the_core_is_a_product_and_the_rest_one_at_a_time() {
        let points = lists().points(&centre(), false).unwrap();
        assert_eq!(points[0], centre());
        // 2 x 3 x 2, the centre among them, one other stride and one other number of occluders.
        assert_eq!(points.len(), 12 + 1 + 1);
        assert!(points.iter().filter(|p| p.stride != Stride::Auto).count() == 1);
    }

    #[test]
    fn a_cross_leaves_out_what_a_technique_does_not_look_at() {
        let points = lists().points(&centre(), true).unwrap();
        // `occlusion` in all 2 x 2 variants of stride and occluders, `normal` in one.
        assert_eq!(points.len(), 6 * 4 + 6);
        for (i, point) in points.iter().enumerate() {
            assert!(!points[..i].contains(point), "{point:?} stands twice");
        }
    }

    #[test]
    fn no_lists_are_the_centre_and_long_ones_are_refused() {
        let none = SweepLists::default();
        assert_eq!(none.points(&centre(), true).unwrap(), [centre()]);
        let many = SweepLists {
            epsilons: (1..=200).map(f64::from).collect(),
            rays: (1..=200).collect(),
            ..SweepLists::default()
        };
        assert_eq!(many.points(&centre(), false), Err(TooManyPoints));
    }
}
