//! What of the scene may still lie in a shaft: the list that a pair hands down to its children.
//!
//! Paper, section 5.3, marks boxes; a list owned by the recursion is the thread-safe form of the same
//! idea. What is outside a pair's shaft is outside the shafts of all pairs below it, so a child
//! starts from its parent's survivors instead of the whole scene.

use super::scene_tree::SceneTree;
use super::wide_tree::{BoxOctet, ChildRef};
use crate::math::{Aabb, PolygonId};

/// Nodes and leaves, disjoint, that together hold every polygon that may block a segment of a pair.
#[derive(Clone, Debug, Default)]
pub struct SurvivorList {
    pub(super) octets: Vec<SurvivorOctet>,
    len: usize,
}

/// Eight entries with their boxes, so that a shaft meets them eight at a time.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurvivorOctet {
    pub boxes: BoxOctet,
    pub entries: [SurvivorEntry; 8],
}

/// A node, or a leaf of which only some lanes survive.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurvivorEntry {
    reference: u32,
    /// Surviving lanes of a leaf; unused for a node.
    pub lanes: u32,
}

impl SurvivorEntry {
    const NONE: Self = Self {
        reference: u32::MAX,
        lanes: 0,
    };

    pub(super) fn new(reference: ChildRef, lanes: u32) -> Self {
        Self {
            reference: reference.bits(),
            lanes,
        }
    }

    pub(super) fn reference(self) -> ChildRef {
        ChildRef::from_bits(self.reference)
    }
}

impl SurvivorList {
    /// An empty list: nothing is in the way.
    pub fn new() -> Self {
        Self::default()
    }

    /// The list of the whole scene, with which the topmost pair starts.
    pub fn whole_scene(scene: &SceneTree) -> Self {
        let mut list = Self::default();
        if let Some((root, bounds)) = scene.root() {
            list.push(bounds, SurvivorEntry::new(root, 0));
        }
        list
    }

    /// Forgets all entries and keeps the memory.
    pub fn clear(&mut self) {
        self.octets.clear();
        self.len = 0;
    }

    /// Number of entries: nodes and leaves, not polygons.
    pub fn len(&self) -> usize {
        self.len
    }

    /// True when nothing can block.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    #[inline(always)]
    pub(super) fn push(&mut self, bounds: Aabb, entry: SurvivorEntry) {
        let lane = self.len % 8;
        if lane == 0 {
            self.octets.push(SurvivorOctet {
                boxes: BoxOctet::EMPTY,
                entries: [SurvivorEntry::NONE; 8],
            });
        }
        if let Some(octet) = self.octets.last_mut() {
            octet.boxes.set(lane, bounds);
            octet.entries[lane] = entry;
        }
        self.len += 1;
    }

    pub(super) fn entries(&self) -> impl Iterator<Item = SurvivorEntry> + '_ {
        self.octets.iter().flat_map(|o| o.entries).take(self.len)
    }

    /// Every polygon in the list, nodes opened, in no particular order.
    pub fn polygons(&self, scene: &SceneTree) -> Vec<PolygonId> {
        let mut found = Vec::new();
        let mut pending: Vec<(ChildRef, u32)> =
            self.entries().map(|e| (e.reference(), e.lanes)).collect();
        while let Some((reference, lanes)) = pending.pop() {
            if reference.is_leaf() {
                let first = 8 * reference.index();
                found.extend(
                    (0..8)
                        .filter(|lane| lanes & (1 << lane) != 0)
                        .map(|lane| scene.polygons[first + lane].id),
                );
                continue;
            }
            let node = &scene.tree.nodes[reference.index()];
            pending.extend(
                node.children
                    .iter()
                    .filter(|&&c| c != ChildRef::NONE)
                    .map(|&c| match c.is_leaf() {
                        true => (c, scene.used_lanes(c.index())),
                        false => (c, 0),
                    }),
            );
        }
        found
    }
}
