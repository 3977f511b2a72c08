//! Concentric spheres.

use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::sphere::sphere;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Radii in metres.
const INNER: f64 = 0.5;
const OUTER: f64 = 1.0;
/// Both spheres have 20 * 4^3 = 1280 triangles.
const LEVEL: u32 = 3;

/// A sphere inside a sphere. The inner emits a radiosity of 1 W/m2 outwards, the outer is black
/// and faces inwards. The two meshes are the same up to scale, so F_21 = (r1 / r2)^2 is exact for
/// the meshes and not only for spheres.
pub fn concentric_spheres() -> Mesh {
    let inner = Material::grey("inner", 0.0, FRAC_1_PI);
    let outer = Material::grey("outer", 0.0, 0.0);
    let mut mesh = Mesh::default();
    mesh.object("inner", &sphere(DVec3::ZERO, INNER, LEVEL, inner));
    let hollow = sphere(DVec3::ZERO, OUTER, LEVEL, outer).turned_inside_out();
    mesh.object("outer", &hollow);
    mesh
}
