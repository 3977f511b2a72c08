//! A segment between two points of a pair, which finds the occluders that come into question.

use super::wide_tree::{ChildRef, WideNode, WideTree};
use glam::Vec3;

/// A segment between two points of a pair.
pub(super) struct ProbeSegment {
    pub origin: Vec3,
    pub along: Vec3,
}

impl ProbeSegment {
    #[inline(always)]
    pub fn new(from: Vec3, to: Vec3) -> Self {
        Self {
            origin: from,
            along: to - from,
        }
    }

    /// One over the components of its direction; large but finite where one vanishes, so that no
    /// product is NaN.
    #[inline(always)]
    fn inverse(&self) -> Vec3 {
        let inverse = |d: f32| {
            if d.abs() > 1.0e-12 {
                1.0 / d
            } else {
                1.0e12_f32.copysign(d)
            }
        };
        Vec3::new(
            inverse(self.along.x),
            inverse(self.along.y),
            inverse(self.along.z),
        )
    }

    /// Bit per lane: the segment meets the box.
    #[inline(always)]
    fn meets_boxes(&self, inverse: Vec3, node: &WideNode) -> u32 {
        let mut enter = [0.0_f32; 8];
        let mut leave = [1.0_f32; 8];
        for axis in 0..3 {
            let (o, inverse) = (self.origin[axis], inverse[axis]);
            let (near, far) = if inverse >= 0.0 {
                (&node.boxes.min[axis], &node.boxes.max[axis])
            } else {
                (&node.boxes.max[axis], &node.boxes.min[axis])
            };
            for l in 0..8 {
                let (t0, t1) = ((near[l] - o) * inverse, (far[l] - o) * inverse);
                enter[l] = if t0 > enter[l] { t0 } else { enter[l] };
                leave[l] = if t1 < leave[l] { t1 } else { leave[l] };
            }
        }
        let mut bits = [0_u32; 8];
        for l in 0..8 {
            bits[l] = if enter[l] <= leave[l] { 1 << l } else { 0 };
        }
        bits.iter().fold(0, |mask, bit| mask | bit)
    }
}

/// The leaves of a hierarchy whose boxes a segment meets, one after the other. No iterator of closures: those are not
/// inlined into a function that has an instruction set of its own.
pub(super) struct SegmentWalk<'a> {
    segment: &'a ProbeSegment,
    inverse: Vec3,
    tree: &'a WideTree,
    stack: &'a mut Vec<u32>,
    /// Children of the node that is looked at, and which of them are still to come.
    children: [ChildRef; 8],
    hits: u32,
    /// Nodes looked at so far.
    pub nodes: u32,
}

impl<'a> SegmentWalk<'a> {
    /// From the root; `stack` is lent.
    #[inline(always)]
    pub fn new(segment: &'a ProbeSegment, tree: &'a WideTree, stack: &'a mut Vec<u32>) -> Self {
        stack.clear();
        if !tree.nodes.is_empty() {
            stack.push(0);
        }
        Self {
            segment,
            inverse: segment.inverse(),
            tree,
            stack,
            children: [ChildRef::NONE; 8],
            hits: 0,
            nodes: 0,
        }
    }

    /// Index of the next leaf.
    #[inline(always)]
    pub fn next_leaf(&mut self) -> Option<usize> {
        loop {
            while self.hits != 0 {
                let child = self.children[self.hits.trailing_zeros() as usize];
                self.hits &= self.hits - 1;
                if child == ChildRef::NONE {
                    continue;
                }
                if child.is_leaf() {
                    return Some(child.index());
                }
                self.stack.push(child.index() as u32);
            }
            let node = &self.tree.nodes[self.stack.pop()? as usize];
            self.nodes += 1;
            self.hits = self.segment.meets_boxes(self.inverse, node);
            self.children = node.children;
        }
    }
}
