//! Which sides of polygons take part in the exchange of light.
//!
//! With [`SidesMode::Auto`] a side exists once a chain of probe rays joins it to an emitting front.
//! A probe is a segment between two sides, so it counts both ways: sides are joined into groups,
//! and the groups with an emitter exist. Sides that are joined early need few probes; those that
//! remain alone get all of theirs before they are given up.

use super::facet::{Facet, Side};
use super::model::Scene;
use super::side_graph::{SideGraph, SideIndex, facet_at, side_index};
use crate::embree::{CommittedScene, Hit, Ray};
use crate::math::{PolygonId, SampleSequence, hash_u64};
use glam::Vec3;
use rayon::prelude::*;

/// Which sides receive and reflect light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SidesMode {
    /// The sides that light can reach.
    #[default]
    Auto,
    /// The side that the winding faces, of every polygon.
    One,
    /// Both, of every polygon.
    Two,
}

/// Probes of the smallest side: with 16 a side that sees lit surfaces over a fifth of its horizon
/// is missed in 3 of 100 cases by its own probes, which its neighbours then mend.
const LEAST_PROBES: u32 = 16;

/// Probes that are shared out over all sides by area, on top of [`LEAST_PROBES`]: what two dozen large
/// walls need to notice an opening of a ten-thousandth of the horizon, and 0.1 s of rays.
const PROBES_BY_AREA: f64 = 131_072.0;

/// Probes a ray batch: the work of one task, large enough to hide scheduling.
const SIDES_PER_TASK: usize = 256;

/// Steps aside of a confirming probe, in units of tau (which is as wide as the widest crack that counts as
/// closed): at least one of two perpendicular steps then leaves any crack by 2.8 tau.
const STEP_ASIDE: f32 = 4.0;

/// A side that is joined to another by a probe.
type Link = (SideIndex, SideIndex);

/// The sides of `scene` that take part, ordered by polygon, front before back. `committed` holds the
/// scene's triangles in order. A polygon neither of whose sides is reached keeps its front: it stays dark,
/// but is written out with the others. Sides that others cover wholly (see [`super::Contacts::is_covered`]) have no part in any mode.
pub fn resolve_sides(
    scene: &Scene,
    committed: &CommittedScene,
    mode: SidesMode,
    seed: u64,
) -> Vec<Facet> {
    let wanted: Vec<bool> = match mode {
        SidesMode::One => [true, false].repeat(scene.polygons.len()),
        SidesMode::Two => vec![true; 2 * scene.polygons.len()],
        SidesMode::Auto => {
            let mut lit = Flood::new(scene, committed, seed).run();
            for sides in lit.as_chunks_mut::<2>().0 {
                sides[0] |= !sides[1];
            }
            lit
        }
    };
    (0..2 * scene.polygons.len() as SideIndex)
        .filter(|&side| wanted[side as usize])
        .map(facet_at)
        .filter(|&facet| !scene.contacts.is_covered(facet))
        .collect()
}

struct Flood<'a> {
    scene: &'a Scene,
    committed: &'a CommittedScene,
    seed: u64,
    tau: f32,
    /// Front normals of polygons.
    normals: Vec<Vec3>,
    /// Probes that each side may cast in all, per polygon.
    quotas: Vec<u32>,
    graph: SideGraph,
}

impl<'a> Flood<'a> {
    fn new(scene: &'a Scene, committed: &'a CommittedScene, seed: u64) -> Self {
        let ids = || (0..scene.polygons.len()).map(PolygonId::new);
        let areas: Vec<f64> = ids().map(|id| scene.polygon_area(id)).collect();
        let both_sides: f64 = 2.0 * areas.iter().sum::<f64>();
        Self {
            scene,
            committed,
            seed,
            tau: scene.tau(),
            normals: ids().map(|id| front_normal(scene, id)).collect(),
            quotas: areas
                .iter()
                .map(|area| LEAST_PROBES + (PROBES_BY_AREA * area / both_sides) as u32)
                .collect(),
            graph: SideGraph::new(2 * scene.polygons.len()),
        }
    }

    /// For each side whether light can reach it.
    fn run(mut self) -> Vec<bool> {
        let mut emitting = (0..self.scene.polygons.len())
            .map(PolygonId::new)
            .filter(|&id| self.scene.surface(id).emission != [0.0; 3])
            .map(|id| side_index(id, Side::Front));
        let Some(light) = emitting.next() else {
            return vec![false; 2 * self.scene.polygons.len()];
        };
        // All emitters are one group: what one of them reaches exists.
        emitting.for_each(|side| self.graph.join(light, side));

        let mut cast = vec![0u32; 2 * self.scene.polygons.len()];
        // Sides that are still apart look for the light, few probes first.
        let greatest = self.quotas.iter().copied().max().unwrap_or(0);
        let mut target = 1;
        while target < 2 * greatest {
            self.round(&mut cast, light, target, false);
            target *= 2;
        }
        // Then the light looks for what is left, until nothing more is found.
        while self.round(&mut cast, light, u32::MAX, true) > 0 {}
        let light = self.graph.root(light);
        self.graph
            .roots()
            .iter()
            .map(|&root| root == light)
            .collect()
    }

