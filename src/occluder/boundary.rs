//! Boundaries of oriented surfaces: sums of directed edges in which opposite edges cancel.

/// A directed edge between vertex indices.
pub(super) type DirectedEdge = [u32; 2];

/// Cancels every edge against an opposite one and drops edges without length. What is left is the
/// boundary of the surface, each edge as often as it counts, in ascending order.
pub(super) fn cancel(mut edges: Vec<DirectedEdge>) -> Vec<DirectedEdge> {
    edges.retain(|[a, b]| a != b);
    edges.sort_unstable_by_key(|&[a, b]| (a.min(b), a.max(b), a > b));
    let undirected = |[a, b]: DirectedEdge| (a.min(b), a.max(b));
    let mut kept = Vec::new();
    for same in edges.chunk_by(|&x, &y| undirected(x) == undirected(y)) {
        let (low, high) = undirected(same[0]);
        let up = same.iter().filter(|[a, b]| a < b).count();
        let down = same.len() - up;
        kept.extend(std::iter::repeat_n([low, high], up.saturating_sub(down)));
        kept.extend(std::iter::repeat_n([high, low], down.saturating_sub(up)));
    }
    kept
}

/// The vertices that `edges` touch, ascending.
pub(super) fn vertices(edges: &[DirectedEdge]) -> Vec<u32> {
    let mut touched: Vec<u32> = edges.iter().flatten().copied().collect();
    touched.sort_unstable();
    touched.dedup();
    touched
}
