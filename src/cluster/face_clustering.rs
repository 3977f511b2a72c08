//! Face clustering by contraction of the dual graph (paper, section 3.1; Garland 1999).
//!
//! A priority queue holds the links between neighbouring pieces of surface; the cheapest is
//! contracted until each connected surface is one piece, whose history is its binary tree.
//!
//! Costs only grow as pieces grow (but for the outline term, the least of them), so a link whose
//! pieces have changed is not updated at once: when it reaches the head of the queue it is
//! evaluated again and put back if it became dearer. Each piece keeps its links in a list that is
//! joined in constant time; parallel links are folded into one when they are met. So a surface with
//! thousands of neighbours costs no more than its links.

use super::forest::Forest;
use super::surface_measure::{Cost, CostScale, SurfaceMeasure};
use super::welded_edges::Link;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// End of a linked list.
const NONE: u32 = u32::MAX;

/// Contracts the dual graph given by `links` (indices below `measures.len()`) and adds one tree
/// for each connected surface to `forest`, whose leaves are the facets: or several, where joining
/// them would spread normals by more than `widest` radians about their mean.
pub(super) fn cluster_faces(
    measures: Vec<SurfaceMeasure>,
    links: &[Link],
    scale: CostScale,
    widest: f64,
    forest: &mut Forest,
) {
    let last_step = Cost::widest(widest);
    let mut contraction = Contraction::new(measures, links, scale);
    let mut queue: BinaryHeap<Reverse<(Cost, u32)>> = (0..links.len() as u32)
        .map(|link| Reverse((contraction.evaluate(link).1, link)))
        .collect::<Vec<_>>()
        .into();
    while let Some(Reverse((cost, link))) = queue.pop() {
        if cost.flatness() > last_step {
            break;
        }
        let Some(fresh) = contraction.refresh(link) else {
            continue;
        };
        if fresh {
            contraction.contract(link, cost, forest);
        } else {
            let now = contraction.evaluate(link).1;
            if now > cost {
                queue.push(Reverse((now, link)));
            } else {
                contraction.contract(link, cost, forest);
            }
        }
    }
}

struct Contraction {
    scale: CostScale,
    /// Of each slot; a union takes over the slot of its first part.
    measures: Vec<SurfaceMeasure>,
    /// Union-find over slots.
    parent: Vec<u32>,
    /// Tree node of each slot's piece, which names the state of the piece: it changes at each union.
    node: Vec<u32>,
    /// Greatest flatness step met in each slot's tree.
    flatness: Vec<u8>,
    /// Slots at the two ends of each link.
    ends: Vec<[u32; 2]>,
    /// Tree nodes at the two ends when the link was last evaluated.
    seen: Vec<[u32; 2]>,
    length: Vec<f64>,
    alive: Vec<bool>,
    /// Lists of half-links (link * 2 + end) of each slot.
    head: Vec<u32>,
    tail: Vec<u32>,
    next: Vec<u32>,
    /// Upper bound of each list's length.
    degree: Vec<u32>,
}

impl Contraction {
    fn new(measures: Vec<SurfaceMeasure>, links: &[Link], scale: CostScale) -> Self {
        let count = measures.len();
        let mut this = Self {
            scale,
            measures,
            parent: (0..count as u32).collect(),
            node: (0..count as u32).collect(),
            flatness: vec![0; count],
            ends: links.iter().map(|l| [l.a, l.b]).collect(),
            seen: links.iter().map(|l| [l.a, l.b]).collect(),
            length: links.iter().map(|l| l.length).collect(),
            alive: vec![true; links.len()],
            head: vec![NONE; count],
            tail: vec![NONE; count],
            next: vec![NONE; 2 * links.len()],
            degree: vec![0; count],
        };
        for (index, link) in links.iter().enumerate() {
            for (end, slot) in [link.a as usize, link.b as usize].into_iter().enumerate() {
                let half = (2 * index + end) as u32;
                match this.tail[slot] {
                    NONE => this.head[slot] = half,
                    tail => this.next[tail as usize] = half,
                }
                this.tail[slot] = half;
                this.degree[slot] += 1;
            }
        }
        this
    }

