//! Cuts through the hierarchy: a few nodes that cover every facet once.

use super::hierarchy::{Hierarchy, NodeKind};
use crate::math::NodeId;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

impl Hierarchy {
    /// The cut of `count` nodes (fewer where there are fewer facets) that is reached by always
    /// splitting the node that stands worst for its facets: volume clusters first, the largest
    /// first, then the clusters with the greatest product of area and spread of normals. In the
    /// order of their facets.
    pub fn cut(&self, count: usize) -> Vec<NodeId> {
        let rank = |id: NodeId| {
            let shape = self.shape(id);
            let weight = match self.node(id).kind {
                NodeKind::Volume => self.node(id).bounds.diagonal(),
                NodeKind::FaceCluster => shape.area * shape.cone.half_angle,
                NodeKind::Facet => 0.0,
            };
            // Positive floats are ordered as their bits are.
            let is_volume = self.node(id).kind == NodeKind::Volume;
            (is_volume, weight.max(0.0).to_bits(), Reverse(id))
        };
        let mut cut = Vec::new();
        let mut open = BinaryHeap::new();
        if !self.nodes.is_empty() {
            open.push(rank(Self::ROOT));
        }
        while let Some((.., Reverse(id))) = open.pop() {
            match self.children(id) {
                Some(children) if cut.len() + open.len() + 2 <= count => {
                    open.extend(children.map(rank));
                }
                _ => cut.push(id),
            }
        }
        cut.sort_unstable_by_key(|&id| self.node(id).first_facet);
        cut
    }
}
