//! What a solve is asked to do, with its defaults.

use serde::{Deserialize, Serialize};

/// How visibility between the two ends of an exchange is decided (paper, section 6.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Technique {
    /// Rays only.
    Normal,
    /// And full visibility, proved by empty shafts.
    Visibility,
    /// And full occlusion, proved by one large occluder.
    Occlusion,
    /// And what is left in the shaft, where it is little, tested natively (design, section 7).
    Blockers,
    /// Everything sees everything: measures what visibility costs, and shoots light through walls.
    Unoccluded,
}

impl Technique {
    /// The name used on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Visibility => "visibility",
            Self::Occlusion => "occlusion",
            Self::Blockers => "blockers",
            Self::Unoccluded => "unoccluded",
        }
    }

    /// True where full visibility is asked.
    pub fn proves_visibility(self) -> bool {
        matches!(self, Self::Visibility | Self::Occlusion | Self::Blockers)
    }

    /// True where full occlusion is asked.
    pub fn proves_occlusion(self) -> bool {
        matches!(self, Self::Occlusion | Self::Blockers)
    }
}

/// At which levels of the walk the guarantees are asked, besides at each exchange.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stride {
    /// At every so many levels; at least 1. The paper asks at every fourth.
    Every(u32),
    /// Where it is likely to pay.
    Auto,
}

/// When to stop shooting.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// After this many passes.
    Passes(u32),
    /// When unshot power falls below this fraction of the emitted power, or at [`SolveConfig::MAX_PASSES`].
    Converged(f64),
}

/// Settings of a solve. Everything is dimensionless, so it means the same in every scene.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct SolveConfig {
    /// How visibility is decided.
    pub technique: Technique,
    /// An exchange is refined until the power that it carries (greatest channel, unoccluded) is
    /// below this fraction of the scene's emitted power (the BFA threshold). Positive.
    pub epsilon: f64,
    /// Irradiance that one exchange may leave unresolved on a receiver, over the mean irradiance
    /// (emitted power / area). Positive.
    pub gradient: f64,
    /// Visibility samples of an exchange, at least 1; whole packets of 8 are cheapest.
    pub rays: u32,
    /// When to stop.
    pub stop: Stop,
    /// A patch whose area is below this fraction of the scene's (one side of each polygon) is not split.
    pub min_area: f64,
    /// Seed of the sample points.
    pub seed: u64,
    /// Whether a closed scene's passes are scaled so that what arrives is what was shot.
    pub normalise: Normalise,
    /// When the guarantees are asked.
    pub stride: Stride,
    /// How many claims to keep for an audit: a uniform sample, or all with `usize::MAX`.
    pub keep_claims: usize,
    /// How many exchanges whose rays were all blocked to keep: a uniform sample of each pass's.
    pub keep_blocked: usize,
    /// Cast the rays of claimed exchanges all the same, and judge every one that disagrees.
    pub check_claims: bool,
}

/// Row normalisation: in a closed scene the form factors of a row sum to one, and an error eta of
/// a row becomes eta rho / (1 - rho) in radiosity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Normalise {
    /// On in closed scenes with a reflectance of at least [`SolveConfig::NORMALISE_FROM`].
    Auto,
    /// On in closed scenes.
    On,
    /// Never.
    Off,
}

impl SolveConfig {
    /// Levels between queries in the paper (section 5.3).
    pub const PAPER_STRIDE: u32 = 4;
    /// Passes after which a solve gives up converging.
    pub const MAX_PASSES: u32 = 200;
    /// Reflectance from which a row error of 0.1 % is worth 2 % in radiosity.
    pub const NORMALISE_FROM: f64 = 0.95;
    /// Most rays an exchange may ask for: beyond this the sample index would leave 32 bits of a
    /// pass's resampling.
    pub const MAX_RAYS: u32 = 1 << 20;

    /// Checks every range; the message names the command-line flag.
    pub fn validate(&self) -> Result<(), ConfigError> {
        let fail = |flag, reason: &str| {
            Err(ConfigError {
                flag,
                reason: reason.to_owned(),
            })
        };
        if !(self.epsilon > 0.0 && self.epsilon.is_finite()) {
            return fail("--epsilon", "must be a positive finite number");
        }
        if !(self.gradient > 0.0 && self.gradient.is_finite()) {
            return fail("--gradient", "must be a positive finite number");
        }
        if self.rays == 0 || self.rays > Self::MAX_RAYS {
            return fail("--rays", "must be between 1 and 1048576");
        }
        if !(self.min_area >= 0.0 && self.min_area.is_finite()) {
            return fail("--min-area", "must be zero or a positive finite number");
        }
        if self.stride == Stride::Every(0) {
            return fail("--stride", "must be at least 1, or auto");
        }
        match self.stop {
            Stop::Passes(0) => fail("--passes", "must be at least 1"),
            Stop::Converged(x) if !(x > 0.0 && x.is_finite()) => {
                fail("--converge", "must be a positive finite number")
            }
            _ => Ok(()),
        }
    }
}

impl Default for SolveConfig {
    fn default() -> Self {
        Self {
            technique: Technique::Occlusion,
            epsilon: 1.0e-5,
            gradient: 5.0e-3,
            rays: 8,
            stop: Stop::Converged(1.0e-3),
            min_area: 1.0e-6,
            seed: 1,
            normalise: Normalise::Auto,
            stride: Stride::Auto,
            keep_claims: 0,
            keep_blocked: 0,
            check_claims: false,
        }
    }
}

/// A setting outside its range.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{flag} {reason}")]
pub struct ConfigError {
    /// The command-line flag.
    pub flag: &'static str,
    /// What is wrong with it.
    pub reason: String,
}
