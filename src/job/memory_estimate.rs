//! How much memory a solve is going to need, told before it begins.
//!
//! What polygons and patches cost is measured and nearly the same in every scene. How many patches there will be is
//! a guess from the settings: over 24 solves of built-in scenes and scenes of others (`bench/runs/`, memory)
//! their number was between 0.4 and 1.8 times the guess, and the peak between 0.7 and 1.4 times
//! [`MemoryEstimate::likely`].

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
const PROGRAM: f64 = 14.0e6;
/// A polygon: as read, in Embree, in the hierarchy and among the occluders.
const POLYGON: f64 = 1150.0;
/// A patch while light is exchanged, with those above it.
const PATCH: f64 = 210.0;
/// A polygon and a patch while the picture is made, when the light has been given back.
const POLYGON_SEEN: f64 = 1000.0;
const PATCH_SEEN: f64 = 115.0;
/// A picture of 960 x 720 with its layers.
const PICTURE: f64 = 75.0e6;

/// Patches of an empty room at the reference settings below.
const PATCHES: f64 = 27_000.0;
const REFERENCE_EPSILON: f64 = 1.0e-4;
const REFERENCE_GRADIENT: f64 = 5.0e-3;
const REFERENCE_MIN_AREA: f64 = 1.0e-6;
/// By which powers of the settings their number grows (fitted to cornell, d and offices).
const POWER_OF_EPSILON: f64 = 0.3;
const POWER_OF_REST: f64 = 0.25;
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
            * (REFERENCE_EPSILON / config.epsilon).powf(POWER_OF_EPSILON)
            * (REFERENCE_GRADIENT / config.gradient).powf(POWER_OF_REST)
            * (REFERENCE_MIN_AREA / config.min_area.max(f64::MIN_POSITIVE)).powf(POWER_OF_REST)
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
    const MEASURED: [(f64, f64, bool, f64); 24] = [
        (36.0, 1e-4, true, 93.4),
        (36.0, 1e-4, false, 19.6),
        (36.0, 1e-5, false, 25.7),
        (36.0, 1e-6, true, 100.6),
        (36.0, 1e-6, false, 34.6),
        (36.0, 1e-3, false, 19.4),
        (1456.0, 1e-5, true, 109.2),
        (1456.0, 1e-5, false, 40.2),
        (738.0, 1e-3, false, 25.6),
        (738.0, 1e-4, false, 32.2),
        (738.0, 1e-5, true, 109.5),
        (738.0, 1e-5, false, 37.9),
        (21_056.0, 1e-3, false, 69.4),
        (21_056.0, 1e-4, true, 132.0),
        (21_056.0, 1e-4, false, 83.2),
        (1412.0, 1e-5, true, 98.3),
        (1412.0, 1e-5, false, 25.6),
        (36_962.0, 1e-4, true, 145.2),
        (36_962.0, 1e-4, false, 92.0),
        (188.0, 1e-5, false, 26.0),
        (7804.0, 1e-4, true, 133.0),
        (20_012.0, 1e-4, false, 55.5),
        (14_422.0, 1e-3, false, 40.2),
        (83_650.0, 1e-3, false, 134.7),
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
        assert!(least > 0.65 && greatest < 1.45, "{least} {greatest}");
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
