//! A rendered picture with its layers, in linear light.

use super::ToneMap;

/// What one pixel holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pixel {
    /// Radiance towards the eye in W/m2/sr, weighted by `alpha`.
    pub radiance: [f32; 3],
    /// Irradiance of what is seen in W/m2, weighted by `alpha`.
    pub irradiance: [f32; 3],
    /// Share of the pixel that the scene covers, in [0, 1].
    pub alpha: f32,
    /// Unit normal, turned to the eye, at the pixel's middle; zero on the background.
    pub normal: [f32; 3],
    /// Distance along the view at the pixel's middle, in the file's units; [`Pixel::NO_DEPTH`] on
    /// the background.
    pub depth: f32,
    /// The `f` statement seen at the pixel's middle; -1 on the background. Exact up to 2^24.
    pub face: f32,
}

impl Pixel {
    /// Depth where nothing is seen: finite, as Blender writes it, so that filters stay finite.
    pub const NO_DEPTH: f32 = 1.0e10;

    /// Nothing.
    pub const BACKGROUND: Self = Self {
        radiance: [0.0; 3],
        irradiance: [0.0; 3],
        alpha: 0.0,
        normal: [0.0; 3],
        depth: Self::NO_DEPTH,
        face: -1.0,
    };
}

/// A picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Rows from the top, each from the left.
    pub pixels: Vec<Pixel>,
}

impl Picture {
    /// The exposure that suits the picture.
    pub fn exposure(&self) -> ToneMap {
        ToneMap::automatic(
            self.pixels
                .iter()
                .filter(|p| p.alpha > 0.0)
                .map(|p| (p.radiance, 1.0)),
        )
    }
}
