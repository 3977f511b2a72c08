//! The occluders of a scene as later stages see them.

use super::slab::SlabRectangle;
use super::solid::Solid;
use crate::math::NodeId;

/// A rectangle thickened to a slab that no free segment can pass through.
///
/// # Exact meaning
///
/// Let F+ and F- be the convex hulls of [`SlabRectangle::face_corners`] of `slab`. Every segment
/// that meets both comes, between them, within w (the weld distance, 1e-6 of the scene's diagonal)
/// of some polygon of `node`: it is never *surely clear*. The surface under the rectangle lies
/// strictly between F+ and F-, so an end of the segment beyond a face is beyond the surface. The
/// rectangle may stick out over the surface's border by less than w ([`super::OccluderConfig::flush`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occluder {
    /// The rectangle and its thickness.
    pub slab: SlabRectangle,
    /// The flat cluster (or facet) that covers it.
    pub node: NodeId,
}

/// All occluders of a scene, in the order of the nodes that they come from, largest first within a node.
#[derive(Clone, Debug, Default)]
pub struct OccluderSet {
    /// The occluders.
    pub occluders: Vec<Occluder>,
    /// Boxes that hide what is seen past their edges; claims number them after the rectangles.
    pub solids: Vec<Solid>,
    /// Counts and areas.
    pub statistics: OccluderStatistics,
    /// Wall time of the search for rectangles and for solids.
    pub seconds: ExtractionSeconds,
}

/// Wall time of an extraction's stages.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExtractionSeconds {
    /// Rectangles: the paper's extraction.
    pub rectangles: f64,
    /// Solids behind them.
    pub solids: f64,
}

/// Counts and areas of an extraction; areas in normalised units squared.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct OccluderStatistics {
    /// Flat clusters that were big enough, off the scene's bounding box, and no second side of
    /// another.
    pub flat_clusters: usize,
    /// Flat clusters that gave at least one occluder.
    pub productive_clusters: usize,
    /// Occluders.
    pub occluders: usize,
    /// Area of the flat clusters' footprints.
    pub flat_area: f64,
    /// Area of the union of each cluster's rectangles, summed.
    pub covered_area: f64,
    /// Grown rectangles that the exact check refused.
    pub rejected: usize,
}

impl OccluderStatistics {
    /// Covered area over the area of flat clusters; 0 where nothing is flat.
    pub fn covered_share(&self) -> f64 {
        if self.flat_area > 0.0 {
            self.covered_area / self.flat_area
        } else {
            0.0
        }
    }
}
