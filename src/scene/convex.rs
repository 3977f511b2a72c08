//! Convex polygons in a plane: clipping, subtracting, measuring. Vertices run counter-clockwise.

use glam::DVec2;

/// Twice the area is summed about the first vertex; the result is not negative.
pub(super) fn area(polygon: &[DVec2]) -> f64 {
    let Some(&origin) = polygon.first() else {
        return 0.0;
    };
    let doubled: f64 = polygon
        .windows(2)
        .map(|edge| (edge[0] - origin).perp_dot(edge[1] - origin))
        .sum();
    0.5 * doubled.abs()
}

/// Length of the outline.
pub(super) fn perimeter(polygon: &[DVec2]) -> f64 {
    (0..polygon.len())
        .map(|i| polygon[i].distance(polygon[(i + 1) % polygon.len()]))
        .sum()
}

/// Puts into `out` the part of `polygon` in which `normal . p >= offset` (Sutherland and Hodgman 1974).
pub(super) fn clip(polygon: &[DVec2], normal: DVec2, offset: f64, out: &mut Vec<DVec2>) {
    out.clear();
    for (i, &p) in polygon.iter().enumerate() {
        let q = polygon[(i + 1) % polygon.len()];
        let (at_p, at_q) = (normal.dot(p) - offset, normal.dot(q) - offset);
        if at_p >= 0.0 {
            out.push(p);
        }
        if (at_p < 0.0 && at_q > 0.0) || (at_p > 0.0 && at_q < 0.0) {
            out.push(p + (q - p) * (at_p / (at_p - at_q)));
        }
    }
}

/// Splits `polygon` by the sides of the convex `cutter`: what lies inside, and convex pieces of what lies outside.
pub(super) fn split(polygon: &[DVec2], cutter: &[DVec2]) -> (Vec<DVec2>, Vec<Vec<DVec2>>) {
    let mut inside = polygon.to_vec();
    let mut outside = Vec::new();
    for i in 0..cutter.len() {
        let (from, to) = (cutter[i], cutter[(i + 1) % cutter.len()]);
        let inwards = (to - from).perp();
        let offset = inwards.dot(from);
        let mut beyond = Vec::with_capacity(inside.len() + 1);
        clip(&inside, -inwards, -offset, &mut beyond);
        let mut within = Vec::with_capacity(inside.len() + 1);
        clip(&inside, inwards, offset, &mut within);
        outside.push(beyond);
        inside = within;
    }
    (inside, outside)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn triangle(corners: [(f64, f64); 3]) -> [DVec2; 3] {
        let [a, b, c] = corners.map(DVec2::from);
        if (b - a).perp_dot(c - a) >= 0.0 {
            [a, b, c]
        } else {
            [a, c, b]
        }
    }

    proptest! {
        #[test]
        fn parts_make_up_the_whole(
            p in prop::array::uniform3((-1.0..1.0f64, -1.0..1.0f64)),
            q in prop::array::uniform3((-1.0..1.0f64, -1.0..1.0f64)),
        ) {
            let (p, q) = (triangle(p), triangle(q));
            let (inside, outside) = split(&p, &q);
            let beyond: f64 = outside.iter().map(|piece| area(piece)).sum();
            prop_assert!((area(&inside) + beyond - area(&p)).abs() < 1e-12);
            // The intersection is the same seen from the other side.
            prop_assert!((area(&split(&q, &p).0) - area(&inside)).abs() < 1e-12);
        }
    }

    #[test]
    fn measures_of_a_square() {
        let square = [(0., 0.), (2., 0.), (2., 2.), (0., 2.)].map(DVec2::from);
        assert_eq!(area(&square), 4.0);
        assert_eq!(perimeter(&square), 8.0);
        let mut half = Vec::new();
        clip(&square, DVec2::X, 1.5, &mut half);
        assert_eq!(area(&half), 1.0);
        assert_eq!(area(&[]), 0.0);
    }
}
