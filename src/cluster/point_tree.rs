//! A balanced tree of boxes over points, to find those close to a segment.

use crate::math::Aabb;
use glam::{DVec3, Vec3};

/// Points in a leaf: testing a few points costs about what testing a box does.
const LEAF: usize = 8;

/// A tree over points that are named by indices into an array of positions.
pub(super) struct PointTree<'a> {
    positions: &'a [Vec3],
    points: Vec<u32>,
    nodes: Vec<PointNode>,
}

struct PointNode {
    bounds: Aabb,
    /// Some point below is marked.
    marked: bool,
    /// Range of points.
    first: u32,
    count: u32,
    /// The second child; the first stands right behind the node. Zero for a leaf.
    second: u32,
}

impl<'a> PointTree<'a> {
    /// A tree over `points`, of which those with `marked` can be asked for alone.
    pub fn new(positions: &'a [Vec3], points: Vec<u32>, marked: &[bool]) -> Self {
        let mut tree = Self {
            positions,
            nodes: Vec::with_capacity(points.len() / 2),
            points,
        };
        if !tree.points.is_empty() {
            tree.grow(0, tree.points.len(), marked);
        }
        tree
    }

    fn grow(&mut self, first: usize, end: usize, marked: &[bool]) {
        let positions = self.positions;
        let points = &mut self.points[first..end];
        let bounds = Aabb::from_points(points.iter().map(|&p| positions[p as usize]));
        let node = self.nodes.len();
        self.nodes.push(PointNode {
            bounds,
            marked: points.iter().any(|&p| marked[p as usize]),
            first: first as u32,
            count: points.len() as u32,
            second: 0,
        });
        if points.len() > LEAF {
            let axis = (bounds.max - bounds.min).max_position();
            let middle = points.len() / 2;
            points.select_nth_unstable_by(middle, |&p, &q| {
                let (x, y) = (positions[p as usize][axis], positions[q as usize][axis]);
                x.total_cmp(&y).then(p.cmp(&q))
            });
            self.grow(first, first + middle, marked);
            self.nodes[node].second = self.nodes.len() as u32;
            self.grow(first + middle, end, marked);
        }
    }

    /// Puts the points whose distance to the segment is at most `reach` into `found`, and possibly
    /// others nearby that fill a leaf: only marked leaves when `only_marked`. Returns the nodes visited.
    pub fn near_segment(
        &self,
        [start, end]: [DVec3; 2],
        reach: f64,
        only_marked: bool,
        found: &mut Vec<u32>,
    ) -> u64 {
        found.clear();
        let (middle, half) = (0.5 * (start + end), 0.5 * (end - start));
        let mut visited = 0;
        let mut open = [0_u32; 64];
        let mut height = usize::from(!self.nodes.is_empty());
        while height > 0 {
            height -= 1;
            let at = open[height] as usize;
            let node = &self.nodes[at];
            visited += 1;
            if (only_marked && !node.marked) || !meets(node.bounds, reach, middle, half) {
                continue;
            }
            if node.second == 0 {
                let first = node.first as usize;
                found.extend(&self.points[first..first + node.count as usize]);
            } else {
                open[height] = node.second;
                open[height + 1] = at as u32 + 1;
                height += 2;
            }
        }
        visited
    }
}

/// Whether a segment, by its middle and half-vector, may meet a box grown by `reach`: separating
/// axes of the box and of box and segment.
fn meets(bounds: Aabb, reach: f64, middle: DVec3, half: DVec3) -> bool {
    let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
    let extent = 0.5 * (high - low) + reach;
    let away = middle - 0.5 * (low + high);
    let reach_along = half.abs();
    if away.abs().cmpgt(extent + reach_along).any() {
        return false;
    }
    let across = DVec3::new(
        extent.y * reach_along.z + extent.z * reach_along.y,
        extent.z * reach_along.x + extent.x * reach_along.z,
        extent.x * reach_along.y + extent.y * reach_along.x,
    );
    half.cross(away).abs().cmple(across).all()
}
