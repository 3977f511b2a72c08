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
    /// Which axes bounding boxes run along.
    pub axes: Axes,
}

/// The axes that bounding boxes run along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Axes {
    /// The scene's own, those of its walls: what the file turns is turned back.
    #[default]
    Scene,
    /// The file's.
    File,
}
