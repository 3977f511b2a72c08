//! Final gathering: the irradiance under a pixel by rays from there, in place of the patches' own.
//!
//! Each sample of a pixel casts one cosine-distributed ray, which brings the solution's radiosity
//! from where it lands, and looks at one point of an emitter. Light that comes straight from
//! emitters is counted by both, joined by the power heuristic (Veach 1997, section 9.2.4): points of
//! emitters alone have no finite variance where a surface touches a lamp, rays alone are noise
//! where lamps are small, and the balance heuristic would let some of that noise in. So shadows and contact are as sharp as the geometry, whatever the mesh.
//!
//! Rays are trimmed as in a solve: nothing within a depth of tau below either end blocks.

use super::Pixel;
use super::camera::PinHole;
use super::emitters::{Choice, Emitters};
use super::view::{Landing, View, ViewConfig};
use crate::embree::{Hit, Ray};
use crate::math::{ScrambledPairs, hash_u64};
use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};
use std::sync::atomic::{AtomicBool, Ordering};

/// Depth below a surface within which nothing blocks: 1e-6 of the scene's diagonal, as in a solve.
const TRIM: f64 = 1.0e-6;

/// Least cosine at either end for light to pass; flatter rays carry a millionth of a hemisphere, and
/// trimming would let them slip under edges.
const LEAST_COSINE: f32 = 1.0e-3;

/// A picture being gathered.
pub(super) struct Gathering<'v, 'm> {
    view: &'v View<'m>,
    camera: &'v PinHole,
    config: &'v ViewConfig,
    emitters: Emitters,
    tau: f32,
}

/// A sample's place.
struct Place {
    landing: Landing,
    /// In the file's units.
    position: DVec3,
    /// In the units of the rays.
    at: Vec3,
    normal: Vec3,
}

/// What a sample finds.
struct Found {
    place: Place,
    irradiance: [f64; 3],
}

/// Memory that the pixels of a row share.
#[derive(Default)]
struct Buffers {
    rays: Vec<Ray>,
    hits: Vec<Option<Hit>>,
    found: Vec<Found>,
    shadow_rays: Vec<Ray>,
    /// What each shadow ray brings to which sample, if nothing blocks it.
    promised: Vec<(usize, [f64; 3])>,
    choice: Choice,
}

impl<'v, 'm> Gathering<'v, 'm> {
    pub fn new(view: &'v View<'m>, camera: &'v PinHole, config: &'v ViewConfig) -> Self {
        let (least, greatest) = view.bounds();
        Self {
            emitters: Emitters::new(view.mesh, &view.panels, &view.reflectance, &view.frame),
            tau: (TRIM * (greatest - least).length()) as f32,
            view,
            camera,
            config,
        }
    }

    pub fn render_row(&self, y: usize, row: &mut [Pixel], interrupted: &AtomicBool) {
        let mut buffers = Buffers::default();
        for (x, pixel) in row.iter_mut().enumerate() {
            if interrupted.load(Ordering::Relaxed) {
                return;
            }
            self.render_pixel([x, y], pixel, &mut buffers);
        }
    }

    fn render_pixel(&self, [x, y]: [usize; 2], pixel: &mut Pixel, buffers: &mut Buffers) {
        let count = self.config.gather;
        // Of the pixel alone: the same picture at any number of threads.
        let key = hash_u64(((y as u64) << 32) | x as u64);
        let [places, directions, lights] =
            [0, 1, 2].map(|use_| ScrambledPairs::new(hash_u64(key ^ use_)));
        buffers.rays.clear();
        buffers.rays.extend((0..count).map(|k| {
            let [u, v] = places.point(k).map(f64::from);
            self.view.ray(self.camera, x as f64 + u, y as f64 + v)
        }));
        self.view
            .embree
            .closest_hits(&buffers.rays, &mut buffers.hits);
        buffers.found.clear();
        buffers.rays.clear();
        buffers.shadow_rays.clear();
        buffers.promised.clear();
        let mut covered = 0u32;
        for (k, hit) in (0..count).zip(&buffers.hits) {
            let Some(hit) = hit else { continue };
            covered += 1;
            let Some(landing) = self.view.landing(hit, self.camera.eye()) else {
                continue;
            };
            let place = self.place(landing);
            if buffers.found.is_empty() {
                let choice = &mut buffers.choice;
                self.emitters.choose_for(place.at, place.normal, choice);
            }
            let [s, t] = directions.point(k);
            buffers.rays.push(self.cosine_ray(&place, s, t));
            let point = lights.point(k);
            if let Some((light, ray)) = self.light_by_point(&place, &buffers.choice, point) {
                buffers.shadow_rays.push(ray);
                buffers.promised.push((buffers.found.len(), light));
            }
            buffers.found.push(Found {
                place,
                irradiance: [0.0; 3],
            });
        }
        let blocked = self.view.embree.occluded_many(&buffers.shadow_rays);
        for (&(sample, light), blocked) in buffers.promised.iter().zip(blocked) {
            if !blocked {
                add(&mut buffers.found[sample].irradiance, light);
            }
        }
        self.view
            .embree
            .closest_hits(&buffers.rays, &mut buffers.hits);
        for ((found, ray), hit) in buffers
            .found
            .iter_mut()
            .zip(&buffers.rays)
            .zip(&buffers.hits)
        {
            if let Some(hit) = hit {
                let light = self.light_by_ray(&found.place, ray, hit, &buffers.choice);
                add(&mut found.irradiance, light);
            }
        }
        self.develop(pixel, &buffers.found, covered);
    }

