//! The Cornell box, in metres, and the same box with two spheres.

use super::super::furniture::block;
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::placement::Placement;
use super::super::plate::plate;
use super::super::sphere::sphere;
use glam::{DVec3, dvec3};

/// Side of the box in metres; it is open towards the viewer, at y = 0.
const SIDE: f64 = 5.5;
/// The lamp: its sides along x and y, and how far it hangs under the ceiling.
const LAMP: [f64; 2] = [1.3, 1.05];
const LAMP_DROP: f64 = 0.02;

const WHITE: Material = Material::matte("white", [0.73, 0.72, 0.68]);
const RED: Material = Material::matte("red", [0.60, 0.06, 0.05]);
const GREEN: Material = Material::matte("green", [0.12, 0.42, 0.10]);
const LIGHT: Material = Material::lamp("light", [17.0, 12.0, 5.0]);

/// The classic box with a short and a tall block: 36 triangles.
pub fn cornell() -> Mesh {
    let mut mesh = shell();
    let short = block([1.65, 1.65, 1.65], SIDE, WHITE);
    mesh.place("short_block", &short, Placement::on_floor(3.7, 1.7, 18.0));
    let tall = block([1.65, 1.65, 3.3], SIDE, WHITE);
    mesh.place("tall_block", &tall, Placement::on_floor(1.85, 3.5, -17.0));
    mesh
}

/// The box with two spheres of 1280 triangles each.
pub fn cornell_spheres() -> Mesh {
    let mut mesh = shell();
    let radius = 0.9;
    for (x, y) in [(1.6, 3.4), (3.8, 1.9)] {
        // A hair above the floor: a vertex of the mesh may be the lowest point of the sphere.
        let centre = dvec3(x, y, radius + 0.01);
        mesh.object("sphere", &sphere(centre, radius, 3, WHITE));
    }
    mesh
}

fn shell() -> Mesh {
    let (x, y, z) = (DVec3::X * SIDE, DVec3::Y * SIDE, DVec3::Z * SIDE);
    let one = [1, 1];
    let mut mesh = Mesh::default();
    mesh.object("floor", &plate(DVec3::ZERO, x, y, one, WHITE));
    mesh.object("ceiling", &plate(z, y, x, one, WHITE));
    mesh.object("back_wall", &plate(y, x, z, one, WHITE));
    mesh.object("left_wall", &plate(DVec3::ZERO, y, z, one, RED));
    mesh.object("right_wall", &plate(x, z, y, one, GREEN));
    let corner = dvec3(
        (SIDE - LAMP[0]) / 2.0,
        (SIDE - LAMP[1]) / 2.0,
        SIDE - LAMP_DROP,
    );
    let lamp = plate(corner, DVec3::Y * LAMP[1], DVec3::X * LAMP[0], one, LIGHT);
    mesh.object("lamp", &lamp);
    mesh
}
