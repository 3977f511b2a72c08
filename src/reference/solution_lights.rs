//! The light of a solution by source face and side, as the comparison with a reference wants it.

use super::solution_error::SolvedLights;
use crate::math::FacetId;
use crate::scene::Scene;
use crate::solve::Solution;

/// Sums a solution up, in the units of the scene's file. Faces without a lit side are left out: a
/// comparison counts them as black.
pub fn solution_lights(scene: &Scene, solution: &Solution) -> SolvedLights {
    let mut lights = SolvedLights::new();
    for (f, facet) in solution.facets.iter().enumerate() {
        let [a, b, c] = scene.source_corners(facet.polygon);
        let area = 0.5 * (b - a).cross(c - a).length();
        let face = scene.polygons[facet.polygon.index()].source_face;
        let light = lights.entry((face, facet.side)).or_default();
        light.area += area;
        for patch in solution.facet_patches(FacetId::new(f)) {
            // Every split is into four equal parts.
            let share = 0.25f64.powi(patch.path.level() as i32);
            let radiosity = patch.radiosity.map(f64::from);
            light.power += area * share * radiosity.iter().sum::<f64>() / 3.0;
        }
    }
    lights
}
