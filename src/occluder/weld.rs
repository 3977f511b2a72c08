//! Closing cracks: boundary edges that run back to back within the weld distance cancel.
//!
//! Both steps move edges of the boundary a little and so add thin strips to the surface (see
//! [`super::sheet`]): a vertex moved by at most [`VERTEX_SHARE`] w carries its edges along in strips
//! that stay within that distance of the edges; an edge bent through a vertex at most
//! [`EDGE_SHARE`] w beside it adds a triangle within that distance of the (moved) edge. Every point
//! of every strip is then within (VERTEX_SHARE + EDGE_SHARE) w of the polygons: below w by enough
//! that a planar sheet, which deviates at most w/4, still leaves sqrt(0.95^2 + 0.25^2) < 0.983 (see
//! [`super::footprint`]).

use super::boundary::{DirectedEdge, cancel, vertices};
use super::point_grid::PointGrid;
use glam::{DVec2, DVec3};

/// Vertices nearer than this fraction of w become one. A little more than [`EDGE_SHARE`], so that a
/// vertex beside the end of an edge, which cannot split it, is welded to that end.
const VERTEX_SHARE: f64 = 0.5;

/// A vertex nearer than this fraction of w to an edge splits it: a T-junction. So cracks up to this
/// wide close for certain, and none wider than both shares together.
const EDGE_SHARE: f64 = 0.45;

/// What is left of a boundary once cracks are closed.
pub(super) struct Welded {
    /// Edges between the same positions as before.
    pub boundary: Vec<DirectedEdge>,
    /// How far strips really stray from the polygons: 0 where all matched exactly, at most 0.95 w.
    pub reach: f64,
}

/// The part of `boundary` that is not closed by an opposite edge within the weld distance; `weld` is
/// w in the unit of `positions`.
pub(super) fn close_cracks(positions: &[DVec3], boundary: &[DirectedEdge], weld: f64) -> Welded {
    let touched = vertices(boundary);
    let flat: Vec<DVec2> = touched
        .iter()
        .map(|&v| positions[v as usize].truncate())
        .collect();
    let place = |i: u32| positions[touched[i as usize] as usize];
    let grid = PointGrid::new(&flat);

    // The first vertex of a neighbourhood stands for it; chains do not drift, for only a vertex
    // that stands for itself attracts others.
    let mut stands_for: Vec<u32> = (0..touched.len() as u32).collect();
    let reach = VERTEX_SHARE * weld;
    let (mut moved, mut bent) = (0.0f64, 0.0f64);
    for i in 0..touched.len() as u32 {
        let mut first = i;
        grid.near_segment(flat[i as usize], flat[i as usize], reach, |j| {
            if j < first && stands_for[j as usize] == j && place(i).distance(place(j)) <= reach {
                first = j;
            }
        });
        moved = moved.max(place(i).distance(place(first)));
        stands_for[i as usize] = first;
    }
    let compact = |v: u32| touched.partition_point(|&t| t < v) as u32;
    let welded = cancel(
        boundary
            .iter()
            .map(|edge| edge.map(|v| stands_for[compact(v) as usize]))
            .collect(),
    );

    let reach = EDGE_SHARE * weld;
    let mut split: Vec<DirectedEdge> = Vec::with_capacity(welded.len());
    let mut between: Vec<(f64, u32)> = Vec::new();
    for [a, b] in welded {
        let (start, along) = (place(a), place(b) - place(a));
        between.clear();
        grid.near_segment(flat[a as usize], flat[b as usize], reach, |v| {
            if v == a || v == b || stands_for[v as usize] != v {
                return;
            }
            let t = (place(v) - start).dot(along) / along.length_squared();
            let beside = (start + along * t).distance(place(v));
            if t > 0.0 && t < 1.0 && beside <= reach {
                bent = bent.max(beside);
                between.push((t, v));
            }
        });
        between.sort_unstable_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let mut from = a;
        for &(_, v) in &between {
            split.push([from, v]);
            from = v;
        }
        split.push([from, b]);
    }
    Welded {
        boundary: cancel(split)
            .into_iter()
            .map(|edge| edge.map(|i| touched[i as usize]))
            .collect(),
        reach: moved + bent,
    }
}
