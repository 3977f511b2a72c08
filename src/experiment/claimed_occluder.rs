//! What an occlusion claim rests on, a rectangle, a solid or a surface: its proofs, and where to aim at it.

use super::continuous_surface::{SurfaceProof, prove_closed, prove_surface};
use super::dice::Dice;
use super::element_points::{Place, point_of};
use crate::cluster::Hierarchy;
use crate::math::NodeId;
use crate::occluder::{Occluder, OccluderSet, Solid};
use crate::scene::Scene;
use crate::visibility::exact::{
    OcclusionFlaw, replay_occlusion, replay_solid_occlusion, replay_surface_occlusion,
};
use crate::visibility::{CuttingSurface, ElementBounds, Tolerance};
use glam::{DVec3, Vec3};

/// What was claimed to hide a pair.
#[derive(Clone)]
pub(super) enum ClaimedOccluder<'a> {
    Rectangle(&'a Occluder),
    Solid(&'a Solid),
    /// Empty where the engine does not find it again.
    Surface(CuttingSurface),
}

impl<'a> ClaimedOccluder<'a> {
    /// The one that a claim names: solids come after rectangles.
    pub fn of(set: &'a OccluderSet, index: u32) -> Self {
        match set.occluders.get(index as usize) {
            Some(rectangle) => Self::Rectangle(rectangle),
            None => Self::Solid(&set.solids[index as usize - set.occluders.len()]),
        }
    }

    /// The node of a rectangle.
    pub fn node(&self) -> Option<NodeId> {
        match self {
            Self::Rectangle(occluder) => Some(occluder.node),
            Self::Solid(_) | Self::Surface(_) => None,
        }
    }

    /// Shows that surface covers it; else a point that nothing covers. A surface covers itself.
    pub fn prove(
        &self,
        scene: &Scene,
        hierarchy: &Hierarchy,
        weld: f64,
    ) -> Result<SurfaceProof, DVec3> {
        match self {
            Self::Rectangle(occluder) => prove_surface(scene, hierarchy, occluder, weld),
            Self::Solid(solid) => prove_closed(scene, solid, weld),
            Self::Surface(_) => Ok(SurfaceProof::Chain),
        }
    }

    /// Shows in exact arithmetic that all segments between `a` and `b` cross it.
    pub fn replay(
        &self,
        a: &ElementBounds,
        b: &ElementBounds,
        tolerance: &Tolerance,
    ) -> Result<(), OcclusionFlaw> {
        match self {
            Self::Rectangle(occluder) => replay_occlusion(&occluder.slab, a, b, tolerance),
            Self::Solid(solid) => replay_solid_occlusion(solid, a, b, tolerance),
            Self::Surface(surface) => replay_surface_occlusion(surface, a, b, tolerance),
        }
    }

    /// A point of its border, or, since cracks run there, of an edge of the surface that it stands on.
    pub fn border_point(&self, scene: &Scene, hierarchy: &Hierarchy, dice: &mut Dice) -> Vec3 {
        let along = |start: Vec3, end: Vec3, dice: &mut Dice| start + (end - start) * dice.unit();
        match self {
            Self::Rectangle(occluder) if dice.below(2) == 0 => {
                let i = dice.below(4);
                let corners = occluder.slab.corners;
                along(corners[i], corners[(i + 1) % 4], dice)
            }
            Self::Rectangle(occluder) => {
                let facets = hierarchy.facet_range(occluder.node);
                let facet = hierarchy.facets[facets.start + dice.below(facets.len())];
                point_of(scene.facet_corners(facet), Place::Edge, dice)
            }
            Self::Solid(solid) => {
                let face = solid.face(dice.below(3), [-1.0, 1.0][dice.below(2)]);
                let i = dice.below(4);
                along(face[i].as_vec3(), face[(i + 1) % 4].as_vec3(), dice)
            }
            Self::Surface(surface) => match surface.polygons.as_slice() {
                [] => Vec3::ZERO,
                polygons => {
                    let polygon = polygons[dice.below(polygons.len())].map(|c| c.as_vec3());
                    point_of(polygon, Place::Edge, dice)
                }
            },
        }
    }
}
