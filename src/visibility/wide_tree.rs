//! A flat hierarchy of boxes, eight children a node in structure-of-arrays form, so that one
//! segment or one shaft is tested against eight boxes at a time (design, section 7, point 1).

use crate::math::Aabb;
use glam::Vec3;

/// Eight boxes, coordinate by coordinate. Unused lanes hold an empty box that nothing meets.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct BoxOctet {
    /// Least x, y, z of each lane.
    pub min: [[f32; 8]; 3],
    /// Greatest x, y, z of each lane.
    pub max: [[f32; 8]; 3],
}

impl BoxOctet {
    /// Eight empty boxes. Finite, so that no product with them is NaN; so far out that every plane
    /// of every shaft has them outside.
    pub(super) const EMPTY: Self = Self {
        min: [[1.0e18; 8]; 3],
        max: [[-1.0e18; 8]; 3],
    };

    pub(super) fn set(&mut self, lane: usize, bounds: Aabb) {
        for axis in 0..3 {
            self.min[axis][lane] = bounds.min[axis];
            self.max[axis][lane] = bounds.max[axis];
        }
    }

    pub(super) fn get(&self, lane: usize) -> Aabb {
        let at = |v: &[[f32; 8]; 3]| Vec3::new(v[0][lane], v[1][lane], v[2][lane]);
        Aabb {
            min: at(&self.min),
            max: at(&self.max),
        }
    }
}

/// Where a child of a node is found, in 32 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ChildRef(u32);

impl ChildRef {
    pub(super) const NONE: Self = Self(u32::MAX);
    const LEAF: u32 = 1 << 31;

    /// The raw bits, for compact lists.
    pub(super) fn bits(self) -> u32 {
        self.0
    }

    /// The inverse of [`Self::bits`].
    pub(super) fn from_bits(bits: u32) -> Self {
        Self(bits)
    }

    pub(super) fn node(index: usize) -> Self {
        debug_assert!(index < Self::LEAF as usize);
        Self(index as u32)
    }

    pub(super) fn leaf(index: usize) -> Self {
        debug_assert!(index < (u32::MAX ^ Self::LEAF) as usize);
        Self(index as u32 | Self::LEAF)
    }

    pub(super) fn is_leaf(self) -> bool {
        self.0 & Self::LEAF != 0
    }

    pub(super) fn index(self) -> usize {
        (self.0 & !Self::LEAF) as usize
    }
}

/// One node: eight boxes and what is in them.
#[derive(Clone, Copy, Debug)]
pub(super) struct WideNode {
    pub boxes: BoxOctet,
    pub children: [ChildRef; 8],
}

/// Up to eight primitives; unused lanes hold [`WideLeaf::NONE`], and come last.
#[derive(Clone, Copy, Debug)]
pub(super) struct WideLeaf {
    pub primitives: [u32; 8],
}

impl WideLeaf {
    pub(super) const NONE: u32 = u32::MAX;

    pub(super) fn len(&self) -> usize {
        self.primitives
            .iter()
            .position(|&p| p == Self::NONE)
            .unwrap_or(8)
    }
}

/// The hierarchy. Node 0 is the root where there is any primitive.
#[derive(Clone, Debug, Default)]
pub(super) struct WideTree {
    pub nodes: Vec<WideNode>,
    pub leaves: Vec<WideLeaf>,
}

/// Why a hierarchy of boxes is not one.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("box hierarchy, node {node}: {reason}")]
pub struct WideTreeDefect {
    /// The offending node.
    pub node: usize,
    /// What is wrong with it.
    pub reason: &'static str,
}

impl WideTree {
    /// Checks that every primitive appears exactly once and lies in every box above it, given the
    /// primitives' boxes.
    pub(super) fn validate(&self, boxes: &[Aabb]) -> Result<(), WideTreeDefect> {
        let fail = |node, reason| Err(WideTreeDefect { node, reason });
        let mut seen = vec![false; boxes.len()];
        let mut visits = vec![0_u32; self.nodes.len()];
        let everything = Aabb {
            min: Vec3::NEG_INFINITY,
            max: Vec3::INFINITY,
        };
        let mut stack = Vec::new();
        if !self.nodes.is_empty() {
            stack.push((0, everything));
        }
        while let Some((index, bounds)) = stack.pop() {
            let Some(node) = self.nodes.get(index) else {
                return fail(index, "no such node");
            };
            visits[index] += 1;
            if visits[index] > 1 {
                return fail(index, "reached twice");
            }
            for (lane, &child) in node.children.iter().enumerate() {
                if child == ChildRef::NONE {
                    continue;
                }
                let lane_box = node.boxes.get(lane);
                if !bounds.contains_box(lane_box) {
                    return fail(index, "a child sticks out");
                }
                if !child.is_leaf() {
                    stack.push((child.index(), lane_box));
                    continue;
                }
                let Some(leaf) = self.leaves.get(child.index()) else {
                    return fail(index, "no such leaf");
                };
                for &primitive in &leaf.primitives[..leaf.len()] {
                    let i = primitive as usize;
                    if i >= boxes.len() || seen[i] {
                        return fail(index, "a primitive is foreign or appears twice");
                    }
                    seen[i] = true;
                    if !lane_box.contains_box(boxes[i]) {
                        return fail(index, "a primitive sticks out");
                    }
                }
            }
        }
        if visits.contains(&0) {
            return fail(0, "a node is never reached");
        }
        if seen.contains(&false) {
            return fail(0, "a primitive is missing");
        }
        Ok(())
    }

    /// Bytes held.
    pub(super) fn bytes(&self) -> usize {
        self.nodes.len() * size_of::<WideNode>() + self.leaves.len() * size_of::<WideLeaf>()
    }
}
