//! Scene A: a floor of a guest house, rooms along a corridor. Rooms see each other only through
//! narrow doors that do not face each other, so little light goes from one to the next.

use super::super::blocks::Blocks;
use super::super::furniture::{bench, lamp_panel, plant};
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::palette::*;
use super::interiors::{Detail, Interior, furnish};
use super::room::{Paint, Room, Wall};

/// Rooms on each side of the corridor.
const ROOMS_A_SIDE: usize = 6;
/// Inner width and depth of a room, thickness of walls, height, in metres.
const ROOM_WIDTH: f64 = 4.2;
const ROOM_DEPTH: f64 = 4.8;
const WALL: f64 = 0.15;
const HEIGHT: f64 = 2.6;
/// Width of the corridor in metres.
const CORRIDOR: f64 = 1.8;
/// A door's middle from the eastern end of the front wall, its width and height, in metres.
const DOOR_FROM_EAST: f64 = 0.8;
const DOOR_WIDTH: f64 = 0.9;
const DOOR_HEIGHT: f64 = 2.1;
/// Largest side of a mesh cell of the shell in metres.
const SHELL_CELL: f64 = 0.45;
const DETAIL: Detail = Detail {
    cell: 0.34,
    segments: 12,
    books: 6,
};
/// Rooms whose lamp is on, in the order of the doors from the west, south side first.
const LIT: [bool; 2 * ROOMS_A_SIDE] = [
    true, false, true, true, false, true, false, true, true, false, true, true,
];
/// The lamp panels' sides and largest cell in metres, and their light.
const LAMP: [f64; 2] = [0.9, 0.9];
const LAMP_CELL: f64 = 0.3;
const LAMP_LIGHT: Material = Material::lamp("lamp_on", [36.0, 32.0, 26.0]);
const LAMP_DARK: Material = Material::matte("lamp_off", [0.70, 0.70, 0.68]);
/// What is in the rooms, in the order of [`LIT`].
const INTERIORS: [Interior; 2 * ROOMS_A_SIDE] = [
    Interior::Bedroom,
    Interior::Bathroom,
    Interior::Study,
    Interior::Bedroom,
    Interior::Library,
    Interior::Kitchen,
    Interior::Sitting,
    Interior::Bedroom,
    Interior::Bathroom,
    Interior::Study,
    Interior::Sitting,
    Interior::Bedroom,
];

/// Builds the floor.
pub fn guest_house() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.object("floor_plan", &shell());
    for number in 0..2 * ROOMS_A_SIDE {
        let frame = room(number).seen_from(front(number));
        let light = if LIT[number] { LAMP_LIGHT } else { LAMP_DARK };
        let lamp = lamp_panel(LAMP[0], LAMP[1], LAMP_CELL, STEEL, light);
        let at = frame.hung(frame.width / 2.0, frame.depth / 2.0, HEIGHT - 0.1);
        mesh.place("lamp", &lamp, at);
        furnish(&mut mesh, INTERIORS[number], &frame, DETAIL, number as u64);
    }
    furnish_corridor(&mut mesh);
    mesh
}

/// Southern rooms come first, each row from the west.
fn room(number: usize) -> Room {
    let pitch = ROOM_WIDTH + WALL;
    let west = pitch * (number % ROOMS_A_SIDE) as f64;
    if number < ROOMS_A_SIDE {
        Room::at(west, -WALL - ROOM_DEPTH, ROOM_WIDTH, ROOM_DEPTH)
    } else {
        Room::at(west, CORRIDOR + WALL, ROOM_WIDTH, ROOM_DEPTH)
    }
}

/// The wall of a room with the door to the corridor.
fn front(number: usize) -> Wall {
    if number < ROOMS_A_SIDE {
        Wall::North
    } else {
        Wall::South
    }
}

fn corridor() -> Room {
    let length = (ROOM_WIDTH + WALL) * ROOMS_A_SIDE as f64 - WALL;
    Room::at(0.0, 0.0, length, CORRIDOR)
}

fn shell() -> Mesh {
    const CORRIDOR_TAG: u16 = 100;
    let mut space = Blocks::solid().with_cell_size(SHELL_CELL);
    corridor().carve(&mut space, HEIGHT, CORRIDOR_TAG);
    for number in 0..2 * ROOMS_A_SIDE {
        let room = room(number);
        room.carve(&mut space, HEIGHT, number as u16);
        // The door stands towards the end that the room, seen from the corridor, has to its right.
        let (middle, from, to) = match front(number) {
            Wall::North => (room.west + DOOR_FROM_EAST, room.north, 0.0),
            _ => (room.east - DOOR_FROM_EAST, CORRIDOR, room.south),
        };
        let half = DOOR_WIDTH / 2.0;
        space.carve(
            [middle - half, from, 0.0],
            [middle + half, to, DOOR_HEIGHT],
            CORRIDOR_TAG + 1,
        );
    }
    let walls = [WARM_WHITE, SAGE, OCHRE, DUSTY_BLUE, TERRACOTTA, COOL_WHITE];
    space.mesh(|face| {
        let number = usize::from(face.air);
        let (floor, walls) = match INTERIORS.get(number) {
            None => (STONE_FLOOR, WARM_WHITE),
            Some(Interior::Bathroom | Interior::Kitchen) => (STONE_FLOOR, COOL_WHITE),
            Some(_) => (PARQUET, walls[number % walls.len()]),
        };
        let ceiling = CEILING_WHITE;
        Paint {
            floor,
            walls,
            ceiling,
        }
        .of(face)
    })
}

/// A bench or a plant between the doors.
fn furnish_corridor(mesh: &mut Mesh) {
    let corridor = corridor();
    for number in 0..ROOMS_A_SIDE {
        let along = room(number).west + 2.2;
        if number % 2 == 0 {
            let seat = bench(1.2, DETAIL.cell, OAK);
            mesh.place("bench", &seat, corridor.against(Wall::South, along, 0.44));
        } else {
            let pot = plant(1.1, 3, DETAIL.segments, CLAY, LEAF);
            mesh.place("plant", &pot, corridor.against(Wall::North, along, 0.58));
        }
    }
}
