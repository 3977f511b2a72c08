//! Who owns which receivers: a fixed cut of the hierarchy, the same at any number of threads.

use crate::cluster::{Hierarchy, NodeKind};
use crate::math::NodeId;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// Receivers that a pass is dealt out in: enough that a slow one does not leave cores idle, few
/// enough that walking down to them is nothing (design: a few hundred).
const OWNERS: usize = 512;

/// A node of the heap: the heaviest is split first, ties by the lower id.
struct Heavy {
    weight: f64,
    node: NodeId,
}

impl PartialEq for Heavy {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Heavy {}

impl PartialOrd for Heavy {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Heavy {
    fn cmp(&self, other: &Self) -> Ordering {
        self.weight
            .total_cmp(&other.weight)
            .then(other.node.cmp(&self.node))
    }
}

/// The cut, in facet order: disjoint nodes that together cover every facet.
///
/// Refinement follows area and facets, so both weigh a node.
pub fn owner_cut(hierarchy: &Hierarchy) -> Vec<NodeId> {
    let total_area = f64::from(hierarchy.shape(Hierarchy::ROOT).area);
    let total_facets = hierarchy.facets.len() as f64;
    let weigh = |node: NodeId| Heavy {
        weight: f64::from(hierarchy.shape(node).area) / total_area
            + f64::from(hierarchy.node(node).facet_count) / total_facets,
        node,
    };
    let mut heap = BinaryHeap::from([weigh(Hierarchy::ROOT)]);
    let mut whole = Vec::new();
    while heap.len() + whole.len() < OWNERS {
        let Some(Heavy { node, .. }) = heap.pop() else {
            break;
        };
        if hierarchy.node(node).kind == NodeKind::Facet {
            whole.push(node);
        } else if let Some(children) = hierarchy.children(node) {
            heap.extend(children.map(weigh));
        }
    }
    let mut cut: Vec<NodeId> = whole
        .into_iter()
        .chain(heap.into_iter().map(|h| h.node))
        .collect();
    cut.sort_by_key(|&n| hierarchy.node(n).first_facet);
    cut
}
