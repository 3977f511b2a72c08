//! The mean colour of a texture over a triangle of texture space.
//!
//! A footprint is integrated exactly, texel by texel, on the level of the image's
//! pyramid at which it is about [`FOOTPRINT_TEXELS`] wide.

use super::convex::{area, clip};
use super::texture::{Level, Texture};
use glam::DVec2;

/// Width in texels up to which a footprint is integrated without coarsening. Only texels on the
/// footprint's border are coarsened in effect, so this bounds the blur at its edge to 1/32.
const FOOTPRINT_TEXELS: f64 = 32.0;

/// Texture coordinates beyond this have lost their fraction to any exporter's digits.
const LARGEST_COORDINATE: f64 = 1e9;

impl Texture {
    /// Mean over the triangle with texture coordinates `corners` (v runs upwards), the image
    /// repeating beyond [0, 1] or, if `clamp`, its border going on.
    pub fn mean_over(&self, corners: [DVec2; 3], clamp: bool) -> [f64; 3] {
        let sane = corners
            .iter()
            .all(|c| c.abs().max_element() < LARGEST_COORDINATE);
        if !sane {
            return self.mean();
        }
        let size = DVec2::new(self.width as f64, self.height as f64);
        let mut corners = corners.map(|c| DVec2::new(c.x, 1.0 - c.y));
        if !clamp {
            // Near the origin, where f64 is finest.
            let home = corners[0].min(corners[1]).min(corners[2]).floor();
            corners = corners.map(|c| c - home);
        }
        let corners = corners.map(|c| c * size);
        let least = corners[0].min(corners[1]).min(corners[2]);
        let extent = corners[0].max(corners[1]).max(corners[2]) - least;
        let level = self
            .levels
            .iter()
            .find(|l| extent.max_element() <= FOOTPRINT_TEXELS * l.step as f64);
        let Some(level) = level else {
            // So many repeats that what is cut off at the border is a small share.
            if !clamp {
                return self.mean();
            }
            return self.integrate(
                self.levels.last().unwrap_or(&self.levels[0]),
                corners,
                clamp,
            );
        };
        self.integrate(level, corners, clamp)
    }

    fn integrate(&self, level: &Level, corners: [DVec2; 3], clamp: bool) -> [f64; 3] {
        let mut sum = [0.0; 3];
        let mut whole = 0.0;
        let mut row = Vec::with_capacity(8);
        let mut cell = Vec::with_capacity(8);
        let mut part = Vec::with_capacity(8);
        let range = |axis: usize| {
            let of = corners.map(|c| c[axis]);
            (of[0].min(of[1]).min(of[2]), of[0].max(of[1]).max(of[2]))
        };
        let columns = cells(range(0), self.width, level.width, level.step, clamp);
        let rows = cells(range(1), self.height, level.height, level.step, clamp);
        for (j, y0, y1) in rows {
            clip_range(&corners, DVec2::Y, y0, y1, &mut cell, &mut row);
            for &(i, x0, x1) in &columns {
                clip_range(&row, DVec2::X, x0, x1, &mut cell, &mut part);
                let covered = area(&part);
                whole += covered;
                let texel = level.texels[j * level.width + i];
                for (s, t) in sum.iter_mut().zip(texel) {
                    *s += covered * f64::from(t);
                }
            }
        }
        // A footprint squeezed to a line or a point has no area to weigh with.
        if whole > 0.0 && whole.is_finite() {
            sum.map(|s| s / whole)
        } else {
            self.mean_of_points(corners, clamp)
        }
    }

    /// Mean of the texels under the corners and the centre.
    fn mean_of_points(&self, [a, b, c]: [DVec2; 3], clamp: bool) -> [f64; 3] {
        let points = [a, b, c, (a + b + c) / 3.0];
        let index = |at: f64, count: usize| {
            let at = at.floor();
            let at = if clamp {
                at.clamp(0.0, (count - 1) as f64)
            } else {
                at.rem_euclid(count as f64)
            };
            (at as usize).min(count - 1)
        };
        let mut sum = [0.0; 3];
        for p in points {
            let texel = self.levels[0].texels
                [index(p.y, self.height) * self.width + index(p.x, self.width)];
            for (s, t) in sum.iter_mut().zip(texel) {
                *s += f64::from(t) / points.len() as f64;
            }
        }
        sum
    }
}

/// The texels along one axis that the range meets: index, and from where to where in texels of
/// the unrepeated image.
fn cells(
    (from, to): (f64, f64),
    size: usize,
    count: usize,
    step: usize,
    clamp: bool,
) -> Vec<(usize, f64, f64)> {
    let mut cells = Vec::new();
    let (first_tile, last_tile) = if clamp {
        (0, 0)
    } else {
        let tile = |at: f64| (at / size as f64).floor() as i64;
        (tile(from), tile(to))
    };
    for tile in first_tile..=last_tile {
        let start = tile as f64 * size as f64;
        for i in 0..count {
            let mut low = start + (i * step) as f64;
            let mut high = start + ((i + 1) * step).min(size) as f64;
            if clamp && i == 0 {
                low = f64::NEG_INFINITY;
            }
            if clamp && i + 1 == count {
                high = f64::INFINITY;
            }
            if low <= to && high >= from {
                cells.push((i, low, high));
            }
        }
    }
    cells
}

