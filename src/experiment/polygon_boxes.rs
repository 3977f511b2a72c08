//! Boxes of all polygons in a binary tree, to find those near a pair: for aiming rays, so nothing
//! that is proved rests on it.

use crate::math::{Aabb, PolygonId};
use crate::scene::Scene;
use glam::Vec3;

/// Polygons a leaf.
const LEAF: usize = 8;

struct Node {
    bounds: Aabb,
    /// Where to go on if the box is missed.
    skip: u32,
    /// Range of `order`; empty for inner nodes.
    first: u32,
    count: u32,
}

/// Nodes in depth-first order, split at the median of the longest side.
pub(super) struct PolygonBoxes {
    nodes: Vec<Node>,
    order: Vec<PolygonId>,
    boxes: Vec<Aabb>,
}

impl PolygonBoxes {
    pub fn new(scene: &Scene) -> Self {
        let boxes: Vec<Aabb> = (0..scene.polygons.len())
            .map(|i| Aabb::from_points(scene.corners(PolygonId::new(i))))
            .collect();
        let mut order: Vec<PolygonId> = (0..boxes.len()).map(PolygonId::new).collect();
        let mut tree = Self {
            nodes: Vec::new(),
            order: Vec::new(),
            boxes,
        };
        if !order.is_empty() {
            tree.add(&mut order, 0);
        }
        tree.order = order;
        tree
    }

    fn add(&mut self, order: &mut [PolygonId], first: usize) {
        let bounds = order
            .iter()
            .fold(Aabb::EMPTY, |all, id| all.union(self.boxes[id.index()]));
        let index = self.nodes.len();
        let leaf = order.len() <= LEAF;
        self.nodes.push(Node {
            bounds,
            skip: 0,
            first: first as u32,
            count: if leaf { order.len() as u32 } else { 0 },
        });
        if !leaf {
            let size = bounds.max - bounds.min;
            let axis = (0..3).fold(0, |best, i| if size[i] > size[best] { i } else { best });
            let half = order.len() / 2;
            let boxes = &self.boxes;
            order.select_nth_unstable_by(half, |a, b| {
                let centre = |id: &PolygonId| boxes[id.index()].centre()[axis];
                centre(a).total_cmp(&centre(b)).then(a.cmp(b))
            });
            let (left, right) = order.split_at_mut(half);
            self.add(left, first);
            self.add(right, first + half);
        }
        self.nodes[index].skip = self.nodes.len() as u32;
    }

    /// Appends polygons whose boxes meet `bounds`, at most `most`, in the order of the tree.
    pub fn meeting(&self, bounds: Aabb, most: usize, found: &mut Vec<PolygonId>) {
        let meets = |b: &Aabb| b.min.cmple(bounds.max).all() && b.max.cmpge(bounds.min).all();
        let mut at = 0;
        while at < self.nodes.len() && found.len() < most {
            let node = &self.nodes[at];
            if !meets(&node.bounds) {
                at = node.skip as usize;
                continue;
            }
            let range = node.first as usize..(node.first + node.count) as usize;
            for &id in &self.order[range] {
                if found.len() < most && meets(&self.boxes[id.index()]) {
                    found.push(id);
                }
            }
            at += 1;
        }
    }

    /// Distance from the middle of a polygon's box to the segment, less the box's radius: a rough
    /// order of nearness.
    pub fn distance(&self, id: PolygonId, [from, to]: [Vec3; 2]) -> f32 {
        let bounds = self.boxes[id.index()];
        let centre = bounds.centre();
        (centre - nearest_on_segment(centre, from, to)).length()
            - 0.5 * (bounds.max - bounds.min).length()
    }
}

/// The point of a segment nearest to `x`.
pub(super) fn nearest_on_segment(x: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    let d = to - from;
    let length2 = d.length_squared();
    if length2 > 0.0 {
        from + d * ((x - from).dot(d) / length2).clamp(0.0, 1.0)
    } else {
        from
    }
}

#[cfg(test)]
mod tests {
    use super::super::dice::Dice;
    use super::*;
    use crate::scene::generate::generate;
    use crate::scene::{LoadConfig, load_text};

    #[test]
    fn finds_what_a_scan_finds() {
        let text = generate("cornell-spheres").expect("built in");
        let library = [("cornell-spheres.mtl", text.mtl.as_bytes())];
        let scene =
            load_text("s", text.obj.as_bytes(), &library, &LoadConfig::default()).expect("loads");
        let tree = PolygonBoxes::new(&scene);
        let mut dice = Dice::new(4);
        let mut total = 0;
        for _ in 0..50 {
            let mut point = || Vec3::new(dice.unit(), dice.unit(), dice.unit()) - 0.5;
            let centre = point();
            let half = point().abs() * 0.3;
            let bounds = Aabb {
                min: centre - half,
                max: centre + half,
            };
            let mut found = Vec::new();
            tree.meeting(bounds, usize::MAX, &mut found);
            found.sort();
            let scan: Vec<PolygonId> = (0..scene.polygons.len())
                .map(PolygonId::new)
                .filter(|&id| {
                    let b = Aabb::from_points(scene.corners(id));
                    b.min.cmple(bounds.max).all() && b.max.cmpge(bounds.min).all()
                })
                .collect();
            assert_eq!(found, scan);
            total += found.len();
        }
        assert!(total > 100);
    }
}
