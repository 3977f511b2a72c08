//! What the loader may do about input that is not quite as it should be.

/// What `Kd` is lowered to by [`LoadConfig::clamp_reflectance`]: light then falls to a thousandth
/// in 6900 reflections instead of never.
pub const CLAMPED_REFLECTANCE: f64 = 0.999;

/// Choices of the loader.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct LoadConfig {
    /// Lower a `Kd` of 1 or more to [`CLAMPED_REFLECTANCE`] with a warning instead of refusing it.
    pub clamp_reflectance: bool,
}
