//! Elements as surfaces to sample: receivers uniformly by area, sources by the power that they have to shoot.
//!
//! Light and visibility go together (the lit part of a floor is the part that is not under the
//! furniture), so a visibility averaged over a source's area would be too low for its light.

use super::element::{Element, Shape};
use super::radiosity::Shooter;
use super::solution::split_triangle;
use crate::cluster::Hierarchy;
use crate::scene::{Facet, Scene};
use crate::visibility::{PointOctet, Surface};
use glam::Vec3;

/// A receiver.
pub struct ReceiverSurface<'a> {
    /// The element.
    pub element: &'a Element,
    /// Its scene.
    pub scene: &'a Scene,
    /// Its hierarchy.
    pub hierarchy: &'a Hierarchy,
    /// Unit normals of the facets.
    pub normals: &'a [Vec3],
    /// Sums of the areas before each facet.
    pub area_before: &'a [f64],
}

impl Surface for ReceiverSurface<'_> {
    fn points(&self, u: &[f32; 8], v: &[f32; 8]) -> PointOctet {
        let normal = self.element.normal;
        if let Shape::Triangle(corners) = self.element.shape {
            let mut points = PointOctet::of_triangle(corners, normal, u, v);
            let facet = self.hierarchy.facets[self.element.first_facet as usize];
            if self.scene.contacts.touches(facet) {
                for l in 0..8 {
                    let hidden = self.scene.contacts.is_hidden(facet, points.position(l));
                    points.swallowed |= u8::from(hidden) << l;
                }
            }
            return points;
        }
        let mut points = PointOctet::of_triangle([self.element.centroid; 3], normal, u, v);
        for l in 0..8 {
            let (facet, rest) = choose_facet(self.element, self.area_before, u[l]);
            let corners = self.scene.facet_corners(self.hierarchy.facets[facet]);
            points.set(l, corners, self.normals[facet], [rest, v[l]]);
            let facet = self.hierarchy.facets[facet];
            let hidden = self.scene.contacts.is_hidden(facet, points.position(l));
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
    /// Unit normals of the facets.
    pub normals: &'a [Vec3],
    /// Sums of the unshot power before each facet.
    pub power_before: &'a [f64],
    /// What every owner's patches have to shoot.
    pub shooters: &'a [Shooter<C>],
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
    fn points(&self, u: &[f32; 8], v: &[f32; 8]) -> PointOctet {
        let normal = self.element.normal;
        if let Shape::Triangle(corners) = self.element.shape {
            let mut points = PointOctet::of_triangle(corners, normal, u, v);
            let shooter = &self.shooters[self.owner as usize];
            if shooter.children[self.slot as usize] != 0 {
                for l in 0..8 {
                    let at = (self.owner, self.slot);
                    self.set_patch_point(&mut points, l, at, corners, normal, [u[l], v[l]]);
                }
            }
            let facet = self.hierarchy.facets[self.element.first_facet as usize];
            if self.scene.contacts.touches(facet) {
                (0..8).for_each(|l| self.hide(&mut points, l, facet));
            }
            return points;
        }
        let mut points = PointOctet::of_triangle([self.element.centroid; 3], normal, u, v);
        for l in 0..8 {
            let (facet, rest) = choose_facet(self.element, self.power_before, u[l]);
            let owner = self.owner_of_facet[facet];
            let slot = facet as u32 - self.first_facets[owner as usize];
            let corners = self.scene.facet_corners(self.hierarchy.facets[facet]);
            let normal = self.normals[facet];
            self.set_patch_point(&mut points, l, (owner, slot), corners, normal, [rest, v[l]]);
            self.hide(&mut points, l, self.hierarchy.facets[facet]);
        }
        points
    }
}

impl<const C: usize> SourceSurface<'_, C> {
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

    /// Puts a point of a frozen patch into lane `l`: down its split with `u`, by the children's
    /// light.
    fn set_patch_point(
        &self,
        points: &mut PointOctet,
        l: usize,
        (owner, slot): (u32, u32),
        mut corners: [Vec3; 3],
        normal: Vec3,
        [mut u, v]: [f32; 2],
    ) {
        let shooter = &self.shooters[owner as usize];
        let mut slot = slot as usize;
        while shooter.children[slot] != 0 {
            let first = shooter.children[slot] as usize;
            let light: [f32; 4] = std::array::from_fn(|k| shooter.unshot[first + k].iter().sum());
            let (mut which, mut rest) = (0, u * light.iter().sum::<f32>());
            while which < 3 && rest >= light[which as usize] {
                rest -= light[which as usize];
                which += 1;
            }
            u = (rest / light[which as usize].max(f32::MIN_POSITIVE)).clamp(0.0, BELOW_ONE);
            corners = split_triangle(corners, which);
            slot = (shooter.children[slot] + which) as usize;
        }
        points.set(l, corners, normal, [u, v]);
    }
}

/// The greatest f32 below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

/// Chooses a facet of a cluster in proportion to what `before` sums, and what is left of `u` inside it.
fn choose_facet(element: &Element, before: &[f64], u: f32) -> (usize, f32) {
    let first = element.first_facet as usize;
    let sums = &before[first..=first + element.facet_count as usize];
    let target = sums[0] + f64::from(u) * (sums[sums.len() - 1] - sums[0]);
    let chosen = sums[1..sums.len() - 1].partition_point(|&x| x <= target);
    let share = sums[chosen + 1] - sums[chosen];
    let rest = if share > 0.0 {
        ((target - sums[chosen]) / share) as f32
    } else {
        0.5
    };
    (first + chosen, rest.clamp(0.0, BELOW_ONE))
}
