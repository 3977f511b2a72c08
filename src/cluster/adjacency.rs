//! Which facets are neighbours: the dual graph of the surface (paper, section 3.1).
//!
//! Two facets are neighbours when they share an edge and run along it in opposite directions, so
//! that both fronts lie on the same side of the surface. Vertices are welded first, for this
//! purpose only. The two sides of one polygon are never neighbours, though they share three edges.

use super::t_junction::link_t_junctions;
use super::welded_edges::{HalfEdge, LINKS_PER_HALF_EDGE, Link, WeldedEdges};
use crate::scene::{Facet, Scene};
use glam::DVec3;

/// The links of `facets`, sorted by facet, one for each pair of neighbours. Vertices within
/// `weld` of each other, in the units of the scene's positions, count as one.
pub fn link_neighbours(scene: &Scene, facets: &[Facet], weld: f64) -> Vec<Link> {
    let edges = WeldedEdges::new(scene, facets, weld);
    let mut links = Vec::with_capacity(edges.half_edges.len() / 2);
    let mut matched = vec![false; edges.half_edges.len()];
    let mut start = 0;
    for run in edges.half_edges.chunk_by(HalfEdge::same_edge) {
        let (before, end) = (links.len(), start + run.len());
        link_edge(&edges, run, &mut links);
        mark_matched(run, &links[before..], &mut matched[start..end]);
        start = end;
    }
    link_t_junctions(&edges, &matched, weld, &mut links);
    merge_parallel(links)
}

/// Marks the half-edges of `run` whose facets occur in `links`.
fn mark_matched(run: &[HalfEdge], links: &[Link], matched: &mut [bool]) {
    if let ([first, second], [_]) = (run, links) {
        debug_assert!(first.reversed != second.reversed);
        matched.fill(true);
        return;
    }
    let mut linked: Vec<u32> = links.iter().flat_map(|l| [l.a, l.b]).collect();
    linked.sort_unstable();
    for (half_edge, matched) in run.iter().zip(matched) {
        *matched = linked.binary_search(&half_edge.facet).is_ok();
    }
}

/// One link for each pair, the shared lengths added.
fn merge_parallel(mut links: Vec<Link>) -> Vec<Link> {
    links.sort_by_key(|l| (l.a, l.b));
    links.dedup_by(|later, kept| {
        let same = (later.a, later.b) == (kept.a, kept.b);
        if same {
            kept.length += later.length;
        }
        same
    });
    links
}

/// Links the facets that run along one edge in opposite directions.
fn link_edge(edges: &WeldedEdges, run: &[HalfEdge], links: &mut Vec<Link>) {
    let split = run.partition_point(|h| !h.reversed);
    let (forward, reversed) = run.split_at(split);
    if forward.is_empty() || reversed.is_empty() {
        return;
    }
    let length = edges
        .position(run[0].low)
        .distance(edges.position(run[0].high));
    if forward.len() * reversed.len() <= LINKS_PER_HALF_EDGE * run.len() {
        for f in forward {
            for r in reversed {
                links.extend(edges.link(f.facet, r.facet, length));
            }
        }
    } else {
        link_flattest(edges, forward, reversed, length, links);
    }
}

/// Links each facet of a crowded edge with those on the other side that continue it most flatly.
fn link_flattest(
    edges: &WeldedEdges,
    forward: &[HalfEdge],
    reversed: &[HalfEdge],
    length: f64,
    links: &mut Vec<Link>,
) {
    let origin = edges.position(forward[0].low);
    let along = (edges.position(forward[0].high) - origin).normalize_or_zero();
    let (right, up) = along.any_orthonormal_pair();
    let by_angle = |side: &[HalfEdge]| -> Vec<(f64, u32)> {
        let mut list: Vec<_> = side
            .iter()
            .map(|h| {
                let facet = edges.facets[h.facet as usize];
                let centroid = edges
                    .scene
                    .corners(facet.polygon)
                    .iter()
                    .map(|c| c.as_dvec3())
                    .sum::<DVec3>()
                    / 3.0;
                let away = centroid - origin;
                (turn(away.dot(right), away.dot(up)), h.facet)
            })
            .collect();
        list.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        list
    };
    let (forward, reversed) = (by_angle(forward), by_angle(reversed));
    let mut pairs = Vec::new();
    for (from, to) in [(&forward, &reversed), (&reversed, &forward)] {
        for &(angle, facet) in from {
            let opposite = (angle + 2.0) % 4.0;
            let here = to.partition_point(|x| x.0 < opposite) + to.len();
            // Two on each side of the flat continuation: one of them may be the facet's own back.
            for candidate in here - 2..here + 2 {
                let other = to[candidate % to.len()].1;
                pairs.push((facet.min(other), facet.max(other)));
            }
        }
    }
    pairs.sort_unstable();
    pairs.dedup();
    links.extend(pairs.iter().filter_map(|&(a, b)| edges.link(a, b, length)));
}

/// A number in [0, 4) that grows with the angle of (x, y) and gains 2 in half a turn: the angle of
/// a point on a square, which needs no trigonometry.
fn turn(x: f64, y: f64) -> f64 {
    let sum = x.abs() + y.abs();
    if sum == 0.0 {
        return 0.0;
    }
    match (x >= 0.0, y >= 0.0) {
        (true, true) => y / sum,
        (false, true) => 1.0 - x / sum,
        (false, false) => 2.0 - y / sum,
        (true, false) => (4.0 + y / sum) % 4.0,
    }
}
