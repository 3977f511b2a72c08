//! Interpolation in a patch whose edges carry more values than its corners do.
//!
//! Where neighbours are split further, an edge meets several of their vertices, and a patch that
//! ignored them would show a crack. Mean value coordinates (Floater 2003; Hormann and Floater 2006
//! for any polygon) interpolate all values on the border: linear along each piece of an edge, so
//! neighbours agree there, smooth inside, and exact for linear functions.

/// A value on the border of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BorderValue {
    /// Barycentric weights of the place.
    pub weights: [f64; 3],
    /// What is interpolated, one a channel.
    pub value: [f64; 3],
}

/// Distance from the border, in edges of the patch, below which a place lies on it: far below a
/// pixel, far above the rounding of f64.
const ON_BORDER: f64 = 1.0e-12;

/// The value at barycentric `weights` inside the polygon of `border` values, which stand
/// counter-clockwise and include the corners.
pub(crate) fn interpolate(border: &[BorderValue], weights: [f64; 3]) -> [f64; 3] {
    // Mean value coordinates need lengths and angles: any fixed triangle will do, since affine maps
    // keep what linear functions are, and the border's pieces.
    let place = |w: [f64; 3]| [w[1] + 0.5 * w[2], w[2]];
    let [x, y] = place(weights);
    let towards = |b: &BorderValue| {
        let [bx, by] = place(b.weights);
        (bx - x, by - y)
    };
    let n = border.len();
    // Tangent of half the angle under which the piece from each value to its next is seen.
    let piece = |i: usize| -> Result<f64, [f64; 3]> {
        let (a, b) = (&border[i], &border[(i + 1) % n]);
        let ((ax, ay), (bx, by)) = (towards(a), towards(b));
        let (ra, rb) = (ax.hypot(ay), bx.hypot(by));
        let (sine, cosine) = (ax * by - ay * bx, ax * bx + ay * by);
        if sine <= ON_BORDER * ra.max(rb) && cosine <= 0.0 {
            let share = if ra + rb > 0.0 { ra / (ra + rb) } else { 0.0 };
            return Err(std::array::from_fn(|c| {
                a.value[c] * (1.0 - share) + b.value[c] * share
            }));
        }
        // Two forms of the same tangent; each cancels where the other is used.
        Ok(if cosine >= 0.0 {
            sine / (ra * rb + cosine)
        } else {
            (ra * rb - cosine) / sine
        })
    };
    let (mut sums, mut total) = ([0.0; 3], 0.0);
    let mut before = match piece(n - 1) {
        Ok(tangent) => tangent,
        Err(value) => return value,
    };
    for (i, b) in border.iter().enumerate() {
        let after = match piece(i) {
            Ok(tangent) => tangent,
            Err(value) => return value,
        };
        let (bx, by) = towards(b);
        let weight = (before + after) / bx.hypot(by);
        for (sum, value) in sums.iter_mut().zip(b.value) {
            *sum += weight * value;
        }
        total += weight;
        before = after;
    }
    sums.map(|sum| sum / total)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn border(value: impl Fn([f64; 3]) -> f64) -> Vec<BorderValue> {
        [
            [1.0, 0.0, 0.0],
            [0.5, 0.5, 0.0],
            [0.25, 0.75, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
            [0.125, 0.0, 0.875],
        ]
        .map(|weights| BorderValue {
            weights,
            value: [value(weights), 1.0, 0.0],
        })
        .to_vec()
    }

    fn grid() -> impl Iterator<Item = [f64; 3]> {
        (0..=64).flat_map(|i| {
            (0..=64 - i).map(move |j| {
                let (v, w) = (f64::from(i) / 64.0, f64::from(j) / 64.0);
                [1.0 - v - w, v, w]
            })
        })
    }

    #[test]
    fn linear_functions_are_exact() {
        let linear = |w: [f64; 3]| 3.0 * w[0] - 2.0 * w[1] + 7.0 * w[2];
        let border = border(linear);
        for w in grid() {
            let [value, one, zero] = interpolate(&border, w);
            assert!((value - linear(w)).abs() < 1e-9, "{w:?}: {value}");
            assert!((one - 1.0).abs() < 1e-12 && zero == 0.0);
        }
    }

    #[test]
    fn values_stay_between_the_least_and_the_greatest() {
        let border = border(|w| if w[0] == 0.5 { 1.0 } else { 0.0 });
        for w in grid() {
            let [value, ..] = interpolate(&border, w);
            assert!((-1e-12..=1.0 + 1e-12).contains(&value), "{w:?}: {value}");
        }
    }

    #[test]
    fn the_border_is_linear_between_its_values() {
        let border = border(|w| if w[0] == 0.5 { 1.0 } else { 0.0 });
        // Approaching the edge from inside and standing on it give the same.
        for off in [0.0, 1e-13, 1e-11, 1e-9, 1e-8] {
            let [value, ..] = interpolate(&border, [0.375 - off, 0.625, off]);
            assert!((value - 0.5).abs() < 1e-6, "{off}: {value}");
        }
        let [value, ..] = interpolate(&border, [0.5, 0.5, 0.0]);
        assert_eq!(value, 1.0);
    }
}
