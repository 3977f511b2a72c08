//! Potted plants.

use super::super::lathe::{lathe, outline};
use super::super::material::Material;
use super::super::mesh::Mesh;

/// A small tree in a pot, `height` metres high, its crown in `tiers` skirts of leaves.
pub fn plant(height: f64, tiers: usize, segments: usize, clay: Material, leaf: Material) -> Mesh {
    let pot = 0.22 * height;
    let mut points = outline(
        clay,
        &[(0.0, 0.0), (0.13 * height, 0.0), (0.17 * height, pot)],
    );
    points.extend(outline(
        leaf,
        &[(0.03 * height, pot), (0.03 * height, 0.34 * height)],
    ));
    let crown = 0.66 * height / tiers as f64;
    for tier in 0..tiers {
        let low = 0.34 * height + crown * tier as f64;
        let taper = 1.0 - 0.55 * tier as f64 / tiers as f64;
        let last = tier + 1 == tiers;
        points.extend(outline(
            leaf,
            &[
                (0.26 * height * taper, low),
                (0.22 * height * taper, low + 0.45 * crown),
                (if last { 0.0 } else { 0.06 * height }, low + crown),
            ],
        ));
    }
    lathe(&points, segments)
}

/// A vase `height` metres high.
pub fn vase(height: f64, segments: usize, clay: Material) -> Mesh {
    let points = [
        (0.0, 0.0),
        (0.18, 0.0),
        (0.32, 0.35),
        (0.26, 0.65),
        (0.12, 0.85),
        (0.16, 1.0),
        (0.0, 1.0),
    ]
    .map(|(r, z)| (r * height, z * height));
    lathe(&outline(clay, &points), segments)
}
