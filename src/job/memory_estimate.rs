//! How much memory a solve is going to need, told before it begins.
//!
//! What polygons and patches cost is measured and nearly the same in every scene: with the true number of patches the
//! formula is within 15 %. How many patches there will be is a guess from the settings: over 23 solves
//! (`bench/runs/`, memory) their number was between 0.3 and 2 times the guess, and the peak between 0.7 and 1.5
//! times [`MemoryEstimate::likely`].

use crate::scene::Scene;
use crate::solve::SolveConfig;

/// The peak of resident memory in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MemoryEstimate {
    /// The single best guess.
    pub likely: u64,
    /// With as many patches as were met at worst.
    pub most: u64,
}

/// The program, its libraries and the stacks of its threads.
const PROGRAM: f64 = 17.0e6;
/// A polygon: as read, in Embree, in the hierarchy and among the occluders.
const POLYGON: f64 = 1200.0;
/// A patch while light is exchanged, with those above it.
const PATCH: f64 = 250.0;
/// A polygon and a patch while the picture is made, when the light has been given back.
const POLYGON_SEEN: f64 = 1000.0;
const PATCH_SEEN: f64 = 115.0;
/// A picture of 960 x 720 with its layers.
const PICTURE: f64 = 75.0e6;

/// Patches of an empty room at the reference settings below.
const PATCHES: f64 = 30_000.0;
const REFERENCE_EPSILON: f64 = 1.0e-4;
const REFERENCE_GRADIENT: f64 = 5.0e-3;
const REFERENCE_MIN_AREA: f64 = 1.0e-6;
/// By which power of each setting their number grows (fitted to cornell and d).
const POWER: f64 = 0.25;
/// Polygons from which clutter makes for more shadows.
const CLUTTER: f64 = 700.0;
/// Patches met over patches guessed, at worst, with some to spare.
const WORST: f64 = 2.5;

impl MemoryEstimate {
    /// Of a solve of `scene`, with or without a picture.
    pub fn of(scene: &Scene, config: &SolveConfig, with_picture: bool) -> Self {
        Self::of_polygons(scene.polygons.len() as f64, config, with_picture)
    }

    fn of_polygons(polygons: f64, config: &SolveConfig, with_picture: bool) -> Self {
        let shadows = PATCHES
            * (REFERENCE_EPSILON / config.epsilon).powf(POWER)
            * (REFERENCE_GRADIENT / config.gradient).powf(POWER)
            * (REFERENCE_MIN_AREA / config.min_area.max(f64::MIN_POSITIVE)).powf(POWER)
            * (1.0 + polygons / CLUTTER).sqrt();
        // Two sides of the area, and what is not split any more may just have been.
        let finest = 8.0 / config.min_area;
        let peak = |shadows: f64| {
            let patches = 2.0 * polygons + shadows.min(finest);
            let solving = PROGRAM + POLYGON * polygons + PATCH * patches;
            let seeing = PROGRAM + PICTURE + POLYGON_SEEN * polygons + PATCH_SEEN * patches;
            match with_picture {
                true => solving.max(seeing) as u64,
                false => solving as u64,
            }
        };
        Self {
            likely: peak(shadows),
            most: peak(WORST * shadows),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Polygons, epsilon, picture, peak of resident memory in MB: solves that were measured.
    const MEASURED: [(f64, f64, bool, f64); 23] = [
        (36.0, 1e-3, false, 22.2),
        (36.0, 1e-4, false, 24.8),
        (36.0, 1e-5, false, 30.5),
        (36.0, 1e-6, false, 42.4),
        (188.0, 1e-5, false, 29.3),
        (738.0, 1e-3, false, 35.6),
        (738.0, 1e-4, false, 37.5),
        (738.0, 1e-5, false, 42.9),
        (1412.0, 1e-5, false, 29.9),
        (1456.0, 1e-5, false, 46.0),
        (2572.0, 1e-4, false, 25.7),
        (14422.0, 1e-3, false, 46.4),
        (21056.0, 1e-3, false, 92.7),
        (83650.0, 1e-3, false, 203.1),
        (20012.0, 1e-3, false, 61.7),
        (36.0, 1e-4, true, 95.3),
        (738.0, 1e-5, true, 110.4),
        (1412.0, 1e-4, true, 100.1),
        (36.0, 1e-6, true, 105.5),
        (21056.0, 1e-4, false, 94.6),
        (36962.0, 1e-4, false, 105.4),
        (21056.0, 1e-3, true, 144.0),
        (36962.0, 1e-3, true, 147.6),
    ];

    #[test]
    fn the_estimate_is_near_what_was_measured() {
        let (mut least, mut greatest) = (f64::INFINITY, 0.0f64);
        for (polygons, epsilon, picture, peak) in MEASURED {
            let config = SolveConfig {
                epsilon,
                ..SolveConfig::default()
            };
            let estimate = MemoryEstimate::of_polygons(polygons, &config, picture);
            let ratio = peak * 1e6 / estimate.likely as f64;
            println!("{polygons} polygons, epsilon {epsilon}: measured over estimate {ratio:.2}");
            (least, greatest) = (least.min(ratio), greatest.max(ratio));
            assert!(
                peak * 1e6 < estimate.most as f64 * 1.1,
                "{polygons} {epsilon}"
            );
        }
        println!("between {least:.2} and {greatest:.2}");
        assert!(least > 0.65 && greatest < 1.5, "{least} {greatest}");
    }

    #[test]
    fn finer_settings_need_more_and_the_smallest_patch_bounds_them() {
        let of = |epsilon, min_area| {
            let config = SolveConfig {
                epsilon,
                min_area,
                ..SolveConfig::default()
            };
            MemoryEstimate::of_polygons(1000.0, &config, false).likely
        };
        assert!(of(1e-6, 1e-6) > of(1e-5, 1e-6));
        assert!(of(1e-5, 1e-8) > of(1e-5, 1e-6));
        assert_eq!(of(1e-12, 1e-3), of(1e-15, 1e-3));
        // No split is forbidden: still a number.
        assert!(of(1e-9, 0.0) > of(1e-9, 1e-8));
    }
}
