//! Which patches meet at a vertex: by a corner, or by an edge on which a finer neighbour has one.

use super::panel::{Panels, position_key};
use std::collections::HashMap;

/// Levels of splits across one edge that are followed; a 2^12-fold finer neighbour is invisible.
const EDGE_LEVELS: u32 = 12;

/// A patch at a vertex.
#[derive(Clone, Copy)]
pub(super) struct Incident {
    /// Index of the patch.
    pub leaf: u32,
    /// 0 to 2 for a corner, 3 to 5 for the inside of an edge.
    pub slot: u8,
    /// Place on the edge, in (0, 1); 0 for a corner.
    pub along: f32,
}

/// The patches around every vertex, by corner or by edge.
pub(super) struct IncidentTable {
    first: Vec<u32>,
    incidents: Vec<Incident>,
}

impl IncidentTable {
    /// Finds the patches around every vertex of `panels`.
    pub fn new(panels: &Panels) -> Self {
        let index: HashMap<[u64; 3], u32> = (0u32..)
            .zip(&panels.positions)
            .map(|(v, &p)| (position_key(p), v))
            .collect();
        let mut found: Vec<(u32, Incident)> = Vec::with_capacity(4 * panels.leaves.len());
        for (l, leaf) in (0u32..).zip(&panels.leaves) {
            for slot in 0..3u8 {
                let from = leaf.corners[usize::from(slot)];
                let to = leaf.corners[(usize::from(slot) + 1) % 3];
                found.push((
                    from,
                    Incident {
                        leaf: l,
                        slot,
                        along: 0.0,
                    },
                ));
                let mut edge = Edge {
                    panels,
                    index: &index,
                    leaf: l,
                    slot: 3 + slot,
                    found: &mut found,
                };
                edge.search(from, to, (0.0, 1.0), EDGE_LEVELS);
            }
        }
        // Stable: within a vertex in the order of the patches.
        found.sort_by_key(|&(vertex, _)| vertex);
        let mut first = vec![0u32; panels.positions.len() + 1];
        for (vertex, _) in &found {
            first[*vertex as usize + 1] += 1;
        }
        for i in 1..first.len() {
            first[i] += first[i - 1];
        }
        Self {
            first,
            incidents: found.into_iter().map(|(_, i)| i).collect(),
        }
    }

    /// Those around a vertex, in the order of the patches.
    pub fn of(&self, vertex: usize) -> &[Incident] {
        &self.incidents[self.first[vertex] as usize..self.first[vertex + 1] as usize]
    }
}

/// An edge of a patch, searched for vertices of finer neighbours. Splits halve edges exactly, so
/// such vertices stand at midpoints, bit by bit, and none stands below a midpoint that is none.
struct Edge<'a> {
    panels: &'a Panels,
    index: &'a HashMap<[u64; 3], u32>,
    leaf: u32,
    slot: u8,
    found: &'a mut Vec<(u32, Incident)>,
}

impl Edge<'_> {
    fn search(&mut self, from: u32, to: u32, (start, end): (f32, f32), levels: u32) {
        let at = |v: u32| self.panels.positions[v as usize];
        let middle = position_key(0.5 * (at(from) + at(to)));
        let Some(&vertex) = self.index.get(&middle) else {
            return;
        };
        if levels == 0 || vertex == from || vertex == to {
            return;
        }
        let along = 0.5 * (start + end);
        self.found.push((
            vertex,
            Incident {
                leaf: self.leaf,
                slot: self.slot,
                along,
            },
        ));
        self.search(from, vertex, (start, along), levels - 1);
        self.search(vertex, to, (along, end), levels - 1);
    }
}
