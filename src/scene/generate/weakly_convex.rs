//! Triangulation of flat, weakly convex polygons: corners in the middle of a side are allowed.

use glam::DVec3;

/// Triangles (turning like the polygon) that cover `polygon`, a list of indices into `positions`.
/// Every corner is kept; of all triangulations, the one whose worst triangle is best shaped.
pub fn triangulate(polygon: &[usize], positions: &[DVec3]) -> Vec<[usize; 3]> {
    let n = polygon.len();
    // best[i][j]: worst and summed shape of the part cut off by the chord from corner i to corner
    // j > i, and the corner that the chord's triangle reaches.
    let mut best = vec![vec![(f64::INFINITY, 0.0, 0); n]; n];
    for span in 2..n {
        for i in 0..n - span {
            let j = i + span;
            best[i][j] = (i + 1..j)
                .map(|k| {
                    let own = shape([polygon[i], polygon[k], polygon[j]], positions);
                    let (left, right) = (best[i][k], best[k][j]);
                    (left.0.min(right.0).min(own), left.1 + right.1 + own, k)
                })
                .fold((-1.0, 0.0, 0), |best, next| {
                    if (next.0, next.1) > (best.0, best.1) {
                        next
                    } else {
                        best
                    }
                });
        }
    }
    let mut triangles = Vec::with_capacity(n.saturating_sub(2));
    let mut chords = vec![(0, n - 1)];
    while let Some((i, j)) = chords.pop() {
        if j - i > 1 {
            let k = best[i][j].2;
            triangles.push([polygon[i], polygon[k], polygon[j]]);
            chords.extend([(i, k), (k, j)]);
        }
    }
    triangles
}

/// Four times the area over the sum of the squared sides: 0 for a line, 0.58 for an equilateral
/// triangle.
fn shape(triangle: [usize; 3], positions: &[DVec3]) -> f64 {
    let [a, b, c] = triangle.map(|i| positions[i]);
    let squares = (b - a).length_squared() + (c - b).length_squared() + (a - c).length_squared();
    let shape = 2.0 * (b - a).cross(c - a).length() / squares;
    // What is left of a straight angle after rounding is not a triangle.
    if shape > 1e-9 { shape } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn sides_with_corners_in_their_middle_leave_no_line() {
        // A rectangle 3 x 1 with corners along three of its sides.
        let positions: Vec<DVec3> = [
            (0.0, 0.0),
            (1.0, 0.0),
            (2.5, 0.0),
            (3.0, 0.0),
            (3.0, 1.0),
            (2.0, 1.0),
            (0.0, 1.0),
            (0.0, 0.7),
            (0.0, 0.2),
        ]
        .map(|(x, y)| dvec3(x, y, 4.0))
        .to_vec();
        let polygon: Vec<usize> = (0..positions.len()).collect();
        for turn in 0..polygon.len() {
            let mut turned = polygon.clone();
            turned.rotate_left(turn);
            let triangles = triangulate(&turned, &positions);
            assert_eq!(triangles.len(), polygon.len() - 2);
            let mut total = 0.0;
            for [a, b, c] in triangles {
                let cross = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
                assert!(cross.z > 1e-3);
                total += cross.z / 2.0;
            }
            assert!((total - 3.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_triangle_with_many_corners_on_one_side_keeps_its_apex() {
        let mut positions: Vec<DVec3> = (0..6).map(|i| dvec3(f64::from(i), 0.0, 0.0)).collect();
        positions.push(dvec3(2.0, 3.0, 0.0));
        let triangles = triangulate(&[0, 1, 2, 3, 4, 5, 6], &positions);
        assert_eq!(triangles.len(), 5);
        assert!(triangles.iter().all(|t| t.contains(&6)));
    }
}
