//! Surfaces of revolution about the z axis: pots, shades, poles, round tables.

use super::material::Material;
use super::mesh::Mesh;
use glam::dvec3;

/// A point of the outline and the material of the ring that leads to it.
#[derive(Clone, Copy, Debug)]
pub struct Turn {
    /// Distance from the axis in metres; 0 for the first and the last point of a closed solid.
    pub radius: f64,
    /// Height in metres.
    pub height: f64,
    /// Material of the ring between the point before and this one.
    pub material: Material,
}

/// Turns an outline about the axis in `segments` (at least 3) flat sides.
///
/// An outline that goes up along the outside, from the axis to the axis, gives a closed solid
/// that faces outwards. Points off the axis become rings of vertices, points on it poles.
pub fn lathe(outline: &[Turn], segments: usize) -> Mesh {
    let mut mesh = Mesh::default();
    let rings: Vec<Vec<usize>> = outline
        .iter()
        .map(|turn| {
            let count = if turn.radius == 0.0 { 1 } else { segments };
            (0..count)
                .map(|i| {
                    let angle = std::f64::consts::TAU * i as f64 / segments as f64;
                    let (sine, cosine) = angle.sin_cos();
                    mesh.vertex(dvec3(turn.radius * cosine, turn.radius * sine, turn.height))
                })
                .collect()
        })
        .collect();
    for (pair, turn) in rings.windows(2).zip(&outline[1..]) {
        let material = mesh.material(turn.material);
        let (low, high) = (&pair[0], &pair[1]);
        for i in 0..segments {
            let next = (i + 1) % segments;
            match (low.len(), high.len()) {
                (1, 1) => {}
                (1, _) => mesh.triangle([low[0], high[next], high[i]], material),
                (_, 1) => mesh.triangle([low[i], low[next], high[0]], material),
                _ => mesh.quad([low[i], low[next], high[next], high[i]], material),
            }
        }
    }
    mesh
}

/// An outline of one material from `(radius, height)` points.
pub fn outline(material: Material, points: &[(f64, f64)]) -> Vec<Turn> {
    points
        .iter()
        .map(|&(radius, height)| Turn {
            radius,
            height,
            material,
        })
        .collect()
}

/// A closed upright cylinder standing on z = 0.
pub fn cylinder(radius: f64, height: f64, segments: usize, material: Material) -> Mesh {
    let points = [(0.0, 0.0), (radius, 0.0), (radius, height), (0.0, height)];
    lathe(&outline(material, &points), segments)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cylinder_has_the_volume_of_its_prism() {
        let (radius, height, segments) = (0.7, 1.3, 9);
        let mesh = cylinder(radius, height, segments, Material::grey("g", 0.5, 0.0));
        let volume: f64 = mesh
            .triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.vertices.map(|v| mesh.vertices[v]);
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        let step = std::f64::consts::TAU / segments as f64;
        let base = 0.5 * segments as f64 * radius * radius * step.sin();
        assert!((volume - base * height).abs() < 1e-12);
        assert_eq!(mesh.triangles.len(), 4 * segments);
    }
}
