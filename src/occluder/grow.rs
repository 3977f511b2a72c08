//! Growing rectangles from interior cells (paper, section 3.2 and Fig. 2).

use super::footprint::Footprint;
use super::quadtree::interior_cells;
use super::rectangle::Rectangle;
use glam::DVec2;

/// After growing along the first axis, the rectangle gives up this share of its length there, so
/// that an edge slightly out of line with the axes does not stop it along the second (the paper's
/// figure, footnote 2).
const SHRINK: f64 = 1.0e-3;

/// Clearance from the edges, for the rounding of the clipped ends: a few operations on numbers
/// below 2.
const CLEARANCE: f64 = 1.0e-14;

/// Grows at most `count` rectangles of at least `min_area` over the footprint, in the order found.
/// `slack` is the length that may be lost at a side to edges slightly out of line.
pub(super) fn grow_rectangles(
    footprint: &Footprint,
    bounds: Rectangle,
    count: usize,
    min_area: f64,
    slack: f64,
) -> Vec<Rectangle> {
    // A rectangle of the least area holds a cell of about a sixteenth of it wherever it lies.
    let cells = interior_cells(footprint, bounds, min_area / 16.0);
    let mut marked = vec![false; cells.len()];
    let mut unmarked_area: f64 = cells.iter().map(Rectangle::area).sum();
    let mut grown = Vec::new();
    for seed in 0..cells.len() {
        if grown.len() == count || unmarked_area < min_area {
            break;
        }
        if marked[seed] {
            continue;
        }
        let rectangle = grow(footprint, bounds, cells[seed], slack);
        marked[seed] = true;
        unmarked_area -= cells[seed].area();
        for (cell, mark) in cells.iter().zip(&mut marked) {
            if !*mark && rectangle.contains(&cell.inset(DVec2::splat(slack))) {
                *mark = true;
                unmarked_area -= cell.area();
            }
        }
        if rectangle.area() >= min_area {
            grown.push(rectangle);
        }
    }
    grown
}

/// The larger of the two rectangles that start along one axis and along the other.
fn grow(footprint: &Footprint, bounds: Rectangle, seed: Rectangle, slack: f64) -> Rectangle {
    let [first, second] = [0, 1].map(|axis| {
        let mut rectangle = expand(footprint, bounds, seed, axis);
        // The first round gives up the paper's share; the others regain it but for the slack.
        let shares = [SHRINK * rectangle.size()[axis], slack, slack, slack];
        for (round, share) in shares.into_iter().enumerate() {
            let along = if round % 2 == 0 { axis } else { 1 - axis };
            let give = DVec2::AXES[along] * share;
            rectangle = expand(footprint, bounds, rectangle.inset(give), 1 - along);
        }
        // Edges exactly in line cost nothing.
        expand(footprint, bounds, rectangle, 1 - axis)
    });
    larger(first, second)
}

fn larger(first: Rectangle, second: Rectangle) -> Rectangle {
    if second.area() > first.area() {
        second
    } else {
        first
    }
}

/// `rectangle` stretched both ways along `axis` to the nearest edges.
fn expand(
    footprint: &Footprint,
    bounds: Rectangle,
    rectangle: Rectangle,
    axis: usize,
) -> Rectangle {
    let across = 1 - axis;
    let (low, high) = (rectangle.min[across], rectangle.max[across]);
    let middle = rectangle.centre()[axis];
    let (mut left, mut right) = (bounds.min[axis], bounds.max[axis]);
    for &[a, b] in &footprint.edges {
        let (a, b) = if a[across] <= b[across] {
            (a, b)
        } else {
            (b, a)
        };
        if a[across] >= high || b[across] <= low {
            continue;
        }
        let at = |height: f64| {
            let t = (height - a[across]) / (b[across] - a[across]);
            a[axis] + t * (b[axis] - a[axis])
        };
        let start = if a[across] < low { at(low) } else { a[axis] };
        let end = if b[across] > high { at(high) } else { b[axis] };
        let (near, far) = (start.min(end), start.max(end));
        if near + far > 2.0 * middle {
            right = right.min(near - CLEARANCE);
        } else {
            left = left.max(far + CLEARANCE);
        }
    }
    let mut stretched = rectangle;
    // Never less than before: what stood free of edges stays.
    stretched.min[axis] = left.min(rectangle.min[axis]);
    stretched.max[axis] = right.max(rectangle.max[axis]);
    stretched
}
