//! Where the power went (design, section 6): absorbed by sums, escaped by rays.
//!
//! What escapes is *measured*, by cosine-distributed rays from what was shot, and never taken as the
//! difference, which would hide every error of the form factors.

use super::radiosity::Light;
use super::solution::PatchPath;
use crate::cluster::Hierarchy;
use crate::embree::{CommittedScene, Ray};
use crate::math::{FacetId, SampleSequence};
use crate::scene::{Facet, Scene, Side};
use glam::Vec3;
use rayon::prelude::*;

/// Rays that measure what escapes: a standard error of at most 0.1 % of the power.
const ESCAPE_RAYS: usize = 1 << 18;
/// Rays a task casts at once.
const BATCH: usize = 1 << 12;

/// Places tried on a patch that a solid hides in part, since what it reflects comes from its open part.
const TRIES: usize = 16;

/// A patch and the power that it has shot.
#[derive(Clone, Copy, Debug)]
pub struct RadiatingPatch {
    /// Its facet.
    pub facet: FacetId,
    /// Where in the facet.
    pub path: PatchPath,
    /// Power, in any unit.
    pub power: f64,
}

/// Power that no side received.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Escape {
    /// Left the scene.
    pub escaped: f64,
    /// Standard error of `escaped` (binomial; the samples are stratified, so it is an upper estimate).
    pub escaped_stderr: f64,
    /// Arrived at backs that have no side.
    pub swallowed: f64,
}

/// Power absorbed per area by a surface of this reflectance, mean of the channels.
pub fn absorbed_power<const C: usize>(reflectance: &Light<C>, irradiance: &Light<C>) -> f64 {
    reflectance
        .iter()
        .zip(irradiance)
        .map(|(r, e)| (1.0 - r) * e)
        .sum::<f64>()
        / C as f64
}

/// Measures what escapes of the power of `patches`. Deterministic at any number of threads.
pub fn escape(
    scene: &Scene,
    hierarchy: &Hierarchy,
    embree: &CommittedScene,
    normals: &[Vec3],
    patches: &[RadiatingPatch],
    seed: u64,
) -> Escape {
    let mut before = Vec::with_capacity(patches.len() + 1);
    let mut total = 0.0;
    for patch in patches {
        before.push(total);
        total += patch.power;
    }
    if total <= 0.0 {
        return Escape::default();
    }
    let mut has_side = vec![[false; 2]; scene.polygons.len()];
    for facet in &hierarchy.facets {
        has_side[facet.polygon.index()][usize::from(facet.side == Side::Back)] = true;
    }
    let tau = scene.tau();
    let sequence = SampleSequence::new(seed);
    let counts: Vec<(usize, usize)> = (0..ESCAPE_RAYS / BATCH)
        .into_par_iter()
        .map(|batch| {
            let mut swallowed = 0;
            let rays: Vec<Ray> = (batch * BATCH..(batch + 1) * BATCH)
                .filter_map(|i| {
                    // Strata of equal power: one ray each.
                    let target = (i as f64 + 0.5) / ESCAPE_RAYS as f64 * total;
                    let patch = patches[before.partition_point(|&x| x <= target) - 1];
                    let facet = hierarchy.facets[patch.facet.index()];
                    let corners = patch.path.corners(scene.facet_corners(facet));
                    let tries = if scene.emission(facet) == [0.0; 3] {
                        TRIES
                    } else {
                        1
                    };
                    let ray = (0..tries).find_map(|k| {
                        let [u, v, s, t] = sequence.point((i + k * ESCAPE_RAYS) as u32);
                        let origin = point_in(corners, u, v);
                        let normal = normals[patch.facet.index()];
                        (!scene.contacts.is_hidden(facet, origin))
                            .then(|| cosine_ray(origin, normal, s, t, tau))
                    });
                    swallowed += usize::from(ray.is_none());
                    ray
                })
                .collect();
            let mut hits = Vec::with_capacity(rays.len());
            embree.closest_hits(&rays, &mut hits);
            let mut count = (0, swallowed);
            for (ray, hit) in rays.iter().zip(&hits) {
                match hit {
                    None => count.0 += 1,
                    Some(hit) => {
                        let [a, b, c] = scene.corners(hit.polygon);
                        let back = (b - a).cross(c - a).dot(ray.direction) > 0.0;
                        let facet = Facet {
                            polygon: hit.polygon,
                            side: if back { Side::Back } else { Side::Front },
                        };
                        // What falls on a covered side is received by those that lie with it.
                        let received = has_side[hit.polygon.index()][usize::from(back)]
                            || scene.contacts.is_covered(facet);
                        count.1 += usize::from(!received);
                    }
                }
            }
            count
        })
        .collect();
    let (escaped, swallowed) = counts
        .iter()
        .fold((0, 0), |sum, c| (sum.0 + c.0, sum.1 + c.1));
    let share = |count: usize| count as f64 / ESCAPE_RAYS as f64;
    let p = share(escaped);
    Escape {
        escaped: total * p,
        escaped_stderr: total * (p * (1.0 - p) / ESCAPE_RAYS as f64).sqrt(),
        swallowed: total * share(swallowed),
    }
}

/// Uniform point of a triangle from a point of the unit square, folded along its diagonal.
fn point_in([a, b, c]: [Vec3; 3], u: f32, v: f32) -> Vec3 {
    let (u, v) = if u + v > 1.0 {
        (1.0 - u, 1.0 - v)
    } else {
        (u, v)
    };
    a + (b - a) * u + (c - a) * v
}

/// A ray in a cosine-distributed direction about `normal`, starting tau below its horizon's depth.
fn cosine_ray(origin: Vec3, normal: Vec3, s: f32, t: f32, tau: f32) -> Ray {
    let (tangent, bitangent) = normal.any_orthonormal_pair();
    let radius = s.sqrt();
    let (sine, cosine) = (std::f32::consts::TAU * t).sin_cos();
    // At least one tau of height a diagonal, so that tnear stays finite.
    let height = (1.0 - s).sqrt().max(1.0e-4);
    Ray {
        origin,
        direction: tangent * (radius * cosine) + bitangent * (radius * sine) + normal * height,
        tnear: tau / height,
        tfar: f32::INFINITY,
    }
}
