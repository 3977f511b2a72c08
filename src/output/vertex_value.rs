//! Irradiance at a vertex, from the patches around it.
//!
//! A patch's value holds at its middle. Where patches of one size surround a vertex the mean of them is what the vertex has; at
//! the border of a surface, and where sizes change, their middles lie to one side of it, and a mean would draw the slope of
//! the light as teeth. So the mean is carried to the vertex along the slope, which is a least-squares fit over the next ring of patches.

use super::SolvedMesh;
use super::incidence::{Incident, IncidentTable};
use super::panel::Panels;
use glam::{DMat2, DVec2, DVec3};

/// Cosine of the greatest angle between normals that are shaded as one surface: 25 degrees keeps
/// the edges of a 12-sided column and smooths one of 16 sides.
pub(super) const CREASE_COSINE: f64 = 0.906_307_787_036_65;

/// Irradiance, as a share of the brightest patch at a vertex, below which a patch is taken to be
/// hidden: open shadows in rooms keep more than that of indirect light, gaps behind furniture do not.
const HIDDEN: f64 = 0.05;

/// What is added to the spread of the middles, as a share of it: across a strip that is one patch wide the slope is unknown.
const RIDGE: f64 = 1.0e-3;

/// Patches that meet at a vertex, from which on its ring is left out: the hub of a fan, which every vertex of the rim would walk.
const MOST_AROUND: usize = 64;

/// What values at vertices are made of.
pub(super) struct VertexValues<'a> {
    pub mesh: &'a SolvedMesh,
    pub panels: &'a Panels,
    pub incidents: &'a IncidentTable,
    /// One a panel.
    pub normals: &'a [DVec3],
}

/// A patch as seen from a vertex.
#[derive(Clone, Copy)]
struct Sample {
    /// Its middle, from the vertex.
    offset: DVec3,
    irradiance: DVec3,
    weight: f64,
}

impl VertexValues<'_> {
    /// The irradiance at a vertex of the surface that `members` form there: within the range of theirs. A patch that
    /// is all but black beside its neighbours hides under or behind something; it counts little, so that its dark does not
    /// seep out from there.
    pub fn value<'b>(
        &self,
        vertex: usize,
        members: impl Iterator<Item = &'b Incident> + Clone,
    ) -> [f32; 3] {
        let brightest = (members.clone()).fold(0.0, |m: f64, i| {
            m.max(self.irradiance(i.leaf).element_sum())
        });
        // Where all is black this is not a number, whose minimum with 1 is 1.
        let openness = |e: DVec3| (e.element_sum() / (HIDDEN * brightest)).min(1.0);
        let here = self.panels.positions[vertex];
        let near = members.clone().map(|incident| {
            let irradiance = self.irradiance(incident.leaf);
            Sample {
                offset: self.middle(incident.leaf) - here,
                irradiance,
                weight: self.closeness(here, incident) * openness(irradiance),
            }
        });
        let (mut least, mut greatest) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for sample in near.clone().filter(|s| s.weight > 0.0) {
            least = least.min(sample.irradiance);
            greatest = greatest.max(sample.irradiance);
        }
        let Some(mean) = mean_of(near) else {
            return [0.0; 3];
        };
        if least == greatest {
            return least.as_vec3().to_array();
        }
        let normal = (members.clone())
            .map(|i| self.normal(i.leaf))
            .sum::<DVec3>()
            .normalize_or(DVec3::Z);
        let around = members.flat_map(|member| {
            let leaf = &self.panels.leaves[member.leaf as usize];
            leaf.corners
                .into_iter()
                .map(|corner| self.incidents.of(corner as usize))
                .filter(|ring| ring.len() <= MOST_AROUND)
                .flatten()
        });
        let wide = around
            .filter(|i| self.normal(i.leaf).dot(normal) >= CREASE_COSINE)
            .map(|i| {
                let (offset, irradiance) = (self.middle(i.leaf) - here, self.irradiance(i.leaf));
                let size = self.area(i.leaf) / offset.length_squared();
                Sample {
                    offset,
                    irradiance,
                    weight: if size.is_finite() { size } else { 0.0 } * openness(irradiance),
                }
            });
        let value = mean.irradiance - slope_along(wide, mean.offset, normal);
        // Neither overshoots nor light that is not there.
        value.clamp(least, greatest).as_vec3().to_array()
    }

    fn irradiance(&self, leaf: u32) -> DVec3 {
        DVec3::from(self.mesh.faces[leaf as usize].irradiance.map(f64::from))
    }

    fn normal(&self, leaf: u32) -> DVec3 {
        self.normals[self.panels.leaves[leaf as usize].panel as usize]
    }

    fn corners(&self, leaf: u32) -> [DVec3; 3] {
        (self.panels.leaves[leaf as usize].corners).map(|v| self.panels.positions[v as usize])
    }

    fn middle(&self, leaf: u32) -> DVec3 {
        let [a, b, c] = self.corners(leaf);
        (a + b + c) / 3.0
    }

    fn area(&self, leaf: u32) -> f64 {
        let [a, b, c] = self.corners(leaf);
        0.5 * (b - a).cross(c - a).length()
    }

    /// Angle of a patch at a vertex over the distance of its middle; 0 where that says nothing. Between a large patch and a
    /// small one the mean is then what a straight line between their middles has at the vertex.
    fn closeness(&self, here: DVec3, incident: &Incident) -> f64 {
        let angle = match incident.slot {
            slot @ 0..3 => {
                let corners = self.corners(incident.leaf);
                let [a, b] = [1, 2].map(|k| corners[(usize::from(slot) + k) % 3] - here);
                a.cross(b).length().atan2(a.dot(b))
            }
            _ => std::f64::consts::PI,
        };
        let weight = angle / (self.middle(incident.leaf) - here).length();
        if weight.is_finite() { weight } else { 0.0 }
    }
}

