//! Neighbours across T-junctions, where an edge lies on part of another.
//!
//! Two different welded edges that overlap along a line have a vertex of one inside the other, so
//! the vertices on each edge are found first and the edges at those vertices compared with it. Only
//! half-edges without a partner on their own edge look for one here; a mesh without cracks, borders
//! or T-junctions costs nothing.

use super::point_tree::PointTree;
use super::welded_edges::{HalfEdge, LINKS_PER_HALF_EDGE, Link, WeldedEdges};
use glam::DVec3;
use std::ops::Range;

/// Tree nodes and edges looked at for a half-edge, on average, before the search ends: a soup of
/// separate triangles needs about 40, and only input made to be nasty (a million long triangles
/// crossing in one plane) comes near.
const WORK_PER_HALF_EDGE: u64 = 256;

/// What keeping an overlap counts for, in the same measure: so at most four are kept for a half-edge,
/// on average, which bounds memory. A T-junction makes one or two.
const WORK_PER_OVERLAP: u64 = 64;

/// A welded edge: the run of its half-edges, and whether some of them are unmatched.
struct Edge {
    run: Range<usize>,
    low: u32,
    high: u32,
    open: bool,
}

/// Two edges that overlap.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
struct Overlap {
    edges: [u32; 2],
    length: f64,
    same_direction: bool,
}

/// Adds the links between facets whose edges overlap by more than the weld distance, in opposite
/// directions, without being the same welded edge, where at least one of the two has no partner on
/// its own edge (`matched`, parallel to the half-edges).
pub(super) fn link_t_junctions(
    welded: &WeldedEdges,
    matched: &[bool],
    weld: f64,
    links: &mut Vec<Link>,
) {
    if matched.iter().all(|&m| m) {
        return;
    }
    let edges = list_edges(&welded.half_edges, matched);
    for overlap in find_overlaps(welded, &edges, weld) {
        let [first, second] = overlap.edges.map(|e| edges[e as usize].run.clone());
        let most = LINKS_PER_HALF_EDGE * (first.len() + second.len());
        let before = links.len();
        for i in first {
            for j in second.clone() {
                let (h, g) = (&welded.half_edges[i], &welded.half_edges[j]);
                let opposite = (h.reversed != g.reversed) == overlap.same_direction;
                if opposite && !(matched[i] && matched[j]) && links.len() - before < most {
                    links.extend(welded.link(h.facet, g.facet, overlap.length));
                }
            }
        }
    }
}

fn list_edges(half_edges: &[HalfEdge], matched: &[bool]) -> Vec<Edge> {
    let mut edges = Vec::with_capacity(half_edges.len() / 2);
    let mut start = 0;
    for run in half_edges.chunk_by(HalfEdge::same_edge) {
        let range = start..start + run.len();
        start = range.end;
        edges.push(Edge {
            open: !matched[range.clone()].iter().all(|&m| m),
            run: range,
            low: run[0].low,
            high: run[0].high,
        });
    }
    edges
}

