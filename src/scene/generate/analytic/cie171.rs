//! Test cases after CIE 171:2006, "Test cases to assess the accuracy of lighting computer
//! programs". Flux is in the emission so that a lumen is a watt and a lux a W/m2.

use super::super::blocks::Blocks;
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::plate::plate;
use super::super::shell::box_room;
use glam::{DVec3, dvec3};
use std::f64::consts::PI;

/// Case 5.4: total flux of the lamp, in W standing for lm.
const FLUX_CONSERVED: f64 = 1000.0;
/// Case 5.6: illuminance on the floor element (W/m2 for lx) and its reflectance.
const FLOOR_ILLUMINANCE: f64 = 1000.0;
const FLOOR_REFLECTANCE: f64 = 0.5;
/// Case 5.8: total flux (10 klm) and side of the cube in metres.
const CUBE_FLUX: f64 = 10_000.0;
const CUBE_SIDE: f64 = 4.0;

/// 5.4, conservation of flux: a black room of 4 x 4 x 3 m, a 1 m square in its ceiling that emits
/// 1000 W. All of it must be received.
pub fn cie171_flux() -> Mesh {
    let mut space = Blocks::solid().with_cell_size(1.0);
    space.carve([0.0; 3], [4.0, 4.0, 3.0], 0);
    space.add([1.5, 1.5, 3.0], [2.5, 2.5, 3.1], 1);
    let source = Material::grey("source", 0.0, FLUX_CONSERVED / PI);
    let black = Material::grey("black", 0.0, 0.0);
    let mut mesh = Mesh::default();
    let shell = space.mesh(|face| if face.solid == 1 { source } else { black });
    mesh.object("room", &shell);
    mesh
}

/// 5.6, diffuse reflection without interreflection: a floor element of 4 x 4 m (z = 0) sends what
/// it reflects of 1000 lx at reflectance 0.5 to a black wall of 4 x 3 m along its eastern edge and
/// a black ceiling of 4 x 4 m at 3 m, in cells of 0.5 m. The reflected light stands as emission.
pub fn cie171_diffuse_reflection() -> Mesh {
    let source = Material::grey(
        "floor_source",
        0.0,
        FLOOR_REFLECTANCE * FLOOR_ILLUMINANCE / PI,
    );
    let (x, y, z) = (
        dvec3(4.0, 0.0, 0.0),
        dvec3(0.0, 4.0, 0.0),
        dvec3(0.0, 0.0, 3.0),
    );
    let mut mesh = Mesh::default();
    mesh.object("floor", &plate(DVec3::ZERO, x, y, [8, 8], source));
    let wall = Material::grey("wall_black", 0.0, 0.0);
    mesh.object("wall", &plate(x, z, y, [6, 8], wall));
    let ceiling = Material::grey("ceiling_black", 0.0, 0.0);
    mesh.object("ceiling", &plate(z, y, x, [8, 8], ceiling));
    mesh
}

/// 5.8, interreflection: a cube of 4 m whose walls emit 10 klm evenly and reflect `reflectance`.
/// Mean indirect illuminance: rho * flux / (area * (1 - rho)).
pub fn cie171_interreflection(reflectance: f64) -> Mesh {
    let area = 6.0 * CUBE_SIDE * CUBE_SIDE;
    let wall = Material::grey("wall", reflectance, CUBE_FLUX / (area * PI));
    let mut mesh = Mesh::default();
    let cube = box_room(DVec3::ZERO, DVec3::splat(CUBE_SIDE), |_| ([4, 4], wall));
    mesh.object("cube", &cube);
    mesh
}
