//! Builds a [`WideTree`] by the surface area heuristic over 16 bins (Wald 2007): a node starts
//! with one range of primitives and splits the range of greatest area until it has eight.
//! Sequential and free of hashing, so the same boxes give the same tree.

use super::wide_tree::{BoxOctet, ChildRef, WideLeaf, WideNode, WideTree};
use crate::math::Aabb;
use glam::Vec3;

/// 16 bins an axis are within a percent of a full sweep's cost (Wald 2007).
const BINS: usize = 16;
/// Primitives that a leaf takes: one SIMD lane each.
const LEAF_SIZE: usize = 8;

#[derive(Clone, Copy)]
struct Reference {
    bounds: Aabb,
    primitive: u32,
}

impl Reference {
    /// Twice the box's centre: only its order matters.
    fn centroid(&self) -> Vec3 {
        self.bounds.min + self.bounds.max
    }
}

#[derive(Clone, Copy)]
struct Range {
    start: usize,
    end: usize,
    bounds: Aabb,
}

impl Range {
    fn len(&self) -> usize {
        self.end - self.start
    }
}

impl WideTree {
    /// The hierarchy over primitives with these boxes. At most 2^31 of them.
    pub(super) fn build(boxes: &[Aabb]) -> Self {
        let mut tree = Self::default();
        if boxes.is_empty() {
            return tree;
        }
        let mut references: Vec<Reference> = boxes
            .iter()
            .zip(0_u32..)
            .map(|(&bounds, primitive)| Reference { bounds, primitive })
            .collect();
        let whole = range_of(&references, 0, references.len());
        let mut pending = vec![(tree.push_node(), whole)];
        while let Some((index, range)) = pending.pop() {
            let parts = split_into_eight(&mut references, range);
            for (lane, part) in parts.iter().enumerate() {
                let child = if part.len() <= LEAF_SIZE {
                    tree.push_leaf(&references[part.start..part.end])
                } else {
                    let node = tree.push_node();
                    pending.push((node, *part));
                    ChildRef::node(node)
                };
                let node = &mut tree.nodes[index];
                node.boxes.set(lane, part.bounds);
                node.children[lane] = child;
            }
        }
        debug_assert_eq!(tree.validate(boxes), Ok(()));
        tree
    }

    fn push_node(&mut self) -> usize {
        self.nodes.push(WideNode {
            boxes: BoxOctet::EMPTY,
            children: [ChildRef::NONE; 8],
        });
        self.nodes.len() - 1
    }

    fn push_leaf(&mut self, references: &[Reference]) -> ChildRef {
        let mut primitives = [WideLeaf::NONE; LEAF_SIZE];
        for (slot, reference) in primitives.iter_mut().zip(references) {
            *slot = reference.primitive;
        }
        self.leaves.push(WideLeaf { primitives });
        ChildRef::leaf(self.leaves.len() - 1)
    }
}

fn range_of(references: &[Reference], start: usize, end: usize) -> Range {
    let bounds = references[start..end]
        .iter()
        .fold(Aabb::EMPTY, |b, r| b.union(r.bounds));
    Range { start, end, bounds }
}

fn split_into_eight(references: &mut [Reference], range: Range) -> Vec<Range> {
    let mut parts = vec![range];
    while parts.len() < 8 {
        let mut widest: Option<(usize, f32)> = None;
        for (i, part) in parts.iter().enumerate() {
            let area = part.bounds.surface_area();
            if part.len() > LEAF_SIZE && widest.is_none_or(|(_, a)| area > a) {
                widest = Some((i, area));
            }
        }
        let Some((i, _)) = widest else { break };
        let middle = partition(references, parts[i]);
        let Range { start, end, .. } = parts[i];
        parts[i] = range_of(references, start, middle);
        parts.push(range_of(references, middle, end));
    }
    parts
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Aabb,
    count: usize,
}

/// Reorders a range and returns where its second half starts; both halves have a primitive.
fn partition(references: &mut [Reference], range: Range) -> usize {
    let part = &mut references[range.start..range.end];
    let centroids = Aabb::from_points(part.iter().map(Reference::centroid));
    let Some((axis, border)) = best_split(part, centroids) else {
        // All centroids agree: any halving will do.
        return range.start + part.len() / 2;
    };
    let mut first = 0;
    let mut last = part.len();
    while first < last {
        if bin_of(part[first].centroid(), centroids, axis) < border {
            first += 1;
        } else {
            last -= 1;
            part.swap(first, last);
        }
    }
    range.start + first
}

fn bin_of(centroid: Vec3, centroids: Aabb, axis: usize) -> usize {
    let extent = centroids.max[axis] - centroids.min[axis];
    let along = (centroid[axis] - centroids.min[axis]) / extent;
    ((along * BINS as f32) as usize).min(BINS - 1)
}

/// The axis and the first bin of the second half that cost least, where any axis can split.
fn best_split(part: &[Reference], centroids: Aabb) -> Option<(usize, usize)> {
    let empty = Bin {
        bounds: Aabb::EMPTY,
        count: 0,
    };
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in 0..3 {
        let extent = centroids.max[axis] - centroids.min[axis];
        if extent.is_nan() || extent <= 0.0 {
            continue;
        }
        let mut bins = [empty; BINS];
        for reference in part {
            let bin = &mut bins[bin_of(reference.centroid(), centroids, axis)];
            bin.bounds = bin.bounds.union(reference.bounds);
            bin.count += 1;
        }
        let mut cost_behind = [0.0_f32; BINS];
        let mut behind = empty;
        for i in (1..BINS).rev() {
            behind.bounds = behind.bounds.union(bins[i].bounds);
            behind.count += bins[i].count;
            cost_behind[i] = behind.bounds.surface_area() * behind.count as f32;
        }
        let mut before = empty;
        for border in 1..BINS {
            before.bounds = before.bounds.union(bins[border - 1].bounds);
            before.count += bins[border - 1].count;
            if before.count == 0 || before.count == part.len() {
                continue;
            }
            let cost = before.bounds.surface_area() * before.count as f32 + cost_behind[border];
            if best.is_none_or(|(c, _, _)| cost < c) {
                best = Some((cost, axis, border));
            }
        }
    }
    best.map(|(_, axis, border)| (axis, border))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::SampleSequence;

    fn boxes(count: u32) -> Vec<Aabb> {
        let sequence = SampleSequence::new(5);
        (0..count)
            .map(|i| {
                let [x, y, z, s] = sequence.point(i);
                let p = Vec3::new(x, y * y, 0.1 * z);
                Aabb {
                    min: p,
                    max: p + Vec3::splat(0.01 * s),
                }
            })
            .collect()
    }

    #[test]
    fn every_primitive_is_reached_once_at_every_size() {
        for count in [0, 1, 7, 8, 9, 64, 65, 1000, 20_000] {
            let boxes = boxes(count);
            let tree = WideTree::build(&boxes);
            assert_eq!(tree.validate(&boxes), Ok(()), "{count} boxes");
            assert_eq!(tree.nodes.is_empty(), count == 0);
        }
    }

    #[test]
    fn coincident_boxes_still_split() {
        let boxes = vec![Aabb::from_points([Vec3::ZERO]); 1000];
        let tree = WideTree::build(&boxes);
        assert_eq!(tree.validate(&boxes), Ok(()));
    }

    #[test]
    fn validation_notices_a_box_that_sticks_out() {
        let mut boxes = boxes(100);
        let tree = WideTree::build(&boxes);
        boxes[3].max += Vec3::ONE;
        assert!(tree.validate(&boxes).is_err());
        assert!(tree.validate(&boxes[..99]).is_err());
    }
}
