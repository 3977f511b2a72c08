//! Which sides of polygons see each other, as far as probe rays tell: a union-find over sides.

use super::facet::{Facet, Side};
use crate::math::PolygonId;

/// Index of a side: twice its polygon, plus one for the back.
pub(super) type SideIndex = u32;

/// The index of a side.
pub(super) fn side_index(polygon: PolygonId, side: Side) -> SideIndex {
    polygon.0 * 2 + u32::from(side == Side::Back)
}

/// The side at an index.
pub(super) fn facet_at(index: SideIndex) -> Facet {
    Facet {
        polygon: PolygonId(index / 2),
        side: if index.is_multiple_of(2) {
            Side::Front
        } else {
            Side::Back
        },
    }
}

/// Sides joined into groups that light can reach each other in (Tarjan 1975, with path halving).
/// The root of a group is its least member, whatever the order of joins.
pub(super) struct SideGraph {
    parent: Vec<SideIndex>,
}

impl SideGraph {
    /// Every one of `sides` sides on its own.
    pub fn new(sides: usize) -> Self {
        Self {
            parent: (0..sides as SideIndex).collect(),
        }
    }

    /// Joins the groups of two sides.
    pub fn join(&mut self, a: SideIndex, b: SideIndex) {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
    }

    /// The least member of the group of `side`.
    pub fn root(&mut self, mut side: SideIndex) -> SideIndex {
        while self.parent[side as usize] != side {
            let above = self.parent[self.parent[side as usize] as usize];
            self.parent[side as usize] = above;
            side = above;
        }
        side
    }

    /// The root of every side, for many readers at once.
    pub fn roots(&mut self) -> Vec<SideIndex> {
        (0..self.parent.len() as SideIndex)
            .map(|side| self.root(side))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_have_their_least_member_as_root() {
        let mut graph = SideGraph::new(8);
        for (a, b) in [(7, 5), (5, 3), (6, 2), (2, 4), (4, 7)] {
            graph.join(a, b);
        }
        assert_eq!(graph.roots(), [0, 1, 2, 2, 2, 2, 2, 2]);
    }

    #[test]
    fn indices_and_sides_correspond() {
        for index in 0..6 {
            let facet = facet_at(index);
            assert_eq!(side_index(facet.polygon, facet.side), index);
        }
        assert_eq!(facet_at(3).side, Side::Back);
    }
}
