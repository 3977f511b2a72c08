//! Paths from a source face: an unbiased estimate of its irradiance (Kajiya 1986), in batches whose paths
//! run side by side.
//!
//! Points are uniform by area, directions cosine-distributed. Light that arrives straight from emitters is
//! counted by two strategies, rays towards a point of an emitter (chosen by power) and the path's own
//! ray, joined by the balance heuristic (Veach 1997, chapter 9). Towards emitters alone would have no
//! finite variance where an emitter touches the face; each sample of the two together is at most the
//! brightest radiance. Paths end by Russian roulette on reflectance.
//!
//! The first point, direction and point of light of a batch's paths are low-discrepancy points with a shift
//! of the batch's own, so batches are independent, and each is unbiased.
//!
//! Rays are trimmed as in a solve (design, section 3): nothing within a depth of tau below either end blocks,
//! and what leaves or lands flatter than a cosine of 1e-3 carries no light, a millionth of a
//! hemisphere.

use super::random::{Random, key_of};
use super::source_side::SourceSide;
use super::traced_scene::{TracedScene, Vertex};
use crate::embree::{Hit, Ray};
use crate::math::SampleSequence;
use std::f64::consts::PI;

/// Paths of a batch: the low-discrepancy points gain from more, the error bars from more batches.
pub(super) const PATHS: usize = 32;

/// Least cosine at either end for light to pass; that of sampled visibility, for the same reason: a flatter
/// ray is trimmed by more than a thousand tau, far enough to slip under a wall's edge.
const LEAST_COSINE: f64 = 1.0e-3;

/// A path on its way.
struct Path {
    /// Which of the batch.
    index: usize,
    at: Vertex,
    /// Share of the light at `at` that reaches the face.
    throughput: [f64; 3],
    random: Random,
    /// Ray to the next vertex, and its cosine.
    ray: Ray,
}

/// Memory that batches of one task share.
#[derive(Default)]
pub(super) struct Scratch {
    paths: Vec<Path>,
    shadow_rays: Vec<Ray>,
    /// What each shadow ray brings, and to which path of the batch, if nothing blocks it.
    promised: Vec<(usize, [f64; 3])>,
    rays: Vec<Ray>,
    hits: Vec<Option<Hit>>,
}

/// What a batch says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Batch {
    /// Mean irradiance of its points, in W/m2.
    pub irradiance: [f64; 3],
    /// Rays cast.
    pub rays: u64,
}

/// Traces one batch. `key` names it: (seed, face, side, batch). `interrupted` ends it early, with no
/// meaning in its result.
pub(super) fn trace_batch(
    traced: &TracedScene,
    subject: &SourceSide,
    key: u64,
    scratch: &mut Scratch,
    interrupted: &dyn Fn() -> bool,
) -> Batch {
    let mut batch = Batch::default();
    let starts = SampleSequence::new(key_of(&[key, 0]));
    let lights = SampleSequence::new(key_of(&[key, 1]));
    scratch.paths.clear();
    for index in 0..PATHS {
        let [u, v, s, t] = starts.point(index as u32);
        let mut random = Random::new(key_of(&[key, 2, index as u64]));
        let u = random.refine(u);
        let (facet, u) = subject.by_area.choose(u);
        let at = traced.point_on(subject.facets[facet], u, random.refine(v));
        if traced.is_hidden(&at) {
            continue;
        }
        let ray = cosine_ray(&at, random.refine(s), random.refine(t), traced.tau);
        scratch.paths.push(Path {
            index,
            at,
            throughput: [1.0; 3],
            random,
            ray,
        });
    }
    let mut first = true;
    while !scratch.paths.is_empty() && !interrupted() {
        scratch.shadow_rays.clear();
        scratch.promised.clear();
        for path in &mut scratch.paths {
            let random = &mut path.random;
            let [u, v] = if first {
                let [u, v, ..] = lights.point(path.index as u32);
                [u, v].map(|x| random.refine(x))
            } else {
                [random.next(), random.next()]
            };
            let Some((light, ray)) = light_by_point(traced, path, u, v) else {
                continue;
            };
            match ray {
                Some(ray) => {
                    scratch.shadow_rays.push(ray);
                    scratch.promised.push((path.index, light));
                }
                None => add(&mut batch.irradiance, light),
            }
        }
        first = false;
        batch.rays += scratch.shadow_rays.len() as u64;
        let blocked = traced.embree.occluded_many(&scratch.shadow_rays);
        for ((_, light), blocked) in scratch.promised.iter().zip(blocked) {
            if !blocked {
                add(&mut batch.irradiance, *light);
            }
        }
        scratch.rays.clear();
        scratch.rays.extend(scratch.paths.iter().map(|p| p.ray));
        batch.rays += scratch.rays.len() as u64;
        traced.embree.closest_hits(&scratch.rays, &mut scratch.hits);
        let mut hits = scratch.hits.iter();
        let irradiance = &mut batch.irradiance;
        scratch.paths.retain_mut(|path| {
            let hit = hits.next().and_then(Option::as_ref);
            hit.is_some_and(|hit| advance(traced, path, hit, irradiance))
        });
    }
    batch.irradiance = batch.irradiance.map(|e| e / PATHS as f64);
    batch
}

