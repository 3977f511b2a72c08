//! Spheres as subdivided icosahedra.

use super::material::Material;
use super::mesh::Mesh;
use glam::{DVec3, dvec3};
use std::collections::BTreeMap;

/// A closed sphere about `centre`, facing outwards: 20 * 4^`level` triangles, vertices on it.
pub fn sphere(centre: DVec3, radius: f64, level: u32, material: Material) -> Mesh {
    let mut mesh = Mesh::default();
    let material = mesh.material(material);
    let golden = (1.0 + 5.0_f64.sqrt()) * 0.5;
    let mut directions = Vec::new();
    for (a, b) in [
        (-1.0, -golden),
        (1.0, -golden),
        (1.0, golden),
        (-1.0, golden),
    ] {
        directions.push(dvec3(0.0, a, b).normalize());
        directions.push(dvec3(a, b, 0.0).normalize());
        directions.push(dvec3(b, 0.0, a).normalize());
    }
    let mut faces = icosahedron_faces(&directions);
    for _ in 0..level {
        faces = split(&faces, &mut directions);
    }
    for direction in directions {
        mesh.vertex(centre + direction * radius);
    }
    for face in faces {
        mesh.triangle(face, material);
    }
    mesh
}

/// The twenty faces: the triples of neighbours, turned outwards.
fn icosahedron_faces(vertices: &[DVec3]) -> Vec<[usize; 3]> {
    // Neighbours are 63.4 degrees apart, the next nearest vertices 116.6.
    let near = |a: usize, b: usize| vertices[a].dot(vertices[b]) > 0.4;
    let mut faces = Vec::with_capacity(20);
    for a in 0..vertices.len() {
        for b in a + 1..vertices.len() {
            for c in b + 1..vertices.len() {
                if near(a, b) && near(b, c) && near(c, a) {
                    let outwards = vertices[a].dot(vertices[b].cross(vertices[c])) > 0.0;
                    faces.push(if outwards { [a, b, c] } else { [a, c, b] });
                }
            }
        }
    }
    faces
}

/// Splits every face in four at the midpoints of its edges, which move out to the sphere.
fn split(faces: &[[usize; 3]], directions: &mut Vec<DVec3>) -> Vec<[usize; 3]> {
    let mut midpoints = BTreeMap::new();
    let mut midpoint = |a: usize, b: usize, directions: &mut Vec<DVec3>| {
        *midpoints.entry((a.min(b), a.max(b))).or_insert_with(|| {
            directions.push((directions[a] + directions[b]).normalize());
            directions.len() - 1
        })
    };
    faces
        .iter()
        .flat_map(|&[a, b, c]| {
            let ab = midpoint(a, b, directions);
            let bc = midpoint(b, c, directions);
            let ca = midpoint(c, a, directions);
            [[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_are_closed_and_approach_the_volume_of_the_ball() {
        for level in 0..4 {
            let mesh = sphere(DVec3::ZERO, 1.0, level, Material::grey("g", 0.5, 0.0));
            assert_eq!(mesh.triangles.len(), 20 << (2 * level));
            // Euler: V - E + F = 2 with 3 F = 2 E.
            assert_eq!(mesh.vertices.len(), 2 + mesh.triangles.len() / 2);
            let volume: f64 = mesh
                .triangles
                .iter()
                .map(|t| {
                    let [a, b, c] = t.vertices.map(|v| mesh.vertices[v]);
                    a.dot(b.cross(c)) / 6.0
                })
                .sum();
            let ball = 4.0 / 3.0 * std::f64::consts::PI;
            // The regular icosahedron has 60.5 % of the ball; each level divides the rest by about 4.
            let missing = 1.0 - volume / ball;
            assert!(missing > 0.0 && missing < 0.45 / f64::from(1 << (2 * level)) * 1.3);
        }
    }
}
