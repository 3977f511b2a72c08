//! Flat parallelograms in a regular mesh.

use super::material::Material;
use super::mesh::{MaterialId, Mesh};
use glam::DVec3;

/// A parallelogram from `corner` along `u` and `v`, in `cells` pieces along each, facing `u x v`.
pub fn plate(corner: DVec3, u: DVec3, v: DVec3, cells: [usize; 2], material: Material) -> Mesh {
    let even = |n: usize| (0..=n).map(|i| i as f64 / n as f64).collect::<Vec<_>>();
    plate_cut_at(corner, u, v, [&even(cells[0]), &even(cells[1])], |_, _| {
        material
    })
}

/// A parallelogram cut at the given fractions of `u` and `v` (ascending from 0 to 1); `paint` gives
/// the material of cell `(i, j)`.
pub fn plate_cut_at(
    corner: DVec3,
    u: DVec3,
    v: DVec3,
    cuts: [&[f64]; 2],
    paint: impl Fn(usize, usize) -> Material,
) -> Mesh {
    let mut mesh = Mesh::default();
    for t in cuts[1] {
        for s in cuts[0] {
            mesh.vertex(corner + u * *s + v * *t);
        }
    }
    let row = cuts[0].len();
    for j in 0..cuts[1].len() - 1 {
        for i in 0..row - 1 {
            let at = j * row + i;
            let material: MaterialId = mesh.material(paint(i, j));
            mesh.quad([at, at + 1, at + row + 1, at + row], material);
        }
    }
    mesh
}
