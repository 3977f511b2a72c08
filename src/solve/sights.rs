//! Pairs of points that see each other, drawn as light travels: what is worth a box of air.

use crate::cluster::Hierarchy;
use crate::embree::{CommittedScene, Ray};
use crate::math::SampleSequence;
use crate::scene::{Facet, Scene};
use glam::Vec3;
use std::f32::consts::TAU;

/// Sights drawn in the smallest scene, and more with its facets: one in eight.
const LEAST_SIGHTS: usize = 4096;
/// And never more than this, whose rays and boxes cost a few tenths of a second in a scene of a million polygons.
const MOST_SIGHTS: usize = 16_384;
/// One sight in so many starts on an emitter, as all of pass 1 does.
const FROM_EMITTERS: usize = 4;
/// Belongs to these draws alone.
const KEY: u64 = 0x5167_6874;

/// Points that see each other: the first uniform by area over the facets (or over those that emit), the second where a
/// ray in a cosine-distributed direction ends, so that pairs come up in proportion to their form factor.
pub(super) fn draw_sights(
    scene: &Scene,
    hierarchy: &Hierarchy,
    embree: &CommittedScene,
) -> Vec<[Vec3; 2]> {
    let facets = &hierarchy.facets;
    let all = area_before(scene, facets, |_| true);
    let emitting = area_before(scene, facets, |f| scene.emission(f) != [0.0; 3]);
    let count = (LEAST_SIGHTS + facets.len() / 8).min(MOST_SIGHTS);
    let sequence = SampleSequence::new(KEY);
    let tau = scene.tau();
    let rays: Vec<Ray> = (0..count)
        .filter_map(|i| {
            let sums = match i % FROM_EMITTERS {
                0 => &emitting,
                _ => &all,
            };
            // Strata over the area: the golden ratio's multiples.
            let place = (i as f64 * 0.618_033_988_749_894_9).fract() * sums.last()?;
            let facet = sums.partition_point(|&sum| sum <= place);
            ray_from(scene, *facets.get(facet)?, sequence.point(i as u32), tau)
        })
        .collect();
    let mut hits = Vec::new();
    embree.closest_hits(&rays, &mut hits);
    rays.iter()
        .zip(hits)
        .filter_map(|(ray, hit)| Some([ray.origin, ray.at(hit?.t)]))
        .collect()
}

/// Sums of the areas of the chosen facets up to each, and with it.
fn area_before(scene: &Scene, facets: &[Facet], chosen: impl Fn(Facet) -> bool) -> Vec<f64> {
    facets
        .iter()
        .scan(0.0, |sum, &facet| {
            if chosen(facet) {
                *sum += scene.polygon_area(facet.polygon);
            }
            Some(*sum)
        })
        .collect()
}

fn ray_from(scene: &Scene, facet: Facet, [u, v, s, t]: [f32; 4], tau: f32) -> Option<Ray> {
    let [a, b, c] = scene.facet_corners(facet);
    let normal = (b - a).cross(c - a).try_normalize()?;
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    let root = u.sqrt();
    let origin = a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v);
    let (sin, cos) = (t * TAU).sin_cos();
    let direction =
        (tangent * cos + bitangent * sin) * s.sqrt() + normal * (1.0 - s).max(0.0).sqrt();
    Some(Ray::half_line(origin, direction, 16.0 * tau))
}
