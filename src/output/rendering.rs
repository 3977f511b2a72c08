//! Takes pictures of a view: primary rays through Embree, patches looked up under the hits.

use super::camera::PinHole;
use super::gathering::Gathering;
use super::view::{View, ViewConfig};
use super::{Picture, Pixel};
use crate::embree::{Hit, Ray};
use rayon::prelude::*;
use std::f32::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering};

impl View<'_> {
    /// Takes a picture; `None` when `interrupted` was raised before it was done. The picture is the
    /// same at any number of threads.
    pub fn render(
        &self,
        camera: &PinHole,
        config: &ViewConfig,
        interrupted: &AtomicBool,
    ) -> Option<Picture> {
        self.render_watched(camera, config, interrupted, &|| {})
    }

    /// As [`Self::render`]; `row_done` is called after each row of pixels, from any thread.
    pub fn render_watched(
        &self,
        camera: &PinHole,
        config: &ViewConfig,
        interrupted: &AtomicBool,
        row_done: &(dyn Fn() + Sync),
    ) -> Option<Picture> {
        let size = camera.size();
        let width = size[0] as usize;
        let gathering = (config.gather > 0).then(|| Gathering::new(self, camera, config));
        let mut pixels = vec![Pixel::BACKGROUND; width * size[1] as usize];
        pixels.par_chunks_mut(width).enumerate().for_each_init(
            RowBuffers::default,
            |buffers, (y, row)| {
                if interrupted.load(Ordering::Relaxed) {
                    return;
                }
                self.identify_row(camera, y, row, buffers);
                match &gathering {
                    Some(gathering) => gathering.render_row(y, row, interrupted),
                    None => self.render_row(camera, config, y, row, buffers),
                }
                row_done();
            },
        );
        (!interrupted.load(Ordering::Relaxed)).then_some(Picture { size, pixels })
    }

    /// The middle of each pixel, for the layers that must not be averaged.
    fn identify_row(
        &self,
        camera: &PinHole,
        y: usize,
        row: &mut [Pixel],
        buffers: &mut RowBuffers,
    ) {
        buffers.rays.clear();
        buffers
            .rays
            .extend((0..row.len()).map(|x| self.ray(camera, x as f64 + 0.5, y as f64 + 0.5)));
        self.embree.closest_hits(&buffers.rays, &mut buffers.hits);
        for (pixel, hit) in row.iter_mut().zip(&buffers.hits) {
            if let Some(hit) = hit {
                self.identify(hit, camera, pixel);
            }
        }
    }

    fn render_row(
        &self,
        camera: &PinHole,
        config: &ViewConfig,
        y: usize,
        row: &mut [Pixel],
        buffers: &mut RowBuffers,
    ) {
        let side = config.samples_a_side.clamp(1, 16);
        let a_pixel = (side * side) as usize;
        buffers.rays.clear();
        for x in 0..row.len() {
            for k in 0..side * side {
                // A grid turned by the lattice's usual slant, so that no two samples of a pixel
                // share a row or column (n-rooks).
                let (i, j) = (f64::from(k % side), f64::from(k / side));
                let n = f64::from(side);
                buffers.rays.push(self.ray(
                    camera,
                    x as f64 + (i + (j + 0.5) / n) / n,
                    y as f64 + (j + (i + 0.5) / n) / n,
                ));
            }
        }
        self.embree.closest_hits(&buffers.rays, &mut buffers.hits);
        let share = 1.0 / a_pixel as f32;
        for (pixel, hits) in row.iter_mut().zip(buffers.hits.chunks(a_pixel)) {
            let mut covered = 0u32;
            for hit in hits.iter().flatten() {
                covered += 1;
                // A side without light is black.
                let Some(place) = self.landing(hit, camera.eye()) else {
                    continue;
                };
                let seen = self.light_at(&place, config.shading);
                for c in 0..3 {
                    pixel.radiance[c] += seen.radiosity[c] * share / PI;
                    pixel.irradiance[c] += seen.irradiance[c] * share;
                }
            }
            pixel.alpha = covered as f32 * share;
        }
    }
}

/// Memory that the rows of one thread share.
#[derive(Default)]
struct RowBuffers {
    rays: Vec<Ray>,
    hits: Vec<Option<Hit>>,
}
