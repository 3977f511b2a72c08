//! A picture as it is shown: linear light of a display, upon which marks are laid.

use super::png_file::write_rgba_png;
use super::tonemap::srgb;
use super::{OutputError, Picture, ToneMap};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Pixels in linear display light.
#[derive(Clone, Debug, PartialEq)]
pub struct Canvas {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Rows from the top: red, green, blue and alpha, each in [0, 1], colours not multiplied by alpha.
    pub pixels: Vec<[f32; 4]>,
}

impl Canvas {
    /// A picture through a tone map.
    pub fn tone_mapped(picture: &Picture, tone_map: ToneMap) -> Self {
        Self::from_pixels(picture, |pixel| {
            let alpha = pixel.alpha;
            tone_map.display(pixel.radiance.map(|x| x / alpha))
        })
    }

    /// Each pixel that the scene covers at all, in the colour that `colour` gives it.
    pub fn from_pixels(picture: &Picture, colour: impl Fn(&super::Pixel) -> [f32; 3]) -> Self {
        let pixels = picture.pixels.iter().map(|pixel| {
            if pixel.alpha <= 0.0 {
                return [0.0; 4];
            }
            let [r, g, b] = colour(pixel);
            [r, g, b, pixel.alpha.min(1.0)]
        });
        Self {
            size: picture.size,
            pixels: pixels.collect(),
        }
    }

    /// Lays `colour` over pixel `i`; `opacity` in [0, 1].
    pub fn blend(&mut self, i: usize, colour: [f32; 3], opacity: f32) {
        let pixel = &mut self.pixels[i];
        let below = pixel[3] * (1.0 - opacity);
        let alpha = opacity + below;
        if alpha <= 0.0 {
            return;
        }
        for c in 0..3 {
            pixel[c] = (colour[c] * opacity + pixel[c] * below) / alpha;
        }
        pixel[3] = alpha;
    }

    /// Takes the colours out and leaves their brightness, darkened to `share`: a ground for colours.
    pub fn fade(&mut self, share: f32) {
        for [r, g, b, _] in &mut self.pixels {
            let grey = share * (0.2126 * *r + 0.7152 * *g + 0.0722 * *b);
            [*r, *g, *b] = [grey; 3];
        }
    }

    /// Writes the picture as 8-bit sRGB, whole or not at all.
    ///
    /// # Errors
    /// As [`super::write_png`].
    pub fn write_png(&self, path: &Path, interrupted: &AtomicBool) -> Result<(), OutputError> {
        let byte = |x: f32| (255.0 * f64::from(x).clamp(0.0, 1.0) + 0.5) as u8;
        let bytes: Vec<u8> = (self.pixels.iter())
            .flat_map(|&[r, g, b, alpha]| {
                let [r, g, b] = [r, g, b].map(|x| byte(srgb(f64::from(x).clamp(0.0, 1.0)) as f32));
                [r, g, b, byte(alpha)]
            })
            .collect();
        write_rgba_png(path, self.size, &bytes, interrupted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blending_is_between_the_two_and_makes_nothing_of_nothing() {
        let mut canvas = Canvas {
            size: [2, 1],
            pixels: vec![[0.0, 0.5, 1.0, 1.0], [0.0; 4]],
        };
        canvas.blend(0, [1.0, 0.5, 0.0], 0.25);
        assert_eq!(canvas.pixels[0], [0.25, 0.5, 0.75, 1.0]);
        canvas.blend(1, [1.0, 0.5, 0.0], 0.0);
        assert_eq!(canvas.pixels[1], [0.0; 4]);
        canvas.blend(1, [1.0, 0.5, 0.0], 0.5);
        assert_eq!(canvas.pixels[1], [1.0, 0.5, 0.0, 0.5]);
    }
}
