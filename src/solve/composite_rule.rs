//! Composite quadrature on a receiving triangle: the degree-2 rule of three points on each of 1, 4
//! or 16 equal parts.

use super::solution::split_triangle;
use glam::Vec3;
use std::sync::LazyLock;

/// Points of a rule, eight at a time; lanes past the count repeat the last point.
#[derive(Clone, Debug)]
pub struct CompositeRule {
    /// Points that count.
    pub count: usize,
    /// Barycentric coordinates of the points, `[coordinate][lane]`.
    pub octets: Vec<[[f32; 8]; 3]>,
}

/// The rules on 1, 4 and 16 parts.
static RULES: LazyLock<[CompositeRule; 3]> = LazyLock::new(|| [0, 1, 2].map(CompositeRule::new));

/// Most points of a rule.
pub const MOST_POINTS: usize = 48;

impl CompositeRule {
    /// The rule on 4^splits parts, for 0 to 2 splits. The one on a single part carries the centroid as a fourth
    /// point that does not count.
    pub fn on_parts(splits: usize) -> &'static Self {
        &RULES[splits]
    }

    fn new(splits: u32) -> Self {
        let mut points = Vec::new();
        add_points([Vec3::X, Vec3::Y, Vec3::Z], splits, &mut points);
        let count = points.len();
        if splits == 0 {
            points.push(Vec3::splat(1.0 / 3.0));
        }
        let last = points[points.len() - 1];
        let octets = points
            .chunks(8)
            .map(|chunk| {
                let lane = |l: usize| chunk.get(l).copied().unwrap_or(last);
                std::array::from_fn(|k| std::array::from_fn(|l| lane(l)[k]))
            })
            .collect();
        Self { count, octets }
    }

    /// Points at which a function has to be known: those that count, and the one beside them.
    pub fn looked_at(&self) -> usize {
        self.count + usize::from(self.count == 3)
    }

    /// Means of `values` times each barycentric coordinate.
    pub fn moments(&self, values: &[[f32; 8]]) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for i in 0..self.count {
            sum += self.point(i) * values[i / 8][i % 8];
        }
        sum / self.count as f32
    }

    /// Greatest distance of a value from the linear function with these corner values.
    pub fn residual(&self, values: &[[f32; 8]], fit: Vec3) -> f32 {
        (0..self.count).fold(0.0, |m: f32, i| {
            m.max((values[i / 8][i % 8] - self.point(i).dot(fit)).abs())
        })
    }

    fn point(&self, i: usize) -> Vec3 {
        let octet = &self.octets[i / 8];
        Vec3::new(octet[0][i % 8], octet[1][i % 8], octet[2][i % 8])
    }
}

fn add_points(triangle: [Vec3; 3], splits: u32, points: &mut Vec<Vec3>) {
    if splits == 0 {
        points.extend(three_points(triangle));
        return;
    }
    for k in 0..4 {
        add_points(split_triangle(triangle, k), splits - 1, points);
    }
}

/// Midpoints between centroid and corners: the degree-2 rule on a triangle, equal weights.
pub fn three_points([a, b, c]: [Vec3; 3]) -> [Vec3; 3] {
    let g = (a + b + c) * (1.0 / 3.0);
    [(g + a) * 0.5, (g + b) * 0.5, (g + c) * 0.5]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rules_are_exact_for_quadratics() {
        // The mean of lambda_i lambda_j over a triangle is 1/12, of lambda_i^2 1/6.
        for splits in 0..3 {
            let rule = CompositeRule::on_parts(splits);
            let values: Vec<[f32; 8]> = rule.octets.iter().map(|octet| octet[0]).collect();
            let moments = rule.moments(&values);
            let want = Vec3::new(1.0 / 6.0, 1.0 / 12.0, 1.0 / 12.0);
            assert!((moments - want).abs().max_element() < 1.0e-6, "{moments}");
            assert!(rule.residual(&values, Vec3::X) < 1.0e-6);
            assert_eq!(rule.count, 3 << (2 * splits));
        }
    }
}