/// Puts into `out` the part of a convex polygon between two parallels, either of which may lie at infinity.
fn clip_range(
    polygon: &[DVec2],
    axis: DVec2,
    low: f64,
    high: f64,
    scratch: &mut Vec<DVec2>,
    out: &mut Vec<DVec2>,
) {
    clip(polygon, axis, low, scratch);
    clip(scratch, -axis, -high, out);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::hash_u64;
    use proptest::prelude::*;

    fn uv(corners: [(f64, f64); 3]) -> [DVec2; 3] {
        corners.map(DVec2::from)
    }

    /// Left half red, right half green; `size` x `size`.
    fn halves(size: usize) -> Texture {
        let texel = |i: usize| {
            if i % size < size / 2 {
                [1.0, 0.0, 0.0]
            } else {
                [0.0, 1.0, 0.0]
            }
        };
        Texture::from_linear(size, size, (0..size * size).map(texel).collect())
    }

    #[test]
    fn footprints_of_two_halves() {
        for size in [2, 8, 256] {
            let texture = halves(size);
            let red = texture.mean_over(uv([(0.0, 0.0), (0.5, 0.0), (0.0, 1.0)]), false);
            assert!(
                (red[0] - 1.0).abs() < 1e-6 && red[1] < 1e-6,
                "{size}: {red:?}"
            );
            // Of the triangle (0,0) (1,0) (0,1) three quarters lie left of the middle.
            let mixed = texture.mean_over(uv([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]), false);
            assert!((mixed[0] - 0.75).abs() < 1e-6, "{size}: {mixed:?}");
            // The same one repeat further on, and by -2.
            for shift in [1.0, -2.0] {
                let there = uv([(shift, 0.0), (1.0 + shift, 0.0), (shift, 1.0)]);
                assert!((texture.mean_over(there, false)[0] - 0.75).abs() < 1e-6);
            }
            // Beyond the right border of a clamped image all is green.
            let beyond = uv([(1.5, 0.0), (2.5, 0.0), (1.5, 1.0)]);
            assert_eq!(texture.mean_over(beyond, true), [0.0, 1.0, 0.0]);
            assert!(texture.mean_over(beyond, false)[0] > 0.2);
        }
    }

    #[test]
    fn degenerate_and_absurd_footprints_have_a_colour() {
        let texture = halves(16);
        let point = texture.mean_over([DVec2::new(0.25, 0.3); 3], false);
        assert_eq!(point, [1.0, 0.0, 0.0]);
        let absurd = texture.mean_over(uv([(0.0, 0.0), (1e300, 0.0), (0.0, 1.0)]), false);
        assert_eq!(absurd, [0.5, 0.5, 0.0]);
        let tiled = texture.mean_over(uv([(0.0, 0.0), (900.0, 0.0), (0.0, 900.0)]), false);
        assert_eq!(tiled, [0.5, 0.5, 0.0]);
    }

    proptest! {
        #[test]
        fn agrees_with_dense_sampling(
            corners in prop::array::uniform3((-1.5..2.5f64, -1.5..2.5f64)),
            clamp in any::<bool>(),
            width in 1usize..7,
            height in 1usize..7,
        ) {
            let texels = (0..width * height)
                .map(|i| [(i * 7 % 5) as f32 / 5.0, (i % 2) as f32, 0.25])
                .collect();
            let texture = Texture::from_linear(width, height, texels);
            let [a, b, c] = uv(corners);
            prop_assume!((b - a).perp_dot(c - a).abs() > 0.1);
            let got = texture.mean_over([a, b, c], clamp);
            let (n, mut sum) = (160_u64, DVec2::ZERO);
            for i in 0..n {
                for j in 0..n {
                    // Anywhere in its cell: rows of a lattice may run along borders of texels. At most 48 borders cut
                    // 320 of the 25,600 cells each, so the standard error is below 0.5 sqrt(48 * 320) / 25,600 = 0.0025.
                    let at = |axis: u64| (hash_u64(2 * (160 * i + j) + axis) >> 11) as f64 / (1_u64 << 53) as f64;
                    let (s, t) = ((i as f64 + at(0)) / n as f64, (j as f64 + at(1)) / n as f64);
                    // The square folded onto the triangle.
                    let (s, t) = if s + t > 1.0 { (1.0 - s, 1.0 - t) } else { (s, t) };
                    let p = a + (b - a) * s + (c - a) * t;
                    let wrap = |x: f64, size: usize| {
                        let x = if clamp { x.clamp(0.0, 1.0) } else { x - x.floor() };
                        ((x * size as f64) as usize).min(size - 1)
                    };
                    let texel = texture.levels[0].texels[wrap(1.0 - p.y, height) * width + wrap(p.x, width)];
                    sum += DVec2::new(f64::from(texel[0]), f64::from(texel[1]));
                }
            }
            let expected = sum / (n * n) as f64;
            prop_assert!((got[0] - expected.x).abs() < 0.02 && (got[1] - expected.y).abs() < 0.02, "{got:?} {expected}");
            prop_assert!((got[2] - 0.25).abs() < 1e-6);
        }
    }
}
