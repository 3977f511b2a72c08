//! The boundary of a cluster as a chain of directed edges, for surfaces that are not flat within the
//! weld distance: where no edge of it enters a rectangle, the surface crosses the rectangle's slab
//! equally often everywhere, and if that is not zero no segment gets through.
//!
//! Written apart from the extraction, which argues the same way (`occluder::sheet`).

use super::flat_polygon::{SLACK, box_of, boxes_meet};
use glam::{DVec2, DVec3};
use std::collections::BTreeMap;

/// A triangle in the coordinates of the slab, oriented as its facet is.
pub(super) type FrameTriangle = [DVec3; 3];

/// Vertices nearer than this share of the weld distance are one, and a vertex as near to an edge
/// splits it; both together stay below the weld distance.
const WELD_SHARE: [f64; 2] = [0.5, 0.45];

/// What is left of a boundary near a region, and how far welding strayed from it.
pub(super) struct Boundary {
    pub edges: Vec<[DVec3; 2]>,
    pub reach: f64,
}

type Edge = [usize; 2];

/// The boundary of `triangles` where it comes near the box `near`, cracks within the weld distance
/// closed.
pub(super) fn boundary(triangles: &[FrameTriangle], near: [DVec2; 2], weld: f64) -> Boundary {
    let mut places: BTreeMap<[u64; 3], usize> = BTreeMap::new();
    let mut points = Vec::new();
    let mut edges: Vec<Edge> = Vec::new();
    let margin = DVec2::splat(4.0 * weld);
    let wide = [near[0] - margin, near[1] + margin];
    for triangle in triangles {
        if !boxes_meet(box_of(&triangle.map(DVec3::truncate)), wide) {
            continue;
        }
        // Adding zero makes -0 into +0, which are one place.
        let ids = triangle.map(|p| {
            let key = (p + 0.0).to_array().map(f64::to_bits);
            *places.entry(key).or_insert_with(|| {
                points.push(p);
                points.len() - 1
            })
        });
        edges.extend([[ids[0], ids[1]], [ids[1], ids[2]], [ids[2], ids[0]]]);
    }
    let mut left = cancel(&edges);
    left.retain(|e| boxes_meet(box_of(&e.map(|v| points[v].truncate())), wide));
    let mut reach = 0.0;
    if !left.is_empty() {
        (left, reach) = weld_edges(&points, &left, weld);
    }
    Boundary {
        edges: left.iter().map(|e| e.map(|v| points[v])).collect(),
        reach,
    }
}

/// Opposite edges cancel; the rest stands as often as it counts.
fn cancel(edges: &[Edge]) -> Vec<Edge> {
    let mut sums: BTreeMap<Edge, i64> = BTreeMap::new();
    for &[a, b] in edges.iter().filter(|[a, b]| a != b) {
        *sums.entry([a.min(b), a.max(b)]).or_default() += if a < b { 1 } else { -1 };
    }
    sums.into_iter()
        .flat_map(|([a, b], count)| {
            let edge = if count > 0 { [a, b] } else { [b, a] };
            std::iter::repeat_n(edge, count.unsigned_abs() as usize)
        })
        .collect()
}

fn weld_edges(points: &[DVec3], edges: &[Edge], weld: f64) -> (Vec<Edge>, f64) {
    let mut vertices: Vec<usize> = edges.iter().flatten().copied().collect();
    vertices.sort_unstable();
    vertices.dedup();
    // Along the first axis, so that only neighbours are looked at.
    vertices.sort_by(|&a, &b| points[a].x.total_cmp(&points[b].x).then(a.cmp(&b)));
    let [vertex_reach, edge_reach] = WELD_SHARE.map(|share| share * weld);
    let mut stands_for: BTreeMap<usize, usize> = BTreeMap::new();
    let (mut moved, mut bent) = (0.0f64, 0.0f64);
    for (i, &v) in vertices.iter().enumerate() {
        let first = vertices[..i]
            .iter()
            .rev()
            .take_while(|&&u| points[v].x - points[u].x <= vertex_reach)
            .find(|&&u| stands_for[&u] == u && points[u].distance(points[v]) <= vertex_reach);
        let first = first.copied().unwrap_or(v);
        moved = moved.max(points[v].distance(points[first]));
        stands_for.insert(v, first);
    }
    let welded = cancel(
        &edges
            .iter()
            .map(|e| e.map(|v| stands_for[&v]))
            .collect::<Vec<_>>(),
    );
    let mut split = Vec::new();
    for [a, b] in welded {
        let (start, along) = (points[a], points[b] - points[a]);
        let (low, high) = (start.x.min(points[b].x), start.x.max(points[b].x));
        let from = vertices.partition_point(|&v| points[v].x < low - edge_reach);
        let mut between: Vec<(f64, usize)> = Vec::new();
        for &v in vertices[from..]
            .iter()
            .take_while(|&&v| points[v].x <= high + edge_reach)
        {
            if v == a || v == b || stands_for[&v] != v {
                continue;
            }
            let t = (points[v] - start).dot(along) / along.length_squared();
            let beside = (start + along * t).distance(points[v]);
            if t > 0.0 && t < 1.0 && beside <= edge_reach {
                bent = bent.max(beside);
                between.push((t, v));
            }
        }
        between.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        let mut from = a;
        for (_, v) in between {
            split.push([from, v]);
            from = v;
        }
        split.push([from, b]);
    }
    (cancel(&split), moved + bent)
}

/// True when the segment certainly stays outside the convex polygon (counter-clockwise).
pub(super) fn is_outside([p, q]: [DVec2; 2], polygon: &[DVec2]) -> bool {
    let beyond_an_edge = (0..polygon.len()).any(|i| {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        let limit = -SLACK * (b - a).length();
        -(b - a).perp_dot(p - a) >= limit && -(b - a).perp_dot(q - a) >= limit
    });
    let d = q - p;
    let sides = polygon.iter().map(|&c| d.perp_dot(c - p));
    let (low, high) = sides.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| {
        (low.min(s), high.max(s))
    });
    let limit = SLACK * d.length();
    beyond_an_edge || low >= -limit || high <= limit
}

/// How often the surface passes over the point upwards less downwards; `None` where the point is too
/// near an edge to tell.
pub(super) fn degree(triangles: &[FrameTriangle], point: DVec2) -> Option<i64> {
    let mut sum = 0;
    for triangle in triangles {
        let corners = triangle.map(DVec3::truncate);
        let sides: [f64; 3] = std::array::from_fn(|i| {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            let length = (b - a).length();
            (b - a).perp_dot(point - a) / length.max(f64::MIN_POSITIVE)
        });
        if sides.iter().all(|&s| s > SLACK) {
            sum += 1;
        } else if sides.iter().all(|&s| s < -SLACK) {
            sum -= 1;
        } else if !(sides.iter().any(|&s| s > SLACK) && sides.iter().any(|&s| s < -SLACK)) {
            return None;
        }
    }
    Some(sum)
}
