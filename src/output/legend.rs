//! Draws the legend of false colours into a corner of a picture.

use super::canvas::Canvas;
use super::colour_scale::{ColourScale, short};
use super::error::OutputError;
use super::sweep_plot::{FONT, register_built_in_font};
use plotters::prelude::*;
use std::path::Path;

/// Width and height of the box, its margin to the picture's corner, and the bar within it, in pixels.
const BOX: [u32; 2] = [340, 66];
const MARGIN: u32 = 12;
const BAR: [i32; 4] = [14, 28, 312, 14];

/// Numbers written along the bar.
const NUMBERS: u32 = 4;

/// Draws the legend into the lower left corner. A picture too small for it is left as it is.
///
/// # Errors
/// [`OutputError::Encoding`] with the drawing library's complaint; `path` is for the message.
pub(super) fn draw_legend(
    canvas: &mut Canvas,
    scale: &ColourScale,
    path: &Path,
) -> Result<(), OutputError> {
    let [width, height] = canvas.size;
    if width < BOX[0] + 2 * MARGIN || height < BOX[1] + 2 * MARGIN {
        return Ok(());
    }
    let failed = |reason: String| OutputError::Encoding {
        path: path.to_path_buf(),
        reason,
    };
    register_built_in_font().map_err(failed)?;
    let mut pixels = vec![0u8; 3 * (BOX[0] * BOX[1]) as usize];
    draw(&mut pixels, scale).map_err(|e| failed(e.to_string()))?;
    for y in 0..BOX[1] {
        for x in 0..BOX[0] {
            let from = 3 * (y * BOX[0] + x) as usize;
            let to = (height - MARGIN - BOX[1] + y) * width + MARGIN + x;
            let colour = [0, 1, 2].map(|c| linear(pixels[from + c]));
            canvas.blend(to as usize, colour, 1.0);
        }
    }
    Ok(())
}

fn draw(
    pixels: &mut [u8],
    scale: &ColourScale,
) -> Result<(), DrawingAreaErrorKind<<BitMapBackend<'static> as DrawingBackend>::ErrorType>> {
    let area = BitMapBackend::with_buffer(pixels, (BOX[0], BOX[1])).into_drawing_area();
    area.fill(&RGBColor(24, 24, 24))?;
    let text = |size: i32| TextStyle::from((FONT, size)).color(&WHITE);
    let title = match scale.unit {
        "" => scale.label.to_owned(),
        unit => format!("{}, {unit}", scale.label),
    };
    area.draw_text(&title, &text(17), (BAR[0], 5))?;
    for x in 0..BAR[2] {
        let place = f64::from(x) / f64::from(BAR[2] - 1);
        let [r, g, b] = scale.colour_at(place).map(|c| {
            let encoded = super::tonemap::srgb(f64::from(c));
            (255.0 * encoded + 0.5) as u8
        });
        let at = BAR[0] + x;
        area.draw(&Rectangle::new(
            [(at, BAR[1]), (at + 1, BAR[1] + BAR[3])],
            RGBColor(r, g, b).filled(),
        ))?;
    }
    for i in 0..=NUMBERS {
        let place = f64::from(i) / f64::from(NUMBERS);
        let number = short(scale.value(place));
        let (width, _) = area.estimate_text_size(&number, &text(15))?;
        let x = BAR[0] + (f64::from(BAR[2]) * place) as i32;
        let left = x - (f64::from(width) * place) as i32;
        area.draw_text(&number, &text(15), (left, BAR[1] + BAR[3] + 4))?;
    }
    area.present()
}

/// Linear light of an sRGB byte (IEC 61966-2-1).
fn linear(byte: u8) -> f32 {
    let x = f32::from(byte) / 255.0;
    if x <= 0.040_45 {
        x / 12.92
    } else {
        ((x + 0.055) / 1.055).powf(2.4)
    }
}
