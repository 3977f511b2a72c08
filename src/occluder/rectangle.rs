//! Axis-aligned rectangles of the plane, and exact predicates on edges.

use glam::DVec2;
use robust::{Coord, orient2d};

/// A closed axis-aligned rectangle in the axes of the turned footprint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Rectangle {
    pub min: DVec2,
    pub max: DVec2,
}

impl Rectangle {
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }

    /// Area; zero when turned inside out.
    pub fn area(&self) -> f64 {
        let size = self.size().max(DVec2::ZERO);
        size.x * size.y
    }

    pub fn centre(&self) -> DVec2 {
        0.5 * (self.min + self.max)
    }

    /// True when `other` lies wholly inside.
    pub fn contains(&self, other: &Self) -> bool {
        self.min.cmple(other.min).all() && other.max.cmple(self.max).all()
    }

    /// Area common to both.
    pub fn overlap(&self, other: &Self) -> f64 {
        let common = Self {
            min: self.min.max(other.min),
            max: self.max.min(other.max),
        };
        common.area()
    }

    /// This rectangle with every side moved inwards; perhaps turned inside out.
    #[must_use]
    pub fn inset(&self, by: DVec2) -> Self {
        Self {
            min: self.min + by,
            max: self.max - by,
        }
    }

    /// True when the segment meets the interior, in exact arithmetic: separating axes are the two
    /// of the rectangle and the segment's normal.
    pub fn is_crossed_by(&self, [a, b]: [DVec2; 2]) -> bool {
        let (low, high) = (a.min(b), a.max(b));
        if low.cmpge(self.max).any() || high.cmple(self.min).any() {
            return false;
        }
        if a == b {
            return true;
        }
        let corners = [
            self.min,
            DVec2::new(self.max.x, self.min.y),
            self.max,
            DVec2::new(self.min.x, self.max.y),
        ];
        let sides = corners.map(|c| side(a, b, c));
        sides.iter().any(|&s| s > 0.0) && sides.iter().any(|&s| s < 0.0)
    }
}

/// Positive where `c` is left of `a -> b`, negative right, zero on the line: exactly.
fn side(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    let coord = |p: DVec2| Coord { x: p.x, y: p.y };
    orient2d(coord(a), coord(b), coord(c))
}

/// How often an edge counts for a point: +1 where it crosses the ray from the point to the right
/// upwards, -1 downwards. The lower end belongs to an edge, the upper does not.
pub(super) fn ray_crossing([a, b]: [DVec2; 2], point: DVec2) -> i32 {
    if a.y <= point.y && point.y < b.y {
        i32::from(side(a, b, point) > 0.0)
    } else if b.y <= point.y && point.y < a.y {
        -i32::from(side(a, b, point) < 0.0)
    } else {
        0
    }
}

/// Winding number of closed curves, given as directed edges, about a point that is on none.
pub(super) fn winding(edges: &[[DVec2; 2]], point: DVec2) -> i32 {
    edges.iter().map(|&edge| ray_crossing(edge, point)).sum()
}

/// Area of the union of rectangles, by cutting the plane along all their sides.
pub(super) fn union_area(rectangles: &[Rectangle]) -> f64 {
    let mut columns: Vec<f64> = rectangles.iter().flat_map(|r| [r.min.x, r.max.x]).collect();
    columns.sort_unstable_by(f64::total_cmp);
    columns
        .windows(2)
        .map(|column| {
            let middle = 0.5 * (column[0] + column[1]);
            let mut spans: Vec<[f64; 2]> = rectangles
                .iter()
                .filter(|r| r.min.x < middle && middle < r.max.x)
                .map(|r| [r.min.y, r.max.y])
                .collect();
            spans.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]));
            let mut reached = f64::NEG_INFINITY;
            let mut length = 0.0;
            for [low, high] in spans {
                length += (high - low.max(reached)).max(0.0);
                reached = reached.max(high);
            }
            length * (column[1] - column[0])
        })
        .sum()
}
