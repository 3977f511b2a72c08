//! All solids in a flat hierarchy, and the query for one that blocks a whole pair.

use super::bounds::ElementBounds;
use super::probe_segment::{ProbeSegment, SegmentWalk};
use super::solid_occlusion::SolidBox;
use super::tolerance::Tolerance;
use super::wide_tree::{WideLeaf, WideTree};
use crate::math::Aabb;
use crate::occluder::Solid;

/// The solids of a scene, ready to be queried.
#[derive(Clone, Debug, Default)]
pub(super) struct SolidTree {
    tree: WideTree,
    /// `None` where a solid is of no use.
    boxes: Vec<Option<SolidBox>>,
}

/// The outcome of [`SolidTree::query`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SolidAnswer {
    /// Index of a solid that blocks the whole pair.
    pub solid: Option<u32>,
    pub nodes: u32,
    pub tests: u32,
}

impl SolidTree {
    /// The hierarchy over `solids`, whose indices it keeps.
    pub fn build(solids: &[Solid], tolerance: &Tolerance) -> Self {
        let bounds: Vec<Aabb> = solids.iter().map(Solid::bounds).collect();
        Self {
            tree: WideTree::build(&bounds),
            boxes: solids
                .iter()
                .map(|solid| SolidBox::new(solid, tolerance))
                .collect(),
        }
    }

    /// True when there is none, and nothing to query.
    pub fn is_empty(&self) -> bool {
        self.boxes.is_empty()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.tree.bytes() + size_of_val(self.boxes.as_slice())
    }

    /// Tries one solid; false where there is none of that index.
    #[inline(always)]
    pub fn occludes(&self, solid: usize, a: &ElementBounds, b: &ElementBounds) -> bool {
        matches!(self.boxes.get(solid), Some(Some(found)) if found.occludes(a, b))
    }

    /// Looks for a solid that meets every segment between `a` and `b`, among those that meet the segment between their
    /// centres. `stack` is lent.
    #[inline(always)]
    pub fn query(
        &self,
        a: &ElementBounds,
        b: &ElementBounds,
        between_centres: &ProbeSegment,
        stack: &mut Vec<u32>,
    ) -> SolidAnswer {
        let mut answer = SolidAnswer::default();
        let mut walk = SegmentWalk::new(between_centres, &self.tree, stack);
        while let Some(leaf) = walk.next_leaf() {
            for &id in &self.tree.leaves[leaf].primitives {
                if id == WideLeaf::NONE {
                    break;
                }
                let Some(solid) = &self.boxes[id as usize] else {
                    continue;
                };
                if !solid.meets_segment(between_centres) {
                    continue;
                }
                answer.tests += 1;
                if solid.occludes(a, b) {
                    answer.solid = Some(id);
                    answer.nodes = walk.nodes;
                    return answer;
                }
            }
        }
        answer.nodes = walk.nodes;
        answer
    }
}
