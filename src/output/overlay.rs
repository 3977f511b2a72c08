//! Marks laid over a picture: colours of what lies under each pixel, and lines where it changes.

use super::camera::PinHole;
use super::canvas::Canvas;
use super::view::{Landing, View};
use crate::embree::{Hit, Ray};
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// Samples along each side of a pixel: lines are two of them wide, two thirds of a pixel.
const SIDE: usize = 3;

/// What a ray through the picture sees.
pub(super) struct Sight {
    pub ray: Ray,
    pub hit: Hit,
    /// `None` on a side without light.
    pub landing: Option<Landing>,
    /// Between the ray and the surface, in [0, 1].
    pub cosine: f32,
}

/// What is laid over a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mark {
    pub colour: [f32; 3],
    /// In [0, 1].
    pub opacity: f32,
    /// A line is drawn where this changes from sample to sample.
    pub id: u32,
}

impl Mark {
    /// Where nothing is seen.
    const NOTHING: Self = Self {
        colour: [0.0; 3],
        opacity: 0.0,
        id: u32::MAX,
    };
}

/// Opacity of lines, in [0, 1]; they are black on bright ground and white on dark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lines(pub f32);

/// Brightness of the ground from which lines are black: half of what the eye sees as grey.
const BRIGHT: f32 = 0.2;

impl View<'_> {
    /// Lays marks over `canvas`, which `camera` took. `None` when `interrupted` was raised.
    pub(super) fn lay_over(
        &self,
        canvas: &mut Canvas,
        camera: &PinHole,
        lines: Lines,
        mark: &(dyn Fn(&Sight) -> Mark + Sync),
        interrupted: &AtomicBool,
    ) -> Option<()> {
        let width = canvas.size[0] as usize;
        let rows: Vec<Vec<RowMark>> = (0..canvas.size[1] as usize)
            .into_par_iter()
            .map(|y| match interrupted.load(Ordering::Relaxed) {
                true => Vec::new(),
                false => self.mark_row(camera, y, width, mark),
            })
            .collect();
        if interrupted.load(Ordering::Relaxed) {
            return None;
        }
        for (i, mark) in rows.into_iter().flatten().enumerate() {
            if mark.opacity > 0.0 {
                canvas.blend(i, mark.colour, mark.opacity);
            }
            if mark.line > 0.0 {
                let [r, g, b, alpha] = canvas.pixels[i];
                let ground = alpha * (0.2126 * r + 0.7152 * g + 0.0722 * b);
                let line = if ground > BRIGHT { 0.0 } else { 1.0 };
                canvas.blend(i, [line; 3], mark.line * lines.0);
            }
        }
        Some(())
    }

    fn mark_row(
        &self,
        camera: &PinHole,
        y: usize,
        width: usize,
        mark: &(dyn Fn(&Sight) -> Mark + Sync),
    ) -> Vec<RowMark> {
        // One more sample all around, for the lines.
        let across = width * SIDE + 2;
        let place = |i: usize| (i as f64 - 0.5) / SIDE as f64;
        let mut rays = Vec::with_capacity(across);
        let mut hits = Vec::new();
        let mut marks: Vec<Mark> = Vec::with_capacity(across * (SIDE + 2));
        for j in 0..SIDE + 2 {
            rays.clear();
            rays.extend((0..across).map(|i| self.ray(camera, place(i), y as f64 + place(j))));
            self.embree.closest_hits(&rays, &mut hits);
            marks.extend(rays.iter().zip(&hits).map(|(&ray, hit)| {
                match *hit {
                    None => Mark::NOTHING,
                    Some(hit) => mark(&Sight {
                        landing: self.landing(&hit, camera.eye()),
                        cosine: hit
                            .geometric_normal
                            .normalize_or_zero()
                            .dot(ray.direction)
                            .abs()
                            / ray.direction.length(),
                        hit,
                        ray,
                    }),
                }
            }));
        }
        let id = |i: usize, j: usize| marks[j * across + i].id;
        (0..width)
            .map(|x| {
                let mut sum = RowMark::default();
                let mut weights = 0.0;
                for j in 1..=SIDE {
                    for i in x * SIDE + 1..=(x + 1) * SIDE {
                        let mark = marks[j * across + i];
                        for c in 0..3 {
                            sum.colour[c] += mark.colour[c] * mark.opacity;
                        }
                        weights += mark.opacity;
                        let around = [id(i - 1, j), id(i + 1, j), id(i, j - 1), id(i, j + 1)];
                        sum.line += f32::from(u8::from(around.iter().any(|&o| o != mark.id)));
                    }
                }
                let share = 1.0 / (SIDE * SIDE) as f32;
                if weights > 0.0 {
                    sum.colour = sum.colour.map(|c| c / weights);
                }
                sum.opacity = weights * share;
                sum.line *= share;
                sum
            })
            .collect()
    }
}

/// The mean of a pixel's marks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct RowMark {
    colour: [f32; 3],
    opacity: f32,
    /// Share of the pixel that lines cover.
    line: f32,
}
