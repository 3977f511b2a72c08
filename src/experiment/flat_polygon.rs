//! Convex polygons of the plane in f64: what the replay of occluders cuts them with.
//!
//! Nothing here is exact. Coordinates are below 2 and take a few dozen operations, so they are wrong
//! by less than 1e-13; whoever uses them leaves a thousand times [`SLACK`].

use glam::DVec2;
use std::f64::consts::TAU;

/// Lengths below this are nothing: ten times what rounding can make.
pub(super) const SLACK: f64 = 1.0e-12;

/// Corners of the polygon that stands for a disc: its inradius is 0.995 of the radius.
const DISC_CORNERS: usize = 32;

/// The convex hull, counter-clockwise; fewer than three points where there is no area (Andrew 1979).
pub(super) fn convex_hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|p, q| p.x.total_cmp(&q.x).then(p.y.total_cmp(&q.y)));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut hull: Vec<DVec2> = Vec::with_capacity(2 * points.len());
    for pass in 0..2 {
        let start = hull.len();
        let ordered: Box<dyn Iterator<Item = &DVec2>> = match pass {
            0 => Box::new(points.iter()),
            _ => Box::new(points.iter().rev()),
        };
        for &p in ordered {
            while hull.len() >= start + 2 {
                let [a, b] = [hull[hull.len() - 2], hull[hull.len() - 1]];
                if (b - a).perp_dot(p - a) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(p);
        }
        hull.pop();
    }
    hull
}

/// All points within `radius` of the polygon, up to half a percent too few.
pub(super) fn grown(polygon: &[DVec2], radius: f64) -> Vec<DVec2> {
    let disc = |i: usize| radius * DVec2::from_angle(TAU * i as f64 / DISC_CORNERS as f64);
    convex_hull(
        polygon
            .iter()
            .flat_map(|&p| (0..DISC_CORNERS).map(move |i| p + disc(i)))
            .collect(),
    )
}

/// The part left of the line from `a` to `b`.
pub(super) fn clip(polygon: &[DVec2], a: DVec2, b: DVec2) -> Vec<DVec2> {
    let side = |p: DVec2| (b - a).perp_dot(p - a);
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (hp, hq) = (side(p), side(q));
        if hp >= 0.0 {
            kept.push(p);
        }
        if (hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0) {
            kept.push(p + (q - p) * (hp / (hp - hq)));
        }
    }
    kept
}

/// What `cutter` leaves of `polygon`, in convex pieces; those thinner than [`SLACK`] are left out.
pub(super) fn subtract(polygon: &[DVec2], cutter: &[DVec2]) -> Vec<Vec<DVec2>> {
    let mut pieces = Vec::new();
    let mut rest = polygon.to_vec();
    for (i, &a) in cutter.iter().enumerate() {
        let b = cutter[(i + 1) % cutter.len()];
        let outside = clip(&rest, b, a);
        if !is_thin(&outside) {
            pieces.push(outside);
        }
        rest = clip(&rest, a, b);
        if is_thin(&rest) {
            return pieces;
        }
    }
    pieces
}

/// True when nothing of any width is left.
pub(super) fn is_thin(polygon: &[DVec2]) -> bool {
    if polygon.len() < 3 {
        return true;
    }
    let mut perimeter = 0.0;
    let mut area = 0.0;
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        perimeter += (q - p).length();
        area += (p - polygon[0]).perp_dot(q - polygon[0]);
    }
    area.abs() <= SLACK * perimeter
}

/// True when `polygon` (counter-clockwise) holds all of `points`.
pub(super) fn contains(polygon: &[DVec2], points: &[DVec2]) -> bool {
    (0..polygon.len()).all(|i| {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        points.iter().all(|&p| (b - a).perp_dot(p - a) >= 0.0)
    })
}

/// Lower and upper corner of the box of the points.
pub(super) fn box_of(points: &[DVec2]) -> [DVec2; 2] {
    points.iter().fold(
        [DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY)],
        |[low, high], &p| [low.min(p), high.max(p)],
    )
}

/// True when two such boxes have a point in common.
pub(super) fn boxes_meet(a: [DVec2; 2], b: [DVec2; 2]) -> bool {
    a[0].cmple(b[1]).all() && b[0].cmple(a[1]).all()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f64, high: f64) -> Vec<DVec2> {
        [(low, low), (high, low), (high, high), (low, high)]
            .map(|(x, y)| DVec2::new(x, y))
            .to_vec()
    }

    fn area(polygon: &[DVec2]) -> f64 {
        (0..polygon.len())
            .map(|i| 0.5 * polygon[i].perp_dot(polygon[(i + 1) % polygon.len()]))
            .sum()
    }

    #[test]
    fn what_is_cut_out_is_missing() {
        let pieces = subtract(&square(0.0, 1.0), &square(0.25, 0.75));
        let left: f64 = pieces.iter().map(|p| area(p)).sum();
        assert!((left - 0.75).abs() < 1e-12);
        assert!(subtract(&square(0.25, 0.75), &square(0.0, 1.0)).is_empty());
        assert!((area(&subtract(&square(0.0, 1.0), &square(2.0, 3.0))[0]) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn growing_reaches_as_far_as_it_says_and_no_farther() {
        let wide = grown(&square(0.0, 1.0), 0.1);
        for p in &wide {
            let outside = (*p - p.clamp(DVec2::ZERO, DVec2::ONE)).length();
            assert!(outside < 0.1 + 1e-12);
        }
        let disc = std::f64::consts::PI * 0.01;
        assert!((area(&wide) - (1.0 + 0.4 + disc)).abs() < 0.01 * disc);
        assert!(contains(&wide, &square(-0.0699, 1.0699)));
    }
}
