//! A scene made ready for paths: which sides exist, what they reflect and emit, and where a ray lands.

use super::weighted_choice::WeightedChoice;
use crate::embree::{
    AllHitsScene, CommittedScene, Device, DeviceConfig, EmbreeError, EmbreeVersion, Hit, Ray,
};
use crate::math::PolygonId;
use crate::scene::{Facet, Scene, Side, SidesMode, find_overlaps, resolve_sides};
use glam::Vec3;

/// A scene that paths can be traced in.
pub struct TracedScene {
    /// The scene.
    pub scene: Scene,
    /// Version of the Embree that answers.
    pub embree_version: EmbreeVersion,
    /// The sides that take part, exactly those of a solve; ordered by polygon, front before back.
    pub facets: Vec<Facet>,
    pub(super) embree: CommittedScene,
    /// Where polygons lie on one another: finds the one that owns the place.
    layers: Option<Layers>,
    /// By polygon, front then back.
    exists: Vec<[bool; 2]>,
    /// Unit normals of fronts.
    normals: Vec<Vec3>,
    /// The polygons whose fronts emit.
    emitters: Vec<PolygonId>,
    /// Chooses among them by power.
    by_power: WeightedChoice,
    pub(super) tau: f32,
}

/// Polygons on one another.
struct Layers {
    all_hits: AllHitsScene,
    /// Whether some side is covered in part by others, so that every landing is looked at.
    everywhere: bool,
}

/// A point on a side, as paths meet it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Vertex {
    pub position: Vec3,
    /// Unit normal on the side's side.
    pub normal: Vec3,
    pub facet: Facet,
}

impl TracedScene {
    /// Builds what tracing needs. `sides` and `seed` give the sides that a solve with them has.
    ///
    /// # Errors
    /// Embree's, such as no memory or too old a version.
    pub fn new(
        scene: Scene,
        sides: SidesMode,
        seed: u64,
        device: &DeviceConfig,
    ) -> Result<Self, EmbreeError> {
        let device = Device::new(device)?;
        let triangles: Vec<[u32; 3]> = scene.polygons.iter().map(|p| p.vertices).collect();
        let embree = CommittedScene::build(&device, &scene.positions, &triangles)?;
        let facets = resolve_sides(&scene, &embree, sides, seed);
        let overlaps = find_overlaps(&scene);
        let ids = || (0..scene.polygons.len()).map(PolygonId::new);
        let covered = ids().any(|polygon| {
            [Side::Front, Side::Back]
                .into_iter()
                .any(|side| overlaps.is_covered(Facet { polygon, side }))
        });
        let everywhere = overlaps.partly_covered_fronts > 0;
        let layers = (covered || everywhere)
            .then(|| AllHitsScene::build(&device, &scene.positions, &triangles))
            .transpose()?
            .map(|all_hits| Layers {
                all_hits,
                everywhere,
            });
        let mut exists = vec![[false; 2]; scene.polygons.len()];
        for facet in &facets {
            exists[facet.polygon.index()][usize::from(facet.side == Side::Back)] = true;
        }
        let normals = ids().map(|id| front_normal(&scene, id)).collect();
        let emitters: Vec<PolygonId> = ids()
            .filter(|id| exists[id.index()][0] && scene.surface(*id).emission != [0.0; 3])
            .collect();
        let by_power = WeightedChoice::new(
            emitters
                .iter()
                .map(|&id| mean(scene.surface(id).emission) * scene.polygon_area(id)),
        );
        Ok(Self {
            tau: scene.tau(),
            embree_version: device.version(),
            scene,
            facets,
            embree,
            layers,
            exists,
            normals,
            emitters,
            by_power,
        })
    }

    /// The point at `(u, v)` in [0, 1)^2 of a side, uniform by area.
    pub(super) fn point_on(&self, facet: Facet, u: f64, v: f64) -> Vertex {
        let [a, b, c] = self.scene.corners(facet.polygon).map(Vec3::as_dvec3);
        // Uniform over the triangle (Turk 1990).
        let root = u.sqrt();
        let point = a * (1.0 - root) + b * (root * (1.0 - v)) + c * (root * v);
        Vertex {
            position: point.as_vec3(),
            normal: self.normal(facet),
            facet,
        }
    }

