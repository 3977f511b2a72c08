//! What lies on one polygon, and which of two sides that lie on each other comes first.

use super::facet::{Facet, Side};
use super::model::Scene;
use super::uncovered::Covered;
use crate::math::PolygonId;
use glam::Vec3;

/// What is found about one polygon.
#[derive(Default)]
pub(super) struct Cover {
    /// How much of its front and of its back others have.
    pub sides: [Covered; 2],
    /// All that come before its sides and lie on them, by polygon.
    pub cuts: Vec<Cut>,
    /// Triangles that own parts of its sides, where not whole polygons do.
    pub pieces: Vec<(Side, [Vec3; 3])>,
    /// Sides, and the polygons whose fronts lie against them.
    pub against: Vec<(Side, PolygonId)>,
    /// Whether it lies in such a crowd that the search was given up.
    pub gave_up: bool,
}

/// A side that comes before another and lies on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cut {
    /// Which side it lies on.
    pub on: Side,
    pub by: Facet,
    /// Whether it takes what those before it in the list have left.
    pub takes: bool,
}

impl Cover {
    pub fn of(&self, side: Side) -> Covered {
        self.sides[usize::from(side == Side::Back)]
    }
}

/// Which of two sides owns what they share: the lesser.
pub(super) fn precedence(scene: &Scene, facet: Facet) -> (bool, Side, PolygonId) {
    let Facet { polygon, side } = facet;
    let dark = side == Side::Back || !emits(scene, polygon);
    (dark, side, polygon)
}

pub(super) fn emits(scene: &Scene, polygon: PolygonId) -> bool {
    scene.surface(polygon).emission != [0.0; 3]
}