    /// The slot that now holds what was in `slot`.
    fn find(&mut self, slot: u32) -> u32 {
        let mut at = slot;
        while self.parent[at as usize] != at {
            // Path halving.
            let above = self.parent[self.parent[at as usize] as usize];
            self.parent[at as usize] = above;
            at = above;
        }
        at
    }

    /// Brings a link's ends up to date. `None` when it is gone, otherwise whether its last
    /// evaluation still holds.
    fn refresh(&mut self, link: u32) -> Option<bool> {
        let index = link as usize;
        if !self.alive[index] {
            return None;
        }
        let [a, b] = self.ends[index];
        let (a, b) = (self.find(a), self.find(b));
        if a == b {
            self.alive[index] = false;
            return None;
        }
        self.ends[index] = [a, b];
        let nodes = [self.node[a as usize], self.node[b as usize]];
        let fresh = self.seen[index] == nodes;
        if !fresh {
            self.seen[index] = nodes;
            self.fold_parallel(link);
        }
        Some(fresh)
    }

    /// Adds the lengths of all links parallel to `link`, whose ends are up to date, and drops them.
    fn fold_parallel(&mut self, link: u32) {
        let [a, b] = self.ends[link as usize];
        let (here, there) = if self.degree[a as usize] <= self.degree[b as usize] {
            (a, b)
        } else {
            (b, a)
        };
        let mut previous = NONE;
        let mut half = self.head[here as usize];
        let mut kept = 0;
        while half != NONE {
            let following = self.next[half as usize];
            let other_link = half / 2;
            if self.keep_half(half, here, there, link) {
                previous = half;
                kept += 1;
            } else {
                self.alive[other_link as usize] = false;
                match previous {
                    NONE => self.head[here as usize] = following,
                    _ => self.next[previous as usize] = following,
                }
            }
            half = following;
        }
        self.tail[here as usize] = previous;
        self.degree[here as usize] = kept;
    }

    /// Whether a half-link stays in the list of `here` while `link` to `there` is being folded.
    fn keep_half(&mut self, half: u32, here: u32, there: u32, link: u32) -> bool {
        let index = (half / 2) as usize;
        if !self.alive[index] {
            return false;
        }
        if index == link as usize {
            return true;
        }
        let far_slot = self.ends[index][1 - (half & 1) as usize];
        let far = self.find(far_slot);
        if far == here {
            return false;
        }
        if far == there {
            self.length[link as usize] += self.length[index];
            return false;
        }
        true
    }

    /// The union along a link whose ends are up to date, and its cost.
    fn evaluate(&self, link: u32) -> (SurfaceMeasure, Cost) {
        let [a, b] = self.ends[link as usize].map(|slot| &self.measures[slot as usize]);
        let union = a.union(b, self.length[link as usize], &self.scale);
        (union, SurfaceMeasure::cost(a, b, &union, &self.scale))
    }

    /// Joins the two ends of a link.
    fn contract(&mut self, link: u32, cost: Cost, forest: &mut Forest) {
        let [a, b] = self.ends[link as usize].map(|slot| slot as usize);
        self.measures[a] = self.evaluate(link).0;
        self.alive[link as usize] = false;
        self.parent[b] = a as u32;
        self.flatness[a] = (cost.flatness().min(0xff) as u8)
            .max(self.flatness[a])
            .max(self.flatness[b]);
        let (low, high) = (
            self.node[a].min(self.node[b]),
            self.node[a].max(self.node[b]),
        );
        self.node[a] = forest.join([low, high], self.flatness[a]);
        match (self.tail[a], self.head[b]) {
            (_, NONE) => {}
            (NONE, head) => {
                self.head[a] = head;
                self.tail[a] = self.tail[b];
            }
            (tail, head) => {
                self.next[tail as usize] = head;
                self.tail[a] = self.tail[b];
            }
        }
        self.degree[a] += self.degree[b];
    }
}
