//! What a measurement is asked to do, with its defaults.

/// Settings of a measurement.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct ReferenceConfig {
    /// Standard error asked of every face and channel, relative to the greater of its reflected radiosity
    /// and [`Self::DARK`] of the area mean. Positive.
    pub error: f64,
    /// Wall time in seconds after which no further round begins. Positive; `None` for no limit. The first
    /// round is always run, so that every face has an answer.
    pub max_seconds: Option<f64>,
    /// Measure a sample of this many source faces; `None` for all.
    pub faces: Option<u32>,
    /// Seed of every path and of the sample of faces.
    pub seed: u64,
}

impl ReferenceConfig {
    /// Radiosity below this share of the area mean is asked for no more than the error of a face at that
    /// share: in the contract of `certilux reference`.
    pub const DARK: f64 = 0.01;

    /// Checks every range; the message names the command-line flag.
    pub fn validate(&self) -> Result<(), ReferenceConfigError> {
        let positive = |flag, x: f64| {
            if x > 0.0 && x.is_finite() {
                Ok(())
            } else {
                Err(ReferenceConfigError {
                    flag,
                    reason: "must be a positive finite number",
                })
            }
        };
        positive("--error", self.error)?;
        if let Some(seconds) = self.max_seconds {
            positive("--max-seconds", seconds)?;
        }
        if self.faces == Some(0) {
            return Err(ReferenceConfigError {
                flag: "--faces",
                reason: "must be at least 1",
            });
        }
        Ok(())
    }
}

impl Default for ReferenceConfig {
    fn default() -> Self {
        Self {
            error: 0.005,
            max_seconds: None,
            faces: None,
            seed: 1,
        }
    }
}

/// A setting outside its range.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{flag} {reason}")]
pub struct ReferenceConfigError {
    /// The command-line flag.
    pub flag: &'static str,
    /// What is wrong with it.
    pub reason: &'static str,
}
