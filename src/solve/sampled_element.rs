//! Elements as surfaces to sample, uniformly by area.
//!
//! Light and visibility go together (the lit part of a floor is the part that is not under the
//! furniture), so a visibility averaged over a source's area would be too low for its light. Source points
//! therefore carry the frozen unshot radiosity at the point, over the source's mean.

use super::element::{Element, Shape};
use super::radiosity::Shooter;
use super::solution::split_triangle;
use crate::cluster::Hierarchy;
use crate::scene::Scene;
use crate::visibility::{Surface, SurfacePoint};
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
    fn point(&self, u: f32, v: f32) -> SurfacePoint {
        if let Shape::Triangle(corners) = self.element.shape {
            return SurfacePoint {
                position: triangle_point(corners, u, v),
                normal: self.element.normal,
                light: 1.0,
            };
        }
        let (facet, rest) = choose_facet(self.element, self.area_before, u);
        let corners = self.scene.facet_corners(self.hierarchy.facets[facet]);
        SurfacePoint {
            position: triangle_point(corners, rest, v),
            normal: self.normals[facet],
            light: 1.0,
        }
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
    /// Sums of the areas before each facet.
    pub area_before: &'a [f64],
    /// Unshot radiosity of the element, sum of the channels; positive.
    pub radiosity: f32,
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
    fn point(&self, u: f32, v: f32) -> SurfacePoint {
        if let Shape::Triangle(corners) = self.element.shape {
            return self.patch_point(self.owner, self.slot, corners, self.element.normal, [u, v]);
        }
        let (facet, rest) = choose_facet(self.element, self.area_before, u);
        let owner = self.owner_of_facet[facet];
        let slot = facet as u32 - self.first_facets[owner as usize];
        let corners = self.scene.facet_corners(self.hierarchy.facets[facet]);
        self.patch_point(owner, slot, corners, self.normals[facet], [rest, v])
    }
}

impl<const C: usize> SourceSurface<'_, C> {
    /// A point of a frozen patch: down its split with `u`, whose four children have equal areas.
    fn patch_point(
        &self,
        owner: u32,
        slot: u32,
        mut corners: [Vec3; 3],
        normal: Vec3,
        [mut u, v]: [f32; 2],
    ) -> SurfacePoint {
        let shooter = &self.shooters[owner as usize];
        let mut slot = slot as usize;
        while shooter.children[slot] != 0 {
            let which = ((4.0 * u) as u32).min(3);
            u = 4.0 * u - which as f32;
            corners = split_triangle(corners, which);
            slot = (shooter.children[slot] + which) as usize;
        }
        SurfacePoint {
            position: triangle_point(corners, u, v),
            normal,
            light: shooter.unshot[slot].iter().sum::<f32>() / self.radiosity,
        }
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

/// Uniform point of a triangle from a point of the unit square, folded along its diagonal.
fn triangle_point([a, b, c]: [Vec3; 3], u: f32, v: f32) -> Vec3 {
    let (u, v) = if u + v > 1.0 {
        (1.0 - u, 1.0 - v)
    } else {
        (u, v)
    };
    a + (b - a) * u + (c - a) * v
}
