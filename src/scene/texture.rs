//! An image and its pyramid of ever coarser levels.
//!
//! Light is linear and images are not: texels are decoded from sRGB (IEC 61966-2-1) before they
//! are averaged.

use image::{ImageFormat, ImageReader};
use std::io::Cursor;

/// One level of the pyramid: texel (i, j) covers `step` x `step` texels of the image, fewer at the
/// right and lower borders.
pub(super) struct Level {
    pub width: usize,
    pub height: usize,
    pub step: usize,
    pub texels: Vec<[f32; 3]>,
}

/// A decoded image.
pub(super) struct Texture {
    pub width: usize,
    pub height: usize,
    /// From the finest to a single texel.
    pub levels: Vec<Level>,
}

impl Texture {
    /// Decodes PNG, JPEG, TGA or BMP.
    ///
    /// # Errors
    /// The decoder's message.
    pub fn decode(bytes: &[u8], name: &str) -> Result<Self, String> {
        let mut reader = ImageReader::new(Cursor::new(bytes));
        match image::guess_format(bytes) {
            Ok(format) => reader.set_format(format),
            // TGA has no signature.
            Err(_) if name.to_ascii_lowercase().ends_with(".tga") => {
                reader.set_format(ImageFormat::Tga);
            }
            Err(e) => return Err(e.to_string()),
        }
        let image = reader.decode().map_err(|e| e.to_string())?.into_rgb32f();
        let (width, height) = (image.width() as usize, image.height() as usize);
        if width == 0 || height == 0 {
            return Err("the image has no pixels".into());
        }
        let texels = image.pixels().map(|p| p.0.map(linear)).collect();
        Ok(Self::from_linear(width, height, texels))
    }

    /// A texture of linear colours, rows from the top.
    pub fn from_linear(width: usize, height: usize, texels: Vec<[f32; 3]>) -> Self {
        let mut levels = vec![Level {
            width,
            height,
            step: 1,
            texels,
        }];
        while let Some(finest) = levels.last()
            && (finest.width > 1 || finest.height > 1)
        {
            let coarser = coarsen(finest, width, height);
            levels.push(coarser);
        }
        Self {
            width,
            height,
            levels,
        }
    }

    /// Mean over the whole image.
    pub fn mean(&self) -> [f64; 3] {
        self.levels
            .last()
            .map_or([0.0; 3], |top| top.texels[0].map(f64::from))
    }
}

/// The next level: each texel the mean of up to four, weighted by the part of the image they cover.
fn coarsen(finer: &Level, image_width: usize, image_height: usize) -> Level {
    let (width, height) = (finer.width.div_ceil(2), finer.height.div_ceil(2));
    let covered = |i: usize, size: usize| ((i + 1) * finer.step).min(size) - i * finer.step;
    let mut texels = Vec::with_capacity(width * height);
    for j in 0..height {
        for i in 0..width {
            let mut sum = [0.0; 3];
            let mut weight = 0.0;
            for y in 2 * j..(2 * j + 2).min(finer.height) {
                for x in 2 * i..(2 * i + 2).min(finer.width) {
                    let part = (covered(x, image_width) * covered(y, image_height)) as f64;
                    weight += part;
                    for (s, t) in sum.iter_mut().zip(finer.texels[y * finer.width + x]) {
                        *s += part * f64::from(t);
                    }
                }
            }
            texels.push(sum.map(|s| (s / weight) as f32));
        }
    }
    Level {
        width,
        height,
        step: finer.step * 2,
        texels,
    }
}

/// The linear value of an sRGB-encoded one.
fn linear(encoded: f32) -> f32 {
    let encoded = f64::from(encoded);
    let value = if encoded <= 0.040_45 {
        encoded / 12.92
    } else {
        ((encoded + 0.055) / 1.055).powf(2.4)
    };
    value as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn images_are_decoded_to_linear_light() {
        let mut png = Vec::new();
        image::RgbImage::from_fn(2, 2, |x, y| {
            image::Rgb(if y == 0 {
                [188, 0, 255]
            } else {
                [0, 0, x as u8]
            })
        })
        .write_to(&mut Cursor::new(&mut png), ImageFormat::Png)
        .unwrap();
        let texture = Texture::decode(&png, "a.png").unwrap();
        // 188 of 255 is half the light; the upper row has v above 1/2.
        let upper = texture.mean_over(
            [
                DVec2::new(0.1, 0.6),
                DVec2::new(0.9, 0.6),
                DVec2::new(0.5, 0.9),
            ],
            false,
        );
        assert!(
            (upper[0] - 0.503).abs() < 1e-3 && (upper[2] - 1.0).abs() < 1e-6,
            "{upper:?}"
        );
        assert!(Texture::decode(b"not an image", "a.png").is_err());
    }
}
