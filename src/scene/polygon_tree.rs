//! A binary tree of boxes over polygons, to find those near the plane patch of a given one.

use super::model::Scene;
use crate::math::{Aabb, PolygonId};
use glam::Vec3;
use rayon::prelude::*;

/// Polygons a leaf: a box test costs about as much as rejecting four of them.
const LEAF: usize = 4;

/// Nodes that a search around one polygon may visit. Meshes need about a hundred; only crowds in
/// which every box meets every other need more, and must not cost quadratic time.
pub(super) const MOST_VISITS: usize = 4096;

struct Node {
    bounds: Aabb,
    /// Where to go on if the box is missed: the node after this one's descendants.
    skip: u32,
    /// Range of `order`; empty for inner nodes.
    first: u32,
    count: u32,
}

/// Nodes in depth-first order over polygons sorted along a space-filling curve (Morton 1966).
pub(crate) struct PolygonTree {
    nodes: Vec<Node>,
    order: Vec<u32>,
    /// Boxes of polygons, in the order of `order`.
    boxes: Vec<Aabb>,
}

impl PolygonTree {
    pub fn new(scene: &Scene) -> Self {
        let boxes: Vec<Aabb> = (0..scene.polygons.len())
            .into_par_iter()
            .map(|i| Aabb::from_points(scene.corners(PolygonId::new(i))))
            .collect();
        let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
        order.par_sort_by_cached_key(|&i| (morton(boxes[i as usize].centre()), i));
        let mut tree = Self {
            nodes: Vec::with_capacity(boxes.len()),
            order: Vec::new(),
            boxes: order.iter().map(|&i| boxes[i as usize]).collect(),
        };
        if !boxes.is_empty() {
            tree.add(&boxes, &order, 0);
        }
        tree.order = order;
        tree
    }

    fn add(&mut self, boxes: &[Aabb], order: &[u32], first: usize) -> Aabb {
        let index = self.nodes.len();
        let leaf = order.len() <= LEAF;
        self.nodes.push(Node {
            bounds: Aabb::EMPTY,
            skip: 0,
            first: first as u32,
            count: if leaf { order.len() as u32 } else { 0 },
        });
        let bounds = if leaf {
            order
                .iter()
                .fold(Aabb::EMPTY, |all, &i| all.union(boxes[i as usize]))
        } else {
            let (left, right) = order.split_at(order.len() / 2);
            let left_bounds = self.add(boxes, left, first);
            left_bounds.union(self.add(boxes, right, first + left.len()))
        };
        let skip = self.nodes.len() as u32;
        let node = &mut self.nodes[index];
        node.bounds = bounds;
        node.skip = skip;
        bounds
    }

    /// Calls `each` with the polygons whose box comes within `margin` of `bounds`, in leaves that
    /// come as near the plane through `point` with unit `normal`. Gives up, and returns false, after `most` nodes.
    pub fn near(
        &self,
        bounds: Aabb,
        (point, normal): (Vec3, Vec3),
        margin: f32,
        most: usize,
        mut each: impl FnMut(PolygonId),
    ) -> bool {
        let grown = Aabb {
            min: bounds.min - margin,
            max: bounds.max + margin,
        };
        let steepness = normal.abs();
        let mut index = 0;
        let mut visits = 0;
        while let Some(node) = self.nodes.get(index) {
            visits += 1;
            if visits > most {
                return false;
            }
            // The margin is far above the rounding of these sums.
            let Aabb { min, max } = node.bounds;
            let misses_box = !(min.cmple(grown.max) & max.cmpge(grown.min)).all();
            if misses_box
                || normal.dot((min + max) * 0.5 - point).abs()
                    > steepness.dot((max - min) * 0.5) + margin
            {
                index = node.skip as usize;
                continue;
            }
            let range = node.first as usize..(node.first + node.count) as usize;
            for (&polygon, bounds) in self.order[range.clone()].iter().zip(&self.boxes[range]) {
                if (bounds.min.cmple(grown.max) & bounds.max.cmpge(grown.min)).all() {
                    each(PolygonId(polygon));
                }
            }
            index += 1;
        }
        true
    }
}

/// Ten bits of each coordinate of a point in the unit cube, interleaved.
fn morton(point: Vec3) -> u32 {
    let spread = |x: f32| {
        let mut bits = ((x + 0.5) * 1023.0) as u32 & 1023;
        for (shift, mask) in [
            (16, 0x0300_00ff),
            (8, 0x0300_f00f),
            (4, 0x030c_30c3),
            (2, 0x0924_9249),
        ] {
            bits = (bits | bits << shift) & mask;
        }
        bits
    };
    spread(point.x) | spread(point.y) << 1 | spread(point.z) << 2
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bits_interleave() {
        assert_eq!(morton(Vec3::splat(0.5)), (1 << 30) - 1);
        assert_eq!(morton(Vec3::new(0.5, -0.5, -0.5)), 0x0924_9249);
        assert_eq!(morton(Vec3::splat(-0.5)), 0);
    }
}
