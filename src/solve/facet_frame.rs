//! A facet as whoever draws points on clusters needs it: one line of the cache instead of five look-ups.

use crate::cluster::Hierarchy;
use crate::scene::{Facet, Scene};
use glam::Vec3;

/// Where the points of a facet lie.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub struct FacetFrame {
    /// Its first corner, normalised.
    pub corner: Vec3,
    /// From there to the second corner.
    pub along: Vec3,
    /// And to the third.
    pub across: Vec3,
    /// Unit normal.
    pub normal: Vec3,
    /// Which facet.
    pub facet: Facet,
    /// True if a solid that stands on it may hide some of it (see [`crate::scene::Contacts`]).
    pub is_touched: bool,
}

impl FacetFrame {
    /// The point so far along its first two edges.
    #[inline(always)]
    pub fn at(&self, [along, across]: [f32; 2]) -> Vec3 {
        self.corner + self.along * along + self.across * across
    }

    /// Its corners, counter-clockwise.
    #[inline(always)]
    pub fn corners(&self) -> [Vec3; 3] {
        [
            self.corner,
            self.corner + self.along,
            self.corner + self.across,
        ]
    }

    /// The frame of each facet, in the hierarchy's order; `normals` likewise.
    pub fn of_all(scene: &Scene, hierarchy: &Hierarchy, normals: &[Vec3]) -> Vec<Self> {
        let facets = hierarchy.facets.iter().zip(normals);
        facets
            .map(|(&facet, &normal)| {
                let [a, b, c] = scene.facet_corners(facet);
                Self {
                    corner: a,
                    along: b - a,
                    across: c - a,
                    normal,
                    facet,
                    is_touched: scene.contacts.touches_any(facet),
                }
            })
            .collect()
    }
}
