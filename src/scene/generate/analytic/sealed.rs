//! Sealed rooms: no light may get in.
//!
//! A lit room with a chamber next door and a cabin inside, both shut off by walls of 5 cm. Floors
//! and walls of the chambers are meshed so that their edges do not line up. Everything inside the
//! chambers has a material whose name begins with `sealed_` and must stay exactly black.

use super::super::blocks::Blocks;
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::plate::plate_cut_at;
use super::super::shell::{RoomSide, box_room};
use glam::{DVec3, dvec3};

/// Thickness of the walls in metres.
const WALL: f64 = 0.05;
/// The lit room in metres.
const LIT: [f64; 3] = [5.0, 4.0, 3.0];
/// Outer corners of the cabin that stands in the lit room.
const CABIN: [[f64; 3]; 2] = [[0.6, 1.1, 0.0], [2.4, 3.1, 2.3]];
/// Length of the chamber next door along x, in metres.
const CHAMBER: f64 = 2.5;
/// The lamp in the lit room's ceiling, 1.5 m x 1 m.
const LAMP: [[f64; 2]; 2] = [[3.0, 1.5], [4.5, 2.5]];

const LIT_FLOOR: Material = Material::grey("lit_floor", 0.4, 0.0);
const LIT_WALL: Material = Material::grey("lit_wall", 0.6, 0.0);
const LIT_CEILING: Material = Material::grey("lit_ceiling", 0.8, 0.0);
const LIT_LAMP: Material = Material::grey("lit_lamp", 0.5, 10.0);
const SEALED_FLOOR: Material = Material::grey("sealed_floor", 0.4, 0.0);
const SEALED_WALL: Material = Material::grey("sealed_wall", 0.6, 0.0);
const SEALED_CEILING: Material = Material::grey("sealed_ceiling", 0.8, 0.0);

/// The sealed rooms, each with a floor and a ceiling of its own.
pub fn sealed() -> Mesh {
    let mut mesh = lit_room_and_cabin();
    let min = dvec3(LIT[0] + WALL, 0.0, 0.0);
    let max = dvec3(LIT[0] + WALL + CHAMBER, LIT[1], LIT[2]);
    mesh.object("chamber", &box_room(min, max, sealed_side));
    mesh
}

/// The harder variant: floor and ceiling are one plane that runs on under the chamber's wall, and
/// the wall is a slab that stands on it.
pub fn sealed_slab() -> Mesh {
    let mut mesh = Mesh::default();
    let length = LIT[0] + WALL + CHAMBER;
    let depth = LIT[1];
    let (dx, dy, dz) = (
        dvec3(length, 0.0, 0.0),
        dvec3(0.0, depth, 0.0),
        dvec3(0.0, 0.0, LIT[2]),
    );
    // The border between lit and sealed floor lies in the middle of the wall's thickness.
    let border = (LIT[0] + WALL / 2.0) / length;
    let cuts = |lit: usize, sealed: usize| -> Vec<f64> {
        let first = (0..lit).map(|i| border * i as f64 / lit as f64);
        let second = (0..=sealed).map(|i| border + (1.0 - border) * i as f64 / sealed as f64);
        first.chain(second).collect()
    };
    let even = |n: usize| -> Vec<f64> { (0..=n).map(|i| i as f64 / n as f64).collect() };
    let floor = plate_cut_at(DVec3::ZERO, dx, dy, [&cuts(5, 3), &even(5)], |i, _| {
        if i < 5 { LIT_FLOOR } else { SEALED_FLOOR }
    });
    mesh.object("floor", &floor);
    // The lamp takes two by two cells in the middle of the ceiling's lit part.
    let ceiling = plate_cut_at(dz, dy, dx, [&even(4), &cuts(6, 4)], |j, i| match (i, j) {
        (2..=3, 1..=2) => LIT_LAMP,
        (0..=5, _) => LIT_CEILING,
        _ => SEALED_CEILING,
    });
    mesh.object("ceiling", &ceiling);
    let wall = |i: usize, lit: usize| if i < lit { LIT_WALL } else { SEALED_WALL };
    let south = plate_cut_at(DVec3::ZERO, dz, dx, [&even(3), &cuts(4, 5)], |_, i| {
        wall(i, 4)
    });
    let north = plate_cut_at(dy, dx, dz, [&cuts(7, 2), &even(2)], |i, _| wall(i, 7));
    mesh.object("south_wall", &south);
    mesh.object("north_wall", &north);
    mesh.object(
        "west_wall",
        &plate_cut_at(DVec3::ZERO, dy, dz, [&even(3), &even(2)], |_, _| LIT_WALL),
    );
    mesh.object(
        "east_wall",
        &plate_cut_at(dx, dz, dy, [&even(4), &even(7)], |_, _| SEALED_WALL),
    );
    let mut slab = Blocks::empty().with_cell_sizes(dvec3(1.0, depth / 6.0, LIT[2] / 2.0));
    slab.add([LIT[0], 0.0, 0.0], [LIT[0] + WALL, depth, LIT[2]], 0);
    mesh.object(
        "slab",
        &slab.mesh(|face| {
            if face.normal.x > 0.5 {
                SEALED_WALL
            } else {
                LIT_WALL
            }
        }),
    );
    mesh
}

/// The lit room as a watertight shell around the cabin's outside, and the cabin's inside.
fn lit_room_and_cabin() -> Mesh {
    let [cabin_min, cabin_max] = CABIN;
    let mut space = Blocks::solid().with_cell_size(1.0);
    space.carve([0.0; 3], LIT, 0);
    space.add(cabin_min, cabin_max, 0);
    let [from, to] = LAMP;
    space.add([from[0], from[1], LIT[2]], [to[0], to[1], LIT[2] + WALL], 1);
    let shell = space.mesh(|face| match face.solid {
        1 => LIT_LAMP,
        _ if face.centre.z < 1e-6 => LIT_FLOOR,
        _ if face.faces_down() => LIT_CEILING,
        _ => LIT_WALL,
    });
    let mut mesh = Mesh::default();
    mesh.object("lit_room", &shell);
    let inside = DVec3::splat(WALL);
    mesh.object(
        "cabin",
        &box_room(
            DVec3::from(cabin_min) + inside,
            DVec3::from(cabin_max) - inside,
            sealed_side,
        ),
    );
    mesh
}

/// Cells and material of a chamber's side: no two neighbours have the same cells.
fn sealed_side(side: RoomSide) -> ([usize; 2], Material) {
    match side {
        RoomSide::Floor => ([5, 7], SEALED_FLOOR),
        RoomSide::Ceiling => ([2, 3], SEALED_CEILING),
        RoomSide::West => ([4, 3], SEALED_WALL),
        RoomSide::East => ([2, 5], SEALED_WALL),
        RoomSide::South => ([3, 2], SEALED_WALL),
        RoomSide::North => ([4, 4], SEALED_WALL),
    }
}