/// All overlapping pairs of different edges of which at least one is open, each once, in order.
fn find_overlaps(welded: &WeldedEdges, edges: &[Edge], weld: f64) -> Vec<Overlap> {
    let at_vertex = EdgesAtVertex::new(edges, welded.scene.positions.len());
    let mut marked = vec![false; welded.scene.positions.len()];
    for edge in edges.iter().filter(|e| e.open) {
        marked[edge.low as usize] = true;
        marked[edge.high as usize] = true;
    }
    let used = (0..marked.len() as u32).filter(|&v| !at_vertex.of(v).is_empty());
    let tree = PointTree::new(&welded.scene.positions, used.collect(), &marked);
    let mut overlaps = Vec::new();
    let mut near = Vec::new();
    let mut work = WORK_PER_HALF_EDGE * welded.half_edges.len() as u64;
    for (index, edge) in edges.iter().enumerate() {
        let segment = Segment::new(welded.position(edge.low), welded.position(edge.high));
        let visited = tree.near_segment(segment.ends(), weld, !edge.open, &mut near);
        work = work.saturating_sub(visited);
        near.retain(|&v| segment.holds_inside(welded.position(v), weld));
        for &vertex in &near {
            let candidates = at_vertex.of(vertex);
            work = work.saturating_sub(candidates.len() as u64);
            for &other in candidates {
                let (a, b) = (other.min(index as u32), other.max(index as u32));
                let candidate = &edges[other as usize];
                if !(edge.open || candidate.open) {
                    continue;
                }
                let ends = [candidate.low, candidate.high].map(|v| welded.position(v));
                if let Some((length, same_direction)) = segment.overlap(ends, weld) {
                    work = work.saturating_sub(WORK_PER_OVERLAP);
                    overlaps.push(Overlap {
                        edges: [a, b],
                        length,
                        same_direction,
                    });
                }
            }
            if work == 0 {
                break;
            }
        }
        if work == 0 {
            break;
        }
    }
    // Found from either edge, the length may differ in its last bits: the least is kept.
    overlaps.sort_by(|x, y| x.edges.cmp(&y.edges).then(x.length.total_cmp(&y.length)));
    overlaps.dedup_by_key(|o| o.edges);
    overlaps
}

/// The edges that end at each vertex.
struct EdgesAtVertex {
    first: Vec<u32>,
    edges: Vec<u32>,
}

impl EdgesAtVertex {
    fn new(edges: &[Edge], vertex_count: usize) -> Self {
        let mut first = vec![0_u32; vertex_count + 1];
        for edge in edges {
            first[edge.low as usize + 1] += 1;
            first[edge.high as usize + 1] += 1;
        }
        for vertex in 0..vertex_count {
            first[vertex + 1] += first[vertex];
        }
        let mut cursor = first.clone();
        let mut list = vec![0; 2 * edges.len()];
        for (index, edge) in edges.iter().enumerate() {
            for vertex in [edge.low, edge.high] {
                let place = &mut cursor[vertex as usize];
                list[*place as usize] = index as u32;
                *place += 1;
            }
        }
        Self { first, edges: list }
    }

    fn of(&self, vertex: u32) -> &[u32] {
        let vertex = vertex as usize;
        &self.edges[self.first[vertex] as usize..self.first[vertex + 1] as usize]
    }
}

/// A segment by start, unit direction and length.
struct Segment {
    start: DVec3,
    end: DVec3,
    direction: DVec3,
    length: f64,
}

impl Segment {
    fn new(start: DVec3, end: DVec3) -> Self {
        Self {
            start,
            end,
            direction: (end - start).normalize_or_zero(),
            length: start.distance(end),
        }
    }

    fn ends(&self) -> [DVec3; 2] {
        [self.start, self.end]
    }

    fn along(&self, point: DVec3) -> f64 {
        (point - self.start).dot(self.direction)
    }

    fn distance_squared(&self, point: DVec3) -> f64 {
        let nearest = self.start + self.direction * self.along(point).clamp(0.0, self.length);
        nearest.distance_squared(point)
    }

    /// Whether a point lies on the segment, farther than `weld` from its ends.
    fn holds_inside(&self, point: DVec3, weld: f64) -> bool {
        let along = self.along(point);
        along > weld && along < self.length - weld && self.distance_squared(point) <= weld * weld
    }

    /// The length of the overlap with another segment, if over `weld`, and whether that one runs
    /// the same way. Over the overlap the two keep within `weld` of each other.
    fn overlap(&self, other: [DVec3; 2], weld: f64) -> Option<(f64, bool)> {
        let [p, q] = other.map(|end| self.along(end));
        let (from, to) = (p.min(q).max(0.0), p.max(q).min(self.length));
        if to - from <= weld {
            return None;
        }
        let other = Self::new(other[0], other[1]);
        let close = [from, to].into_iter().all(|along| {
            let point = self.start + self.direction * along;
            other.distance_squared(point) <= weld * weld
        });
        close.then_some((to - from, p < q))
    }
}
