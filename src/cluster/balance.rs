//! Shortening the chains of a contraction tree.
//!
//! Contraction grows balanced trees wherever the surface lets it. Where thousands of pieces touch
//! nothing but one large piece (the teeth of a comb, the bumps on a wall) their only connected
//! unions are those with it, one after the other: a chain. Here the light children of a long chain
//! are joined among themselves first, by their boxes, and then with the piece at its end. They are
//! connected through that piece only, which no exchange of energy asks about. A chain is cut only
//! between joins of the same flatness step, so a flat cluster keeps what made it flat.
//!
//! A path from the root then holds at most 8 joins for each of about 30 flatness steps and 4 for
//! each doubling of the facets; measured depths are 1.1 log2 n (a grid) to 2.5 log2 n (furnished rooms).

use super::forest::Forest;
use super::volume_clustering::{Piece, cluster_volumes};
use crate::math::Aabb;

/// A chain is long beyond this many joins for each doubling of the facets from its end to its head:
/// contraction of meshes stays under 2.5 a doubling over all flatness steps together.
const JOINS_PER_DOUBLING: u32 = 4;

/// Doublings granted to every chain, so that a few pieces around a large one keep their order.
const FREE_DOUBLINGS: u32 = 2;

/// The forest with its long chains shortened; `leaf_bounds` gives the box of a leaf.
pub(super) fn balance(forest: Forest, leaf_bounds: impl Fn(u32) -> Aabb) -> Forest {
    let counts = forest.fold(|_| 1_u32, |a, b| a + b);
    let chains = Chains::new(&forest, &counts);
    if !chains.long.contains(&true) {
        return forest;
    }
    let bounds = forest.fold(leaf_bounds, Aabb::union);
    let leaves = forest.leaf_count() as u32;
    let mut balanced = Forest::new(forest.leaf_count());
    let mut moved: Vec<u32> = (0..leaves).collect();
    for node in leaves..forest.len() as u32 {
        let [heavy, light] = chains.heavy_first(node);
        let flatness = forest.flatness(node);
        let place = if !chains.long[node as usize] {
            balanced.join([moved[heavy as usize], moved[light as usize]], flatness)
        } else if chains.continues[node as usize] {
            // Inside a long chain; its head takes care of it.
            u32::MAX
        } else {
            let (end, lights) = chains.follow(node);
            let mut pieces: Vec<Piece> = lights
                .into_iter()
                .map(|light| Piece {
                    root: moved[light as usize],
                    bounds: bounds[light as usize],
                    facets: counts[light as usize],
                })
                .collect();
            let joined = cluster_volumes(&mut pieces, flatness, &mut balanced);
            balanced.join([moved[end as usize], joined], flatness)
        };
        moved.push(place);
    }
    balanced
}

/// The chains of a forest: from a join to its heavier child, as long as the flatness step is the same.
struct Chains {
    leaf_count: u32,
    /// The children of each join, the heavier first.
    children: Vec<[u32; 2]>,
    /// The chain of a node's parent goes on with this node.
    continues: Vec<bool>,
    /// The node lies on a long chain.
    long: Vec<bool>,
}

impl Chains {
    fn new(forest: &Forest, counts: &[u32]) -> Self {
        let leaf_count = forest.leaf_count() as u32;
        let joins = leaf_count..forest.len() as u32;
        let mut this = Self {
            leaf_count,
            children: Vec::with_capacity(joins.len()),
            continues: vec![false; forest.len()],
            long: vec![false; forest.len()],
        };
        // Joins on the chain from a node downwards, and the facets at its end.
        let mut length = vec![0_u32; forest.len()];
        let mut end_count = counts.to_vec();
        for node in joins.clone() {
            let [a, b] = forest.join_children(node);
            let heavy_first = if counts[b as usize] > counts[a as usize] {
                [b, a]
            } else {
                [a, b]
            };
            let heavy = heavy_first[0];
            this.children.push(heavy_first);
            let goes_on = heavy >= leaf_count && forest.flatness(heavy) == forest.flatness(node);
            this.continues[heavy as usize] = goes_on;
            length[node as usize] = 1 + if goes_on { length[heavy as usize] } else { 0 };
            end_count[node as usize] = if goes_on {
                end_count[heavy as usize]
            } else {
                counts[heavy as usize]
            };
        }
        for node in joins.rev() {
            if !this.continues[node as usize] {
                let gain = counts[node as usize] / end_count[node as usize];
                let patience = JOINS_PER_DOUBLING * (FREE_DOUBLINGS + gain.ilog2());
                this.long[node as usize] = length[node as usize] > patience;
            }
            let [heavy, _] = this.heavy_first(node);
            if this.continues[heavy as usize] {
                this.long[heavy as usize] = this.long[node as usize];
            }
        }
        this
    }

    fn heavy_first(&self, node: u32) -> [u32; 2] {
        self.children[(node - self.leaf_count) as usize]
    }

    /// What stands at the end of the chain that starts at `head`, and its light children.
    fn follow(&self, head: u32) -> (u32, Vec<u32>) {
        let mut lights = Vec::new();
        let mut node = head;
        loop {
            let [heavy, light] = self.heavy_first(node);
            lights.push(light);
            node = heavy;
            if !self.continues[node as usize] {
                return (node, lights);
            }
        }
    }
}
