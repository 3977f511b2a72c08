//! A quadtree over a footprint: where growing may start.
//!
//! Paper, section 3.2: every cell is crossed by edges, or wholly inside, or wholly outside.

use super::footprint::Footprint;
use super::rectangle::{Rectangle, ray_crossing};
use glam::DVec2;

/// Each side of a cell is moved in by this share of its length before edges are looked for, so that
/// contours jagged at rounding do not cut the cells that they merely touch. The paper shrinks a
/// growing rectangle by as much for the same reason.
const INSET: f64 = 1.0e-3;

/// Deepest level: cells of 1/256 of the bounding rectangle's sides.
const MAX_DEPTH: u32 = 8;

/// The interior cells of the quadtree over `bounds`, largest first, then by place, each moved
/// inwards by [`INSET`]. Cells smaller than `min_area` are not looked at.
pub(super) fn interior_cells(
    footprint: &Footprint,
    bounds: Rectangle,
    min_area: f64,
) -> Vec<Rectangle> {
    let all: Vec<u32> = (0..footprint.edges.len() as u32).collect();
    let mut empty = Vec::new();
    subdivide(footprint, bounds, &all, MAX_DEPTH, min_area, &mut empty);
    let mut interior = covered(footprint, empty);
    interior.sort_by(|a, b| {
        let by_area = b.area().total_cmp(&a.area());
        // Cells of one level differ in area by rounding.
        let by_area = if (a.area() - b.area()).abs() < 1.0e-6 * a.area() {
            std::cmp::Ordering::Equal
        } else {
            by_area
        };
        by_area
            .then(a.min.y.total_cmp(&b.min.y))
            .then(a.min.x.total_cmp(&b.min.x))
    });
    interior
}

/// Collects the leaves that no edge crosses.
fn subdivide(
    footprint: &Footprint,
    cell: Rectangle,
    edges: &[u32],
    depth: u32,
    min_area: f64,
    empty: &mut Vec<Rectangle>,
) {
    let core = cell.inset(INSET * cell.size());
    let crossing: Vec<u32> = edges
        .iter()
        .copied()
        .filter(|&edge| core.is_crossed_by(footprint.edges[edge as usize]))
        .collect();
    if crossing.is_empty() {
        empty.push(core);
        return;
    }
    if depth == 0 || cell.area() < 4.0 * min_area {
        return;
    }
    // The inset of a child reaches a little beyond its parent's, so it needs all edges near it.
    let near: Vec<u32> = edges
        .iter()
        .copied()
        .filter(|&edge| cell.is_crossed_by(footprint.edges[edge as usize]))
        .collect();
    let centre = cell.centre();
    for upper in 0..4 {
        let (x, y) = (upper & 1 == 1, upper & 2 == 2);
        let quarter = Rectangle {
            min: DVec2::new(
                if x { centre.x } else { cell.min.x },
                if y { centre.y } else { cell.min.y },
            ),
            max: DVec2::new(
                if x { cell.max.x } else { centre.x },
                if y { cell.max.y } else { centre.y },
            ),
        };
        subdivide(footprint, quarter, &near, depth - 1, min_area, empty);
    }
}

/// The cells whose centre is covered. Centres share few heights (2^(depth + 1)), so the edges that
/// cross a height are gathered once.
fn covered(footprint: &Footprint, mut cells: Vec<Rectangle>) -> Vec<Rectangle> {
    cells.sort_by(|a, b| a.centre().y.total_cmp(&b.centre().y));
    let mut interior = Vec::new();
    for row in cells.chunk_by(|a, b| a.centre().y == b.centre().y) {
        let height = row[0].centre().y;
        let crossing: Vec<[DVec2; 2]> = footprint
            .edges
            .iter()
            .copied()
            .filter(|[a, b]| (a.y <= height) != (b.y <= height))
            .collect();
        interior.extend(row.iter().copied().filter(|cell| {
            let winding = crossing
                .iter()
                .map(|&edge| ray_crossing(edge, cell.centre()))
                .sum();
            footprint.covers(winding)
        }));
    }
    interior
}