    /// The mean of the samples, as radiance and irradiance.
    fn develop(&self, pixel: &mut Pixel, found: &[Found], covered: u32) {
        let share = 1.0 / f64::from(self.config.gather);
        let (mut radiosity, mut irradiance) = ([0.0; 3], [0.0; 3]);
        for Found {
            place,
            irradiance: gathered,
        } in found
        {
            let face = &self.view.mesh.faces[place.landing.leaf];
            let reflectance = self.view.reflectance[place.landing.panel];
            for c in 0..3 {
                // The patch's own, with its share of irradiance exchanged for what was gathered.
                let more = gathered[c] - f64::from(face.irradiance[c]);
                radiosity[c] +=
                    share * (f64::from(face.radiosity[c]) + f64::from(reflectance[c]) * more);
                irradiance[c] += share * gathered[c];
            }
        }
        pixel.radiance = radiosity.map(|b| (b.max(0.0) / PI) as f32);
        pixel.irradiance = irradiance.map(|e| e as f32);
        pixel.alpha = (f64::from(covered) * share) as f32;
    }

    fn place(&self, landing: Landing) -> Place {
        let panels = &self.view.panels;
        let panel = &panels.panels[landing.panel];
        let position = (panel.corners.iter().zip(landing.weights))
            .map(|(&v, w)| panels.positions[v as usize] * w)
            .sum();
        Place {
            position,
            at: self.view.frame.point(position),
            normal: panels.normal(panel).as_vec3(),
            landing,
        }
    }

    /// The ray in a cosine-distributed direction of unit length.
    fn cosine_ray(&self, place: &Place, s: f32, t: f32) -> Ray {
        let (tangent, bitangent) = place.normal.any_orthonormal_pair();
        let radius = s.sqrt();
        let (sine, cosine) = (TAU * f64::from(t)).sin_cos();
        let height = (1.0 - s).sqrt().max(LEAST_COSINE);
        let direction = tangent * (radius * cosine as f32)
            + bitangent * (radius * sine as f32)
            + place.normal * height;
        Ray::half_line(place.at, direction, self.tau / height)
    }

    /// Irradiance from a point of an emitter, weighted against the sample's own ray, and the ray that
    /// must be clear. `None` where none can arrive.
    fn light_by_point(
        &self,
        place: &Place,
        choice: &Choice,
        [u, v]: [f32; 2],
    ) -> Option<([f64; 3], Ray)> {
        let (chosen, u) = choice.choose(f64::from(u))?;
        let emitter = &self.emitters.emitters[chosen];
        // Uniform over the triangle (Turk 1990).
        let root = u.sqrt() as f32;
        let [a, b, c] = emitter.corners;
        let point = a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v);
        let direction = point - place.at;
        let depths = [place.normal.dot(direction), -emitter.normal.dot(direction)];
        let r2 = f64::from(direction.length_squared());
        let least = LEAST_COSINE * r2.sqrt() as f32;
        if depths.iter().any(|&depth| depth <= least) {
            return None;
        }
        let (near, far) = (self.tau / depths[0], 1.0 - self.tau / depths[1]);
        let kernel = f64::from(depths[0]) * f64::from(depths[1]) / (PI * r2 * r2);
        // Closer than it can be trimmed: the sample's own ray finds it.
        if near >= far || !(kernel > 0.0 && kernel.is_finite()) {
            return None;
        }
        // Densities by area of the two ways here; squared they are the weights.
        let by_point = choice.chance(chosen) / emitter.area;
        let share = by_point * kernel / (by_point * by_point + kernel * kernel);
        let ray = Ray {
            origin: place.at,
            tnear: near,
            direction,
            tfar: far,
        };
        Some((emitter.emitted.map(|b| b * share), ray))
    }

    /// What the sample's own ray brings: all that is reflected where it lands, and its share of what
    /// is emitted there.
    fn light_by_ray(&self, place: &Place, ray: &Ray, hit: &Hit, choice: &Choice) -> [f64; 3] {
        let Some(landing) = self.view.landing(hit, place.position) else {
            return [0.0; 3];
        };
        let seen = self.view.light_at(&landing, self.config.shading);
        let radiosity = seen.radiosity.map(f64::from);
        let Some(index) = self.emitters.of_panel(landing.panel) else {
            return radiosity;
        };
        let emitter = &self.emitters.emitters[index];
        let cosines = [
            place.normal.dot(ray.direction),
            -emitter.normal.dot(ray.direction),
        ];
        let r2 = f64::from(hit.t) * f64::from(hit.t) * f64::from(ray.direction.length_squared());
        // What no point of the emitter could have brought here counts whole.
        let weight = if cosines.iter().any(|&c| c <= LEAST_COSINE) {
            1.0
        } else {
            let by_ray = f64::from(cosines[0]) * f64::from(cosines[1]) / (PI * r2);
            let by_point = choice.chance(index) / emitter.area;
            by_ray * by_ray / (by_ray * by_ray + by_point * by_point)
        };
        std::array::from_fn(|c| radiosity[c] + (weight - 1.0) * emitter.emitted[c])
    }
}

fn add(sum: &mut [f64; 3], light: [f64; 3]) {
    for (sum, x) in sum.iter_mut().zip(light) {
        *sum += x;
    }
}