    fn normal(&self, facet: Facet) -> Vec3 {
        let front = self.normals[facet.polygon.index()];
        match facet.side {
            Side::Front => front,
            Side::Back => -front,
        }
    }

    /// A point of an emitter, emitters by power and points by area; `None` where nothing shines.
    pub(super) fn point_of_light(&self, u: f64, v: f64) -> Option<Vertex> {
        if self.by_power.total() <= 0.0 {
            return None;
        }
        let (index, u) = self.by_power.choose(u);
        let facet = Facet {
            polygon: self.emitters[index],
            side: Side::Front,
        };
        Some(self.point_on(facet, u, v))
    }

    /// Density by area with which [`Self::point_of_light`] gives points of a side.
    pub(super) fn light_density(&self, facet: Facet) -> f64 {
        mean(self.scene.emission(facet)) / self.by_power.total()
    }

    /// Where `ray` has landed, `hit` being its nearest hit: `None` on a side that does not exist, which
    /// is opaque and black, or where a solid stands.
    ///
    /// Of polygons within tau of each other Embree may report any. The owner is the one that the
    /// scene's overlaps name: emitters first, then fronts, then the lower index.
    pub(super) fn landing(&self, ray: &Ray, hit: &Hit) -> Option<Vertex> {
        let own = self.side_met(hit.polygon, ray.direction);
        // By barycentric weights the point lies in its plane to the last bit; any layer's will do.
        let [a, b, c] = self.scene.corners(hit.polygon);
        let position = a * (1.0 - hit.u - hit.v) + b * hit.u + c * hit.v;
        let shows = |facet: Facet| {
            self.facet_exists(facet) && !self.scene.contacts.is_hidden(facet, position)
        };
        let own_shows = shows(own);
        let owner = match &self.layers {
            Some(layers) if layers.everywhere || !own_shows => {
                let depth = self.normals[hit.polygon.index()].dot(ray.direction).abs();
                let reach = Ray {
                    tfar: hit.t + self.tau / depth.max(f32::MIN_POSITIVE),
                    ..*ray
                };
                let mut owner: Option<Facet> = None;
                layers.all_hits.for_each_hit(&reach, |other| {
                    let met = self.side_met(other.polygon, ray.direction);
                    let first = |f: Facet| {
                        let dark = self.scene.emission(f) == [0.0; 3];
                        (dark, f.side, f.polygon)
                    };
                    if shows(met) && owner.is_none_or(|o| first(met) < first(o)) {
                        owner = Some(met);
                    }
                });
                owner.or(own_shows.then_some(own))?
            }
            _ if own_shows => own,
            _ => return None,
        };
        Some(Vertex {
            position,
            normal: self.normal(owner),
            facet: owner,
        })
    }

    /// Whether a solid stands on a point, or another side owns it: there is no light.
    pub(super) fn is_hidden(&self, at: &Vertex) -> bool {
        self.scene.contacts.is_hidden(at.facet, at.position)
    }

    fn side_met(&self, polygon: PolygonId, direction: Vec3) -> Facet {
        let side = if self.normals[polygon.index()].dot(direction) < 0.0 {
            Side::Front
        } else {
            Side::Back
        };
        Facet { polygon, side }
    }

    /// Whether a side takes part.
    pub(super) fn facet_exists(&self, facet: Facet) -> bool {
        self.exists[facet.polygon.index()][usize::from(facet.side == Side::Back)]
    }
}

/// Unit normal of the front, computed in f64, which slivers need.
fn front_normal(scene: &Scene, id: PolygonId) -> Vec3 {
    let [a, b, c] = scene.corners(id).map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or_zero().as_vec3()
}

/// Mean of the channels.
fn mean(colour: [f64; 3]) -> f64 {
    colour.iter().sum::<f64>() / 3.0
}
