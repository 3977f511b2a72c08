//! Elements as surfaces to sample: receivers uniformly by area, sources by the power that they have to shoot.
//!
//! Light and visibility go together (the lit part of a floor is the part that is not under the
//! furniture), so a visibility averaged over a source's area would be too low for its light.

use super::element::{Element, Shape};
use super::facet_choice::{choose_facets, choose_parts};
use super::facet_frame::FacetFrame;
use super::patch_split::{folded, lit_point, lit_points};
use super::radiosity::Shooter;
use crate::cluster::Hierarchy;
use crate::scene::{Facet, Scene};
use crate::visibility::{PointOctet, Surface, children_of_triangle};

/// A receiver.
pub struct ReceiverSurface<'a> {
    /// The element.
    pub element: &'a Element,
    /// Its scene.
    pub scene: &'a Scene,
    /// Its hierarchy.
    pub hierarchy: &'a Hierarchy,
    /// Where points on its facets lie.
    pub frames: &'a [FacetFrame],
    /// Sums of the areas before each facet.
    pub area_before: &'a [f64],
    /// First facets of all parts of a cluster but the first.
    pub parts: &'a [u32],
}

impl Surface for ReceiverSurface<'_> {
    #[inline(always)]
    fn points(&self, u: &[f32; 8], v: &[f32; 8], lanes: u32) -> PointOctet {
        let normal = self.element.normal;
        if let Shape::Triangle(corners) = self.element.shape {
            let mut points = PointOctet::of_triangle(corners, normal, u, v);
            let facet = self.hierarchy.facets[self.element.first_facet as usize];
            if self.scene.contacts.touches(facet, &self.element.bounds) {
                for l in 0..8 {
                    let hidden = self.scene.contacts.is_hidden(facet, points.position(l));
                    points.swallowed |= u8::from(hidden) << l;
                }
            }
            return points;
        }
        self.cluster_points(u, v, lanes)
    }

    #[inline(never)]
    fn parts(&self, u: &[f32; 8], v: &[f32; 8]) -> [u8; 8] {
        if self.element.is_triangle() {
            return children_of_triangle(u, v);
        }
        choose_parts(&self.element.facet_range(), self.area_before, self.parts, u)
    }
}

impl ReceiverSurface<'_> {
    #[inline(never)]
    fn cluster_points(&self, u: &[f32; 8], v: &[f32; 8], lanes: u32) -> PointOctet {
        let (centroid, normal) = (self.element.centroid, self.element.normal);
        let mut points = PointOctet::of_triangle([centroid; 3], normal, u, v);
        let range = self.element.facet_range();
        let (facets, rests) = choose_facets(&range, self.area_before, u, lanes);
        for l in 0..lanes as usize {
            let (frame, rest) = (&self.frames[facets[l]], rests[l]);
            points.set(l, frame.at(folded([rest, v[l]])), frame.normal);
            let hidden = frame.is_touched
                && self
                    .scene
                    .contacts
                    .is_hidden(frame.facet, points.position(l));
            points.swallowed |= u8::from(hidden) << l;
        }
        points
    }
}

/// A source.
pub struct SourceSurface<'a, const C: usize> {
    /// The element.
    pub element: &'a Element,
    /// Its scene.
    pub scene: &'a Scene,
    /// Its hierarchy.
    pub hierarchy: &'a Hierarchy,
    /// Where points on its facets lie.
    pub frames: &'a [FacetFrame],
    /// Sums of the unshot power before each facet.
    pub power_before: &'a [f64],
    /// What every owner's patches have to shoot.
    pub shooters: &'a [Shooter<C>],
    /// Whether each facet's light is even.
    pub is_even: &'a [bool],
    /// Owner of each facet.
    pub owner_of_facet: &'a [u32],
    /// First facet of each owner.
    pub first_facets: &'a [u32],
    /// Owner of a triangle.
    pub owner: u32,
    /// Frozen patch of a triangle.
    pub slot: u32,
}

impl<const C: usize> Surface for SourceSurface<'_, C> {
    #[inline(always)]
    fn points(&self, u: &[f32; 8], v: &[f32; 8], lanes: u32) -> PointOctet {
        let normal = self.element.normal;
        if let Shape::Triangle(corners) = self.element.shape {
            let shooter = &self.shooters[self.owner as usize];
            let mut points = match shooter.splits[self.slot as usize].is_even() {
                true => PointOctet::of_triangle(corners, normal, u, v),
                false => {
                    let [along, across] = lit_points(&shooter.splits, self.slot, u, v);
                    PointOctet::at(corners, normal, &along, &across)
                }
            };
            let facet = self.hierarchy.facets[self.element.first_facet as usize];
            if self.scene.contacts.touches(facet, &self.element.bounds) {
                (0..8).for_each(|l| self.hide(&mut points, l, facet));
            }
            return points;
        }
        self.cluster_points(u, v, lanes)
    }
}

impl<const C: usize> SourceSurface<'_, C> {
    #[inline(never)]
    fn cluster_points(&self, u: &[f32; 8], v: &[f32; 8], lanes: u32) -> PointOctet {
        let (centroid, normal) = (self.element.centroid, self.element.normal);
        let mut points = PointOctet::of_triangle([centroid; 3], normal, u, v);
        let range = self.element.facet_range();
        let (facets, rests) = choose_facets(&range, self.power_before, u, lanes);
        for l in 0..lanes as usize {
            let (facet, frame) = (facets[l], &self.frames[facets[l]]);
            let at = match self.is_even[facet] {
                true => folded([rests[l], v[l]]),
                false => {
                    let owner = self.owner_of_facet[facet];
                    let slot = facet as u32 - self.first_facets[owner as usize];
                    let splits = &self.shooters[owner as usize].splits;
                    lit_point(splits, slot, [rests[l], v[l]])
                }
            };
            points.set(l, frame.at(at), frame.normal);
            if frame.is_touched {
                self.hide(&mut points, l, frame.facet);
            }
        }
        points
    }

    /// Marks point `l` of `facet` where it is hidden. What a surface receives is what its open part receives, so
    /// that is where its light comes from; what it emits it emits everywhere.
    fn hide(&self, points: &mut PointOctet, l: usize, facet: Facet) {
        if !self.scene.contacts.is_hidden(facet, points.position(l)) {
            return;
        }
        if self.scene.emission(facet) == [0.0; 3] {
            points.absent |= 1 << l;
        } else {
            points.swallowed |= 1 << l;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::SampleSequence;
    use crate::solve::split_triangle;
    use glam::Vec3;

    #[test]
    fn points_of_a_triangle_lie_in_the_children_that_they_are_said_to() {
        let corners = [
            Vec3::new(0.1, 0.2, 0.0),
            Vec3::new(1.3, 0.1, 0.0),
            Vec3::new(0.4, 0.9, 0.0),
        ];
        let mut met = [0; 4];
        for index in (0..512).step_by(8) {
            let [u, v, ..] = SampleSequence::new(7).points(index);
            let points = PointOctet::of_triangle(corners, Vec3::Z, &u, &v);
            for (l, &which) in children_of_triangle(&u, &v).iter().enumerate() {
                let [a, b, c] = split_triangle(corners, u32::from(which));
                let p = points.position(l);
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    assert!(
                        (to - from).cross(p - from).z > -1.0e-6,
                        "{p} is not in child {which}"
                    );
                }
                met[usize::from(which)] += 1;
            }
        }
        // A quarter each, within three standard deviations of random ones.
        assert!(met.iter().all(|&n| (98..=158).contains(&n)), "{met:?}");
    }
}