/// Irradiance at the path's vertex from a point of an emitter, seen from the face, weighted against
/// the path's own ray; with the ray that must be clear, if any. `None` where none arrives.
fn light_by_point(
    traced: &TracedScene,
    path: &Path,
    u: f64,
    v: f64,
) -> Option<([f64; 3], Option<Ray>)> {
    let light = traced.point_of_light(u, v)?;
    if traced.is_hidden(&light) {
        return None;
    }
    let direction = light.position - path.at.position;
    let depth_from = path.at.normal.dot(direction);
    let depth_to = -light.normal.dot(direction);
    let r2 = f64::from(direction.length_squared());
    let least = (LEAST_COSINE * r2.sqrt()) as f32;
    if depth_from <= least || depth_to <= least {
        return None;
    }
    let kernel = f64::from(depth_from) * f64::from(depth_to) / (r2 * r2);
    if !(kernel > 0.0 && kernel.is_finite()) {
        return None;
    }
    let emitted = traced.scene.emission(light.facet);
    let density = traced.light_density(light.facet);
    // The balance heuristic divides by the sum of both densities by area.
    let share = kernel / (density + kernel / PI);
    let arriving = std::array::from_fn(|c| path.throughput[c] * emitted[c] * share);
    let (near, far) = (traced.tau / depth_from, 1.0 - traced.tau / depth_to);
    let ray = (near < far).then_some(Ray {
        origin: path.at.position,
        tnear: near,
        direction,
        tfar: far,
    });
    Some((arriving, ray))
}

/// Takes the path to where its ray has landed: adds the light that shines there, and says whether the
/// path goes on.
fn advance(traced: &TracedScene, path: &mut Path, hit: &Hit, irradiance: &mut [f64; 3]) -> bool {
    let Some(next) = traced.landing(&path.ray, hit) else {
        return false;
    };
    // The direction has unit length.
    let cos_from = f64::from(path.at.normal.dot(path.ray.direction));
    let cos_to = -f64::from(next.normal.dot(path.ray.direction));
    if cos_from <= LEAST_COSINE || cos_to <= LEAST_COSINE {
        return false;
    }
    let emitted = traced.scene.emission(next.facet);
    if emitted != [0.0; 3] {
        let r2 = f64::from(hit.t) * f64::from(hit.t);
        let by_direction = cos_from * cos_to / (PI * r2);
        let weight = by_direction / (by_direction + traced.light_density(next.facet));
        let arriving = std::array::from_fn(|c| PI * path.throughput[c] * emitted[c] * weight);
        add(irradiance, arriving);
    }
    let reflectance = traced.scene.surface(next.facet.polygon).reflectance;
    let survival = reflectance.into_iter().fold(0.0, f64::max);
    if path.random.next() >= survival {
        return false;
    }
    for (share, reflected) in path.throughput.iter_mut().zip(reflectance) {
        *share *= reflected / survival;
    }
    path.at = next;
    let (s, t) = (path.random.next(), path.random.next());
    path.ray = cosine_ray(&path.at, s, t, traced.tau);
    true
}

/// The ray in a cosine-distributed direction of unit length, from where it is tau above the surface.
fn cosine_ray(at: &Vertex, s: f64, t: f64, tau: f32) -> Ray {
    let (tangent, bitangent) = at.normal.any_orthonormal_pair();
    let radius = s.sqrt();
    let (sine, cosine) = (std::f64::consts::TAU * t).sin_cos();
    // A flatter ray carries no light; the bound keeps tnear finite.
    let height = (1.0 - s).sqrt().max(0.5 * LEAST_COSINE) as f32;
    let direction = tangent * (radius * cosine) as f32
        + bitangent * (radius * sine) as f32
        + at.normal * height;
    Ray::half_line(at.position, direction, tau / height)
}

fn add(sum: &mut [f64; 3], light: [f64; 3]) {
    for (sum, x) in sum.iter_mut().zip(light) {
        *sum += x;
    }
}