/// The weighted mean, with the sum of the weights; `None` where nothing has any.
fn mean_of(samples: impl Iterator<Item = Sample>) -> Option<Sample> {
    let mut sum = Sample {
        offset: DVec3::ZERO,
        irradiance: DVec3::ZERO,
        weight: 0.0,
    };
    for s in samples.filter(|s| s.weight > 0.0) {
        sum.offset += s.weight * s.offset;
        sum.irradiance += s.weight * s.irradiance;
        sum.weight += s.weight;
    }
    (sum.weight > 0.0).then(|| Sample {
        offset: sum.offset / sum.weight,
        irradiance: sum.irradiance / sum.weight,
        ..sum
    })
}

/// By how much irradiance grows along `step`, which is taken across `normal`: the slope of a plane fitted to `samples`.
fn slope_along(samples: impl Iterator<Item = Sample> + Clone, step: DVec3, normal: DVec3) -> DVec3 {
    let Some(mean) = mean_of(samples.clone()) else {
        return DVec3::ZERO;
    };
    let (u, v) = normal.any_orthonormal_pair();
    let flat = |p: DVec3| DVec2::new(u.dot(p), v.dot(p));
    let mut spread = DMat2::ZERO;
    let mut rise = [DVec2::ZERO; 3];
    for s in samples.filter(|s| s.weight > 0.0) {
        let at = flat(s.offset - mean.offset);
        spread += DMat2::from_cols(at * at.x, at * at.y) * s.weight;
        let above = (s.irradiance - mean.irradiance).to_array();
        for (rise, above) in rise.iter_mut().zip(above) {
            *rise += at * (above * s.weight);
        }
    }
    let ridge = RIDGE * (spread.x_axis.x + spread.y_axis.y);
    let inverse = (spread + DMat2::from_diagonal(DVec2::splat(ridge))).inverse();
    let slope = rise.map(|rise| (inverse * rise).dot(flat(step)));
    match DVec3::from(slope) {
        slope if slope.is_finite() => slope,
        _ => DVec3::ZERO,
    }
}
