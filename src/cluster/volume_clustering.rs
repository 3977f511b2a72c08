//! Volume clusters: a binary tree of boxes above unconnected pieces (paper, section 4).
//!
//! Mueller et al. 1999 choose the volumes that make the boxes' areas least. The same measure, each
//! box weighted with the facets in it, is the surface area heuristic of ray tracing; we minimise it
//! from the top over binned splits (Wald 2007), which is n log n for any number of pieces.

use super::forest::Forest;
use crate::math::Aabb;
use glam::Vec3;

/// Candidate planes an axis, plus one: Wald 2007 finds no gain beyond 16.
const BINS: usize = 16;

/// A piece to be joined.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Its root in the forest.
    pub root: u32,
    /// Its box.
    pub bounds: Aabb,
    /// Facets in it.
    pub facets: u32,
}

/// Joins all pieces into one tree, whose joins are given `flatness`, and returns its root. There is
/// at least one piece.
pub(super) fn cluster_volumes(pieces: &mut [Piece], flatness: u8, forest: &mut Forest) -> u32 {
    // Beyond this depth splits are by count, so that no arrangement of boxes makes a deep tree.
    let patience = 2 * pieces.len().max(2).ilog2() + 8;
    join(pieces, patience, flatness, forest)
}

fn join(pieces: &mut [Piece], patience: u32, flatness: u8, forest: &mut Forest) -> u32 {
    if let [piece] = pieces {
        return piece.root;
    }
    let middle = match (patience, best_split(pieces)) {
        (1.., Some((axis, border))) => partition(pieces, |p| bin_centre(p)[axis] < border),
        _ => halve(pieces),
    };
    let (left, right) = pieces.split_at_mut(middle);
    let patience = patience.saturating_sub(1);
    let children = [
        join(left, patience, flatness, forest),
        join(right, patience, flatness, forest),
    ];
    forest.join(children, flatness)
}

fn bin_centre(piece: &Piece) -> Vec3 {
    piece.bounds.centre()
}

/// The axis and coordinate of the split with the least area times count; `None` where all centres
/// coincide.
fn best_split(pieces: &[Piece]) -> Option<(usize, f32)> {
    let centres = Aabb::from_points(pieces.iter().map(bin_centre));
    let extent = centres.max - centres.min;
    let mut best: Option<(f32, usize, f32)> = None;
    for axis in 0..3 {
        let (low, size) = (centres.min[axis], extent[axis]);
        let border = |plane: usize| low + size * (plane as f32 / BINS as f32);
        // Borders that rounding makes one would leave a side empty.
        if border(1) <= low || border(BINS - 1) > centres.max[axis] {
            continue;
        }
        let mut boxes = [Aabb::EMPTY; BINS];
        let mut counts = [0_u64; BINS];
        for piece in pieces {
            let centre = bin_centre(piece)[axis];
            let mut bin = (((centre - low) / size * BINS as f32) as usize).min(BINS - 1);
            // The bin must agree with the comparison that partitions, to the last bit.
            while bin > 0 && centre < border(bin) {
                bin -= 1;
            }
            while bin + 1 < BINS && centre >= border(bin + 1) {
                bin += 1;
            }
            boxes[bin] = boxes[bin].union(piece.bounds);
            counts[bin] += u64::from(piece.facets);
        }
        let mut above = [(0.0_f32, 0_u64); BINS];
        let (mut bounds, mut count) = (Aabb::EMPTY, 0);
        for plane in (1..BINS).rev() {
            bounds = bounds.union(boxes[plane]);
            count += counts[plane];
            above[plane] = (bounds.surface_area(), count);
        }
        let (mut bounds, mut count) = (Aabb::EMPTY, 0);
        for plane in 1..BINS {
            bounds = bounds.union(boxes[plane - 1]);
            count += counts[plane - 1];
            let (area, rest) = above[plane];
            if count == 0 || rest == 0 {
                continue;
            }
            let cost = bounds.surface_area() * count as f32 + area * rest as f32;
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, border(plane)));
            }
        }
    }
    best.map(|(_, axis, border)| (axis, border))
}

/// Moves the pieces for which `first` holds to the front, keeping order, and returns their number.
fn partition(pieces: &mut [Piece], first: impl Fn(&Piece) -> bool) -> usize {
    pieces.sort_by_key(|p| !first(p));
    pieces.partition_point(first)
}

/// Splits by count along the widest axis.
fn halve(pieces: &mut [Piece]) -> usize {
    let centres = Aabb::from_points(pieces.iter().map(bin_centre));
    let extent = centres.max - centres.min;
    let axis = extent.max_position();
    pieces.sort_by(|p, q| {
        bin_centre(p)[axis]
            .total_cmp(&bin_centre(q)[axis])
            .then(p.root.cmp(&q.root))
    });
    pieces.len() / 2
}
