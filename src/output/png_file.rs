//! Writes a picture as 8-bit sRGB PNG with alpha.

use super::{OutputError, Picture, ToneMap, write_atomically};
use std::path::Path;
use std::sync::atomic::AtomicBool;

/// Writes `picture` to `path` through `tone_map`, whole or not at all. Alpha is not premultiplied,
/// as PNG wants it: a pixel that the scene covers in part shows what covers it.
///
/// # Errors
/// As [`write_atomically`], and [`OutputError::Encoding`].
pub fn write_png(
    path: &Path,
    picture: &Picture,
    tone_map: ToneMap,
    interrupted: &AtomicBool,
) -> Result<(), OutputError> {
    let bytes: Vec<u8> = picture
        .pixels
        .iter()
        .flat_map(|pixel| {
            let alpha = pixel.alpha.clamp(0.0, 1.0);
            let colour = if alpha > 0.0 {
                pixel.radiance.map(|x| x / alpha)
            } else {
                [0.0; 3]
            };
            let [r, g, b] = tone_map.encode(colour);
            [r, g, b, (255.0 * alpha + 0.5) as u8]
        })
        .collect();
    write_rgba_png(path, picture.size, &bytes, interrupted)
}

/// As [`write_rgb_png`] with a fourth byte, alpha.
pub(super) fn write_rgba_png(
    path: &Path,
    size: [u32; 2],
    pixels: &[u8],
    interrupted: &AtomicBool,
) -> Result<(), OutputError> {
    write(path, size, png::ColorType::Rgba, pixels, interrupted)
}

/// Writes 8-bit sRGB pixels, three bytes each, row by row from the top, whole or not at all.
///
/// # Errors
/// As [`write_png`].
pub(super) fn write_rgb_png(
    path: &Path,
    size: [u32; 2],
    pixels: &[u8],
    interrupted: &AtomicBool,
) -> Result<(), OutputError> {
    write(path, size, png::ColorType::Rgb, pixels, interrupted)
}

fn write(
    path: &Path,
    size: [u32; 2],
    colour: png::ColorType,
    bytes: &[u8],
    interrupted: &AtomicBool,
) -> Result<(), OutputError> {
    let failed = |e: png::EncodingError| match e {
        png::EncodingError::IoError(e) => OutputError::io("write", path, e),
        other => OutputError::Encoding {
            path: path.to_path_buf(),
            reason: other.to_string(),
        },
    };
    write_atomically(path, interrupted, |file| {
        let mut encoder = png::Encoder::new(file, size[0], size[1]);
        encoder.set_color(colour);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header().map_err(failed)?;
        writer.write_image_data(bytes).map_err(failed)?;
        writer.finish().map_err(failed)
    })
}
