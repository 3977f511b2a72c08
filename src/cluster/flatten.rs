//! From a forest's one tree to flat arrays: the root first, the two children of a node next to each
//! other behind it, facets in the order in which a depth-first walk meets them.

use super::forest::Forest;
use super::hierarchy::{Node, NodeKind};
use crate::math::{Aabb, NodeId};
use crate::scene::{Facet, Scene};

/// The hot arrays of a hierarchy.
pub(super) struct FlatTree {
    pub nodes: Vec<Node>,
    pub facets: Vec<Facet>,
    pub leaf_of_facet: Vec<NodeId>,
}

/// Lays out the tree under `root`, whose joins numbered below `first_volume` are face clusters.
pub(super) fn flatten(
    scene: &Scene,
    facets: &[Facet],
    forest: &Forest,
    root: u32,
    first_volume: u32,
) -> FlatTree {
    let counts = forest.fold(|_| 1_u32, |a, b| a + b);
    let blank = Node {
        bounds: Aabb::EMPTY,
        first_child: 0,
        first_facet: 0,
        facet_count: 0,
        kind: NodeKind::Facet,
    };
    let mut nodes = Vec::with_capacity(2 * facets.len());
    nodes.push(blank);
    let mut order = Vec::with_capacity(facets.len());
    let mut leaf_of_facet = Vec::with_capacity(facets.len());
    let mut open = vec![(root, 0_u32)];
    while let Some((tree_node, place)) = open.pop() {
        let first_child = nodes.len() as u32;
        let node = &mut nodes[place as usize];
        node.first_facet = order.len() as u32;
        node.facet_count = counts[tree_node as usize];
        let Some([left, right]) = forest.children(tree_node) else {
            let facet = facets[tree_node as usize];
            node.bounds = Aabb::from_points(scene.corners(facet.polygon));
            order.push(facet);
            leaf_of_facet.push(NodeId(place));
            continue;
        };
        node.first_child = first_child;
        node.kind = if tree_node < first_volume {
            NodeKind::FaceCluster
        } else {
            NodeKind::Volume
        };
        nodes.extend([blank; 2]);
        open.push((right, first_child + 1));
        open.push((left, first_child));
    }
    for place in (0..nodes.len()).rev() {
        if nodes[place].kind != NodeKind::Facet {
            let first = nodes[place].first_child as usize;
            nodes[place].bounds = nodes[first].bounds.union(nodes[first + 1].bounds);
        }
    }
    FlatTree {
        nodes,
        facets: order,
        leaf_of_facet,
    }
}
