//! Where the power went (design, section 6): absorbed by sums, escaped by rays.
//!
//! What escapes is *measured*, by cosine-distributed rays from what was shot, and never taken as the
//! difference, which would hide every error of the form factors.

use super::radiosity::Light;
use super::solution::PatchPath;
use crate::cluster::Hierarchy;
use crate::embree::{CommittedScene, Ray};
use crate::math::{FacetId, PolygonId, SampleSequence};
use crate::scene::{Facet, Scene, Side};
use glam::Vec3;
use rayon::prelude::*;

/// Rays that measure what escapes, at first and at most: the most have a standard error of at most 0.1 % of the power.
const FIRST_RAYS: usize = 1 << 15;
const MOST_RAYS: usize = 1 << 18;
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

/// Measures what escapes of the power of `patches`: with the first rays where these leave a standard error of
/// less than `error`, a share of the power, else with the most. Deterministic at any number of threads.
pub fn escape(
    scene: &Scene,
    hierarchy: &Hierarchy,
    embree: &CommittedScene,
    normals: &[Vec3],
    patches: &[RadiatingPatch],
    error: f64,
    seed: u64,
) -> Escape {
    let mut before = Vec::with_capacity(patches.len());
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
    let emission = Emission {
        scene,
        hierarchy,
        normals,
        patches,
        before,
        total,
        tau: scene.tau(),
        sequence: SampleSequence::new(seed),
    };
    let received = |polygon: PolygonId, side: Side| {
        // What falls on a covered side is received by those that lie with it.
        has_side[polygon.index()][usize::from(side == Side::Back)]
            || scene.contacts.is_covered(Facet { polygon, side })
    };
    let first = Shares::measure(&emission, embree, &received, FIRST_RAYS);
    let shares = if first.greatest_error() < error {
        first
    } else {
        Shares::measure(&emission, embree, &received, MOST_RAYS)
    };
    Escape {
        escaped: total * shares.escaped,
        escaped_stderr: total * shares.error_of(shares.escaped),
        swallowed: total * shares.swallowed,
    }
}

/// Shares of rays that no side receives.
struct Shares {
    rays: usize,
    escaped: f64,
    swallowed: f64,
}

impl Shares {
    fn measure(
        emission: &Emission,
        embree: &CommittedScene,
        received: &(impl Fn(PolygonId, Side) -> bool + Sync),
        rays: usize,
    ) -> Self {
        let counts: Vec<[usize; 2]> = (0..rays / BATCH)
            .into_par_iter()
            .map(|batch| {
                let cast = emission.rays(batch * BATCH, rays);
                let mut hits = Vec::with_capacity(cast.len());
                embree.closest_hits(&cast, &mut hits);
                let mut count = [0, BATCH - cast.len()];
                for (ray, hit) in cast.iter().zip(&hits) {
                    match hit {
                        None => count[0] += 1,
                        Some(hit) => {
                            let [a, b, c] = emission.scene.corners(hit.polygon);
                            let back = (b - a).cross(c - a).dot(ray.direction) > 0.0;
                            let side = if back { Side::Back } else { Side::Front };
                            count[1] += usize::from(!received(hit.polygon, side));
                        }
                    }
                }
                count
            })
            .collect();
        let share =
            |which: usize| counts.iter().map(|c| c[which]).sum::<usize>() as f64 / rays as f64;
        Self {
            rays,
            escaped: share(0),
            swallowed: share(1),
        }
    }

    /// Binomial standard error of one of the shares.
    fn error_of(&self, share: f64) -> f64 {
        (share * (1.0 - share) / self.rays as f64).sqrt()
    }

    fn greatest_error(&self) -> f64 {
        self.error_of(self.escaped)
            .max(self.error_of(self.swallowed))
    }
}

/// Patches as sources of rays, in strata of equal power.
struct Emission<'a> {
    scene: &'a Scene,
    hierarchy: &'a Hierarchy,
    normals: &'a [Vec3],
    patches: &'a [RadiatingPatch],
    /// Power of the patches before each.
    before: Vec<f64>,
    total: f64,
    tau: f32,
    sequence: SampleSequence,
}

impl Emission<'_> {
    /// Rays number `first` and on of `all`, [`BATCH`] without those that find no open place on their patch.
    fn rays(&self, first: usize, all: usize) -> Vec<Ray> {
        let power = |i: usize| (i as f64 + 0.5) / all as f64 * self.total;
        let mut at = self.before.partition_point(|&x| x <= power(first)) - 1;
        (first..first + BATCH)
            .filter_map(|i| {
                while self.before.get(at + 1).is_some_and(|&x| x <= power(i)) {
                    at += 1;
                }
                self.ray(&self.patches[at], i, all)
            })
            .collect()
    }

    fn ray(&self, patch: &RadiatingPatch, i: usize, all: usize) -> Option<Ray> {
        let facet = self.hierarchy.facets[patch.facet.index()];
        let corners = patch.path.corners(self.scene.facet_corners(facet));
        let tries = if self.scene.emission(facet) == [0.0; 3] {
            TRIES
        } else {
            1
        };
        (0..tries).find_map(|k| {
            let [u, v, s, t] = self.sequence.point((i + k * all) as u32);
            let origin = point_in(corners, u, v);
            let normal = self.normals[patch.facet.index()];
            (!self.scene.contacts.is_hidden(facet, origin))
                .then(|| cosine_ray(origin, normal, s, t, self.tau))
        })
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::fixture::{add_plate, grey, prepare, scene};

    /// From a unit square to one opposite at a distance of one: 0.1998 (Howell, C-11).
    #[test]
    fn what_escapes_is_known_to_a_thousandth_with_as_few_rays_as_that_takes() {
        let mut s = scene(vec![grey(0.0, 0.0), grey(0.0, 1.0)]);
        let half = Vec3::new(-0.5, -0.5, 0.0);
        add_plate(&mut s, half, Vec3::X, Vec3::Y, 1, 1);
        add_plate(&mut s, half + Vec3::Z, Vec3::Y, Vec3::X, 1, 0);
        let prepared = prepare(&s);
        let lamps: Vec<RadiatingPatch> = (0..prepared.hierarchy.facets.len())
            .filter(|&f| s.emission(prepared.hierarchy.facets[f]) != [0.0; 3])
            .map(|f| RadiatingPatch {
                facet: FacetId::new(f),
                path: PatchPath::ROOT,
                power: 0.5,
            })
            .collect();
        assert_eq!(lamps.len(), 2);
        let measure = |error: f64| {
            let normals = vec![Vec3::Z; prepared.hierarchy.facets.len()];
            escape(
                &s,
                &prepared.hierarchy,
                &prepared.embree,
                &normals,
                &lamps,
                error,
                7,
            )
        };
        let (coarse, fine) = (measure(0.01), measure(1.0e-3));
        for (found, rays) in [(coarse, FIRST_RAYS), (fine, MOST_RAYS)] {
            let share = 1.0 - 0.199_825;
            let error = (share * (1.0 - share) / rays as f64).sqrt();
            assert!((found.escaped_stderr / error - 1.0).abs() < 0.01);
            assert!((found.escaped - share).abs() < 4.0 * error, "{found:?}");
            assert_eq!(found.swallowed, 0.0);
        }
    }
}