    /// Sides in the light's group (or, unless `lit`, outside it) cast probes until each has cast
    /// `target` or its quota; groups that see each other are joined. Returns how many sides cast.
    fn round(&mut self, cast: &mut [u32], light: SideIndex, target: u32, lit: bool) -> usize {
        let roots = self.graph.roots();
        let light = roots[light as usize];
        let quota = |side: SideIndex| self.quotas[side as usize / 2].min(target);
        let active: Vec<SideIndex> = (0..cast.len() as SideIndex)
            .filter(|&side| {
                (roots[side as usize] == light) == lit && cast[side as usize] < quota(side)
            })
            .collect();
        let links: Vec<Vec<Link>> = active
            .par_chunks(SIDES_PER_TASK)
            .map(|sides| {
                let mut probes = Probes::default();
                for &side in sides {
                    for index in cast[side as usize]..quota(side) {
                        self.aim(side, index, &mut probes);
                    }
                }
                self.links(&probes, &roots)
            })
            .collect();
        for &side in &active {
            cast[side as usize] = quota(side);
        }
        for (a, b) in links.into_iter().flatten() {
            self.graph.join(a, b);
        }
        active.len()
    }

    /// Adds probe number `index` of a side, unless it would start beyond the side's own border.
    fn aim(&self, side: SideIndex, index: u32, probes: &mut Probes) {
        let facet = facet_at(side);
        let key = hash_u64(self.seed ^ hash_u64(u64::from(side)));
        let [s, t, u, v] = SampleSequence::new(key).point(index);
        // Uniform over the triangle (Turk 1990).
        let root = s.sqrt();
        let weights = [1.0 - root, root * (1.0 - t), root * t];
        let [a, b, c] = self.scene.corners(facet.polygon);
        let origin = a * weights[0] + b * weights[1] + c * weights[2];
        let normal = match facet.side {
            Side::Front => self.normals[facet.polygon.index()],
            Side::Back => -self.normals[facet.polygon.index()],
        };
        // Cosine-distributed about the normal.
        let (tangent, bitangent) = normal.any_orthonormal_pair();
        let (sine, cosine) = (u.sqrt(), (1.0 - u).sqrt());
        let around = Vec3::from_array([
            (v * std::f32::consts::TAU).cos(),
            (v * std::f32::consts::TAU).sin(),
            0.0,
        ]);
        let sideways = tangent * around.x + bitangent * around.y;
        let direction = sideways * sine + normal * cosine;
        // The probe leaves its plane by tau at tau / cosine. Were that, or a step aside, beyond the
        // border of the triangle, it might start behind a neighbour.
        let doubled_area = (b - a).cross(c - a).length();
        let edges = [(c - b).length(), (a - c).length(), (b - a).length()];
        let inside = (0..3)
            .map(|i| weights[i] * doubled_area / edges[i])
            .fold(f32::INFINITY, f32::min);
        if inside * cosine > (1.0 + STEP_ASIDE) * self.tau
            && !self.scene.contacts.is_hidden(facet, origin)
        {
            probes.sides.push(side);
            probes
                .rays
                .push(Ray::half_line(origin, direction, self.tau / cosine));
            probes.asides.push([
                sideways * (STEP_ASIDE * self.tau / cosine),
                normal.cross(sideways) * (STEP_ASIDE * self.tau),
            ]);
        }
    }

    /// The sides that probes join, of those that are not joined in `roots`. Both of two probes a step
    /// aside must meet the same side or its group, or the first has slipped through a crack.
    fn links(&self, probes: &Probes, roots: &[SideIndex]) -> Vec<Link> {
        let mut hits = Vec::new();
        self.committed.closest_hits(&probes.rays, &mut hits);
        let mut links = Vec::new();
        let mut confirming = Vec::new();
        for (i, hit) in hits.iter().enumerate() {
            let Some(hit) = hit else { continue };
            let (from, to) = (probes.sides[i], self.side_hit(&probes.rays[i], hit));
            // Under a solid's foot the side is met from the solid's inside.
            let point = probes.rays[i].origin + probes.rays[i].direction * hit.t;
            if roots[from as usize] != roots[to as usize]
                && !self.scene.contacts.is_hidden(facet_at(to), point)
            {
                links.push((from, to));
                confirming.extend(probes.asides[i].map(|step| Ray {
                    origin: probes.rays[i].origin + step,
                    ..probes.rays[i]
                }));
            }
        }
        self.committed.closest_hits(&confirming, &mut hits);
        let mut next = 0;
        links.retain(|&(_, to)| {
            let pair = next..next + 2;
            next += 2;
            pair.into_iter().all(|k| {
                hits[k].as_ref().is_some_and(|hit| {
                    let met = self.side_hit(&confirming[k], hit);
                    met == to || roots[met as usize] == roots[to as usize]
                })
            })
        });
        links
    }

    fn side_hit(&self, ray: &Ray, hit: &Hit) -> SideIndex {
        let facing = self.normals[hit.polygon.index()].dot(ray.direction);
        let side = if facing < 0.0 {
            Side::Front
        } else {
            Side::Back
        };
        side_index(hit.polygon, side)
    }
}

/// Probes with the sides that cast them and two steps aside, in the side's plane, to confirm them by.
#[derive(Default)]
struct Probes {
    sides: Vec<SideIndex>,
    rays: Vec<Ray>,
    asides: Vec<[Vec3; 2]>,
}

/// Unit normal of the front, computed in f64, which slivers need.
fn front_normal(scene: &Scene, id: PolygonId) -> Vec3 {
    let [a, b, c] = scene.corners(id).map(Vec3::as_dvec3);
    (b - a).cross(c - a).normalize_or_zero().as_vec3()
}
