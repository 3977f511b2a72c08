//! White furnaces: closed spaces where every surface has the same emission and reflectance.
//!
//! With emitted radiosity E0 = pi * Ke and reflectance rho everywhere, the radiosity of every
//! point is E0 / (1 - rho), whatever stands inside.

use super::super::blocks::{Blocks, cuboid};
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::placement::Placement;
use super::super::shell::{RoomSide, box_room};
use super::super::sphere::sphere;
use glam::{DVec3, dvec3};

/// Size of the furnace in metres: no two sides alike.
const SIZE: [f64; 3] = [5.0, 4.0, 3.0];
/// Emitted radiance of every surface in W/m2/sr; any positive number serves.
const RADIANCE: f64 = 1.0;
/// Largest side of a mesh cell in metres.
const CELL: f64 = 1.0;

/// What stands inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FurnaceContent {
    /// Nothing.
    Empty,
    /// Pillars and hovering blocks, one of them turned.
    Blocks,
    /// Walls 1 cm thick with gaps between and above them.
    Partitions,
    /// Nothing, but every side of the room is meshed differently.
    TJunctions,
    /// A hovering sphere.
    Sphere,
}

/// A furnace whose surfaces reflect the share `reflectance`, in [0, 1).
pub fn furnace(content: FurnaceContent, reflectance: f64) -> Mesh {
    let material = Material::grey("furnace", reflectance, RADIANCE);
    match content {
        FurnaceContent::Empty => empty(&[], material),
        FurnaceContent::Blocks => blocks(material),
        FurnaceContent::Partitions => partitions(material),
        FurnaceContent::TJunctions => t_junctions(material),
        FurnaceContent::Sphere => {
            let mut mesh = empty(&[], material);
            // Level 2 is 320 triangles: curved enough to cluster, coarse enough to solve quickly.
            mesh.object("sphere", &sphere(dvec3(2.9, 1.8, 1.4), 0.8, 2, material));
            mesh
        }
    }
}

/// The room with the solids `pieces` left standing, as one watertight mesh.
fn empty(pieces: &[([f64; 3], [f64; 3])], material: Material) -> Mesh {
    let mut space = Blocks::solid().with_cell_size(CELL);
    space.carve([0.0; 3], SIZE, 0);
    for &(min, max) in pieces {
        space.add(min, max, 0);
    }
    let mut mesh = Mesh::default();
    mesh.object("furnace", &space.mesh(|_| material));
    mesh
}

fn blocks(material: Material) -> Mesh {
    let pillars = [
        ([0.8, 0.7, 0.0], [1.4, 1.3, 3.0]),
        ([3.2, 2.4, 0.0], [4.2, 3.4, 1.2]),
        ([3.6, 0.0, 0.0], [5.0, 0.7, 0.9]),
    ];
    let mut mesh = empty(&pillars, material);
    let hovering = cuboid([-0.5, -0.3, 0.0], [0.5, 0.3, 0.8], CELL, material);
    mesh.place("block", &hovering, Placement::new(2.3, 2.1, 0.9, 31.0));
    let flat = cuboid([-0.6, -0.6, 0.0], [0.6, 0.6, 0.1], CELL, material);
    mesh.place("block", &flat, Placement::new(1.2, 3.0, 0.15, 0.0));
    mesh
}

fn partitions(material: Material) -> Mesh {
    let walls = [
        ([1.6, 0.0, 0.0], [1.61, 3.1, 3.0]),
        ([3.2, 0.9, 0.0], [3.21, 4.0, 3.0]),
        ([1.61, 1.9, 0.0], [2.5, 1.91, 2.2]),
        ([4.0, 1.0, 0.4], [4.01, 3.0, 2.6]),
    ];
    empty(&walls, material)
}

fn t_junctions(material: Material) -> Mesh {
    let max = DVec3::from(SIZE);
    let mut mesh = Mesh::default();
    let cells = |side| match side {
        RoomSide::Floor => [7, 5],
        RoomSide::Ceiling => [3, 4],
        RoomSide::West => [2, 3],
        RoomSide::East => [6, 1],
        RoomSide::South => [4, 2],
        RoomSide::North => [11, 7],
    };
    mesh.object(
        "furnace",
        &box_room(DVec3::ZERO, max, |side| (cells(side), material)),
    );
    mesh
}
