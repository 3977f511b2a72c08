//! Points that stand for the lit surface of a solution.

use super::solved_mesh::triangle_area;
use super::view::View;
use crate::math::SampleSequence;
use glam::DVec3;

/// Points that stand for the lit surface. Their number bounds the noise of a score to 1 in 30.
const SURFACE_POINTS: usize = 1024;

/// A point on lit surface, in the units of the rays.
pub(super) struct SurfacePoint {
    pub position: DVec3,
    pub normal: DVec3,
}

impl View<'_> {
    /// Points spread over the lit surface, and its area in the units of the rays.
    pub(super) fn surface_points(&self) -> (Vec<SurfacePoint>, f64) {
        let mean = |b: [f32; 3]| (f64::from(b[0]) + f64::from(b[1]) + f64::from(b[2])) / 3.0;
        let corners = |leaf: usize| {
            self.panels.leaves[leaf].corners.map(|v| {
                self.frame
                    .point(self.panels.positions[v as usize])
                    .as_dvec3()
            })
        };
        let area: Vec<f64> = (0..self.panels.leaves.len())
            .map(|leaf| triangle_area(corners(leaf)))
            .collect();
        let lit: Vec<usize> = (0..area.len())
            .filter(|&leaf| area[leaf] > 0.0 && mean(self.mesh.faces[leaf].radiosity) > 0.0)
            .collect();
        let lit_area: f64 = lit.iter().map(|&leaf| area[leaf]).sum();
        let power: f64 = (lit.iter())
            .map(|&leaf| area[leaf] * mean(self.mesh.faces[leaf].radiosity))
            .sum();
        if power == 0.0 || !power.is_finite() {
            return (Vec::new(), 0.0);
        }
        // Capped at the mean, so that dim rooms count little and lamps no more than what they light.
        let weight = |leaf: usize| {
            area[leaf] * (mean(self.mesh.faces[leaf].radiosity) / (power / lit_area)).min(1.0)
        };
        let total: f64 = lit.iter().map(|&leaf| weight(leaf)).sum();
        let sequence = SampleSequence::new(0);
        let mut points = Vec::with_capacity(SURFACE_POINTS);
        let mut passed = 0.0;
        for &leaf in &lit {
            passed += weight(leaf) / total;
            // Evenly spaced along the sum of weights.
            while points.len() < SURFACE_POINTS
                && passed * SURFACE_POINTS as f64 > points.len() as f64 + 0.5
            {
                let [s, t, ..] = sequence.point(points.len() as u32).map(f64::from);
                // The square root makes the points uniform over the triangle.
                let (root, [a, b, c]) = (s.sqrt(), corners(leaf));
                points.push(SurfacePoint {
                    position: a * (1.0 - root) + b * (root * (1.0 - t)) + c * (root * t),
                    normal: (b - a).cross(c - a).normalize_or_zero(),
                });
            }
        }
        (points, lit_area)
    }
}
