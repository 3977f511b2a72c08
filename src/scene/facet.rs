//! Sides of polygons.

use crate::math::PolygonId;

/// One side of a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// The side from which the vertices run counter-clockwise; the only one that emits.
    Front,
    /// The other side.
    Back,
}

impl Side {
    /// The side that looks the other way.
    #[must_use]
    pub(super) fn other(self) -> Self {
        match self {
            Self::Front => Self::Back,
            Self::Back => Self::Front,
        }
    }
}

/// One side of a polygon that receives and reflects light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Facet {
    /// The polygon.
    pub polygon: PolygonId,
    /// Which of its sides.
    pub side: Side,
}
