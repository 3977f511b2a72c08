//! Where a solid stands on a surface: there the surface is hidden, though nothing lies in front of it by
//! more than tau. Rays that are trimmed by tau (see [`crate::visibility`]) would start inside the solid, so
//! samples ask here instead. And which sides lie wholly on others, that receive their light.

use super::facet::Facet;
use super::side_graph::{SideIndex, side_index};
use crate::math::Aabb;
use glam::{DVec3, Vec3};

/// Which parts of which sides are hidden by solids that touch them.
#[derive(Clone, Debug, Default)]
pub struct Contacts {
    /// `nodes[first[side]..first[side + 1]]` are those of a side; empty where nothing touches anything.
    first: Vec<u32>,
    nodes: Vec<Node>,
    covers: Vec<Cover>,
    /// Sides whose whole area others own, ascending.
    covered: Vec<SideIndex>,
}

/// A node of a tree of boxes, in depth-first order.
#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Aabb,
    /// The node after this one's descendants.
    skip: u32,
    /// Index of a cover, or [`INNER`].
    cover: u32,
}

/// Marks nodes that hold no cover of their own.
const INNER: u32 = u32::MAX;

/// A triangle that hides what lies in it: inside are the points with `normal . p >= offset` for each edge.
#[derive(Clone, Copy, Debug)]
struct Cover([(Vec3, f32); 3]);

impl Cover {
    /// The triangle grown by `margin` in its plane.
    fn new(corners: [Vec3; 3], margin: f32) -> Self {
        let [a, b, c] = corners.map(Vec3::as_dvec3);
        let normal = (b - a).cross(c - a);
        Self([(a, b), (b, c), (c, a)].map(|(from, to): (DVec3, DVec3)| {
            let inwards = normal.cross(to - from).normalize_or_zero();
            let offset = inwards.dot(from) - f64::from(margin);
            (inwards.as_vec3(), offset as f32)
        }))
    }

    fn holds(&self, point: Vec3) -> bool {
        let Self(edges) = self;
        edges
            .iter()
            .all(|(inwards, offset)| inwards.dot(point) >= *offset)
    }
}

impl Contacts {
    /// The same with the sides whose whole area others own, ascending.
    #[must_use]
    pub(super) fn with_covered(self, covered: Vec<SideIndex>) -> Self {
        Self { covered, ..self }
    }

    /// Whether other sides that face the same way in the same plane own the whole of this one: what arrives here,
    /// they receive.
    pub fn is_covered(&self, facet: Facet) -> bool {
        let side = side_index(facet.polygon, facet.side);
        self.covered.binary_search(&side).is_ok()
    }

    /// From pairs of a side and a triangle that hides it there, sorted by side. Points within `margin` of
    /// a triangle count as hidden, so that none is lost between two of them.
    pub(super) fn new(sides: usize, pairs: &[(SideIndex, [Vec3; 3])], margin: f32) -> Self {
        let mut contacts = Self::default();
        if pairs.is_empty() {
            return contacts;
        }
        contacts.covers = pairs.iter().map(|p| Cover::new(p.1, margin)).collect();
        contacts.first.reserve(sides + 1);
        let mut rest = pairs;
        for side in 0..sides as SideIndex {
            contacts.first.push(contacts.nodes.len() as u32);
            let count = rest.partition_point(|p| p.0 == side);
            let mut items: Vec<(Aabb, u32)> = Vec::with_capacity(count);
            for (i, (_, corners)) in rest[..count].iter().enumerate() {
                let Aabb { min, max } = Aabb::from_points(*corners);
                let grown = Aabb {
                    min: min - margin,
                    max: max + margin,
                };
                items.push((grown, (pairs.len() - rest.len() + i) as u32));
            }
            rest = &rest[count..];
            if !items.is_empty() {
                contacts.add(&mut items);
            }
        }
        contacts.first.push(contacts.nodes.len() as u32);
        contacts
    }

    /// Adds a tree over `items`, halved along the longest side of their box.
    fn add(&mut self, items: &mut [(Aabb, u32)]) {
        let index = self.nodes.len();
        let bounds = items.iter().fold(Aabb::EMPTY, |all, i| all.union(i.0));
        let single = items.len() == 1;
        self.nodes.push(Node {
            bounds,
            skip: 0,
            cover: if single { items[0].1 } else { INNER },
        });
        if !single {
            let extent = bounds.max - bounds.min;
            let axis = extent.max_position();
            items.sort_by(|(a, i), (b, j)| {
                let (a, b) = (a.centre()[axis], b.centre()[axis]);
                a.total_cmp(&b).then(i.cmp(j))
            });
            let (left, right) = items.split_at_mut(items.len() / 2);
            self.add(left);
            self.add(right);
        }
        self.nodes[index].skip = self.nodes.len() as u32;
    }

    /// True when some part of a side of `facet` is hidden that lies in `bounds`.
    pub fn touches(&self, facet: Facet, bounds: &Aabb) -> bool {
        let range = self.range(facet);
        !range.is_empty() && self.nodes[range.start].bounds.distance(*bounds) <= 0.0
    }

    /// True when some part of a side of `facet` is hidden.
    pub fn touches_any(&self, facet: Facet) -> bool {
        !self.range(facet).is_empty()
    }

    /// True when `point`, on `facet`, is hidden by a solid that stands on it.
    pub fn is_hidden(&self, facet: Facet, point: Vec3) -> bool {
        let range = self.range(facet);
        let mut index = range.start;
        while index < range.end {
            let node = &self.nodes[index];
            if !node.bounds.contains(point) {
                index = node.skip as usize;
                continue;
            }
            if node.cover != INNER && self.covers[node.cover as usize].holds(point) {
                return true;
            }
            index += 1;
        }
        false
    }

    fn range(&self, facet: Facet) -> std::ops::Range<usize> {
        let side = side_index(facet.polygon, facet.side) as usize;
        match self.first.get(side..side + 2) {
            Some(&[from, to]) => from as usize..to as usize,
            _ => 0..0,
        }
    }
}
