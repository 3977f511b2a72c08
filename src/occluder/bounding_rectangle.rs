//! The smallest bounding rectangle of a footprint, by rotating calipers.
//!
//! The paper tries some ten orientations (section 3.2); one side of the smallest rectangle lies
//! along an edge of the convex hull, so trying those is exact.

use glam::DVec2;

/// Hull edges tried: the longest. A hull with more edges is a rounded shape, whose orientation
/// hardly matters; a wall's is decided by its few long edges.
const MAX_DIRECTIONS: usize = 64;

/// Areas this close, relatively, count as equal; the first of the longest edges wins. Far above the
/// f32 rounding of a wall's vertices, far below a difference that matters.
const TIE: f64 = 1.0e-3;

/// Unit direction of one side of the smallest rectangle around the points of `edges`; `None` for
/// fewer than three points off one line. Of rectangles that are equal up to [`TIE`], the one along
/// the longest hull edge; of the four sides, the one nearest to `towards`, so that the answer does
/// not depend on the order or number of the edges.
pub(super) fn smallest_rectangle_axis(edges: &[[DVec2; 2]], towards: DVec2) -> Option<DVec2> {
    let hull = convex_hull(edges.iter().flatten().copied().collect());
    if hull.len() < 3 {
        return None;
    }
    let mut directions: Vec<DVec2> = (0..hull.len())
        .map(|i| hull[(i + 1) % hull.len()] - hull[i])
        .collect();
    directions.sort_by(|a, b| b.length_squared().total_cmp(&a.length_squared()));
    directions.truncate(MAX_DIRECTIONS);
    let mut best: Option<(f64, DVec2)> = None;
    for direction in directions {
        let axis = direction.normalize();
        let area = extent(&hull, axis) * extent(&hull, axis.perp());
        if best.is_none_or(|(least, _)| area < least * (1.0 - TIE)) {
            best = Some((area, axis));
        }
    }
    let (_, axis) = best?;
    [axis, axis.perp(), -axis, -axis.perp()]
        .into_iter()
        .max_by(|a, b| a.dot(towards).total_cmp(&b.dot(towards)))
}

fn extent(hull: &[DVec2], axis: DVec2) -> f64 {
    let (low, high) = hull
        .iter()
        .map(|p| axis.dot(*p))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), d| {
            (low.min(d), high.max(d))
        });
    high - low
}

/// Convex hull, counter-clockwise, without collinear points (Andrew's monotone chain). Rounding may
/// misplace a nearly collinear point: harmless, the hull only suggests directions.
fn convex_hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut hull = half_hull(points.iter());
    hull.extend(half_hull(points.iter().rev()));
    hull
}

/// The chain below and to the right of the points in the order given, without its last point.
fn half_hull<'a>(points: impl Iterator<Item = &'a DVec2>) -> Vec<DVec2> {
    let mut chain: Vec<DVec2> = Vec::new();
    for &p in points {
        while let [.., a, b] = chain[..]
            && (b - a).perp_dot(p - a) <= 0.0
        {
            chain.pop();
        }
        chain.push(p);
    }
    chain.pop();
    chain
}
