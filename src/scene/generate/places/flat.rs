//! Scene E: a flat of eight rooms along a hall, lit from two windows at its western end.

use super::super::blocks::Blocks;
use super::super::furniture::{bench, lantern};
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::palette::*;
use super::interiors::{Detail, Interior, furnish};
use super::room::{Paint, Room, Wall};

/// Thickness of walls and height in metres.
const WALL: f64 = 0.15;
const HEIGHT: f64 = 2.6;
/// Depth of the rooms and width of the hall in metres.
const ROOM_DEPTH: f64 = 4.4;
const HALL_WIDTH: f64 = 2.0;
/// Inner widths of the four southern and the four northern rooms, from the west, in metres.
const WIDTHS: [[f64; 4]; 2] = [[4.0, 3.6, 4.4, 3.8], [3.6, 4.2, 4.0, 4.0]];
/// Rooms in a row.
const A_ROW: usize = WIDTHS[0].len();
/// A door's middle from the end of the front wall, its width and height, in metres.
const DOOR_FROM_END: f64 = 0.8;
const DOOR_WIDTH: f64 = 0.9;
const DOOR_HEIGHT: f64 = 2.1;
/// The arch between kitchen and living room: its ends' distances from the front walls, height.
const ARCH: [f64; 2] = [1.7, 3.3];
const ARCH_HEIGHT: f64 = 2.2;
/// The windows in the western walls: their ends' distances from the rooms' southern walls, sill and
/// head, how deep they are set, in metres, and their light.
const WINDOW: [f64; 2] = [1.3, 3.1];
const SILL: [f64; 2] = [0.95, 2.25];
const WINDOW_DEPTH: f64 = 0.15;
const DAYLIGHT: Material = Material::lamp("daylight", [16.0, 18.0, 22.0]);
/// Largest side of a mesh cell of the shell in metres.
const SHELL_CELL: f64 = 0.69;
const DETAIL: Detail = Detail {
    cell: 0.62,
    segments: 8,
    books: 3,
};
/// Which lamps are on, southern rooms first.
const LIT: [bool; 8] = [false; 8];
/// The lanterns' width and height, the height of their undersides, largest cell, in metres, and
/// their light.
const LAMP: [f64; 2] = [0.4, 0.5];
const LAMP_HEIGHT: f64 = 1.9;
const LAMP_CELL: f64 = 0.5;
const LAMP_LIGHT: Material = Material::lamp("lamp_on", [34.0, 29.0, 22.0]);
const LAMP_DARK: Material = Material::matte("lamp_off", [0.70, 0.70, 0.68]);
/// What is in the rooms, in the order of [`LIT`], and the walls' paint.
const ROOMS: [(Interior, Material); 8] = [
    (Interior::Bedroom, DUSTY_BLUE),
    (Interior::Kitchen, COOL_WHITE),
    (Interior::Sitting, WARM_WHITE),
    (Interior::Library, OCHRE),
    (Interior::Bathroom, COOL_WHITE),
    (Interior::Study, SAGE),
    (Interior::Bedroom, TERRACOTTA),
    (Interior::Study, DUSTY_BLUE),
];
/// Tag of the air in the hall and the doorways.
const HALL_TAG: u16 = 10;
/// Tag of the air in the windows.
const WINDOW_TAG: u16 = 11;

/// Builds the flat.
pub fn flat() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.object("flat", &shell());
    for (number, &(interior, _)) in ROOMS.iter().enumerate() {
        let frame = room(number).seen_from(front(number));
        let light = if LIT[number] { LAMP_LIGHT } else { LAMP_DARK };
        let lamp = lantern(LAMP[0], LAMP[1], LAMP_CELL, STEEL, light);
        let at = frame.hung(frame.width / 2.0, frame.depth / 2.0, LAMP_HEIGHT);
        mesh.place("lamp", &lamp, at);
        furnish(&mut mesh, interior, &frame, DETAIL, 40 + number as u64);
    }
    let seat = bench(1.4, DETAIL.cell, OAK);
    mesh.place("bench", &seat, hall().against(Wall::South, 7.2, 0.44));
    mesh
}

fn room(number: usize) -> Room {
    let widths = WIDTHS[number / A_ROW];
    let before: f64 = widths[..number % A_ROW].iter().map(|w| w + WALL).sum();
    let south = if number < A_ROW {
        -WALL - ROOM_DEPTH
    } else {
        HALL_WIDTH + WALL
    };
    Room::at(before, south, widths[number % A_ROW], ROOM_DEPTH)
}

fn front(number: usize) -> Wall {
    if number < A_ROW {
        Wall::North
    } else {
        Wall::South
    }
}

fn hall() -> Room {
    let length = WIDTHS[0].iter().sum::<f64>() + WALL * (A_ROW - 1) as f64;
    Room::at(0.0, 0.0, length, HALL_WIDTH)
}

fn shell() -> Mesh {
    let mut space = Blocks::solid().with_cell_size(SHELL_CELL);
    hall().carve(&mut space, HEIGHT, HALL_TAG);
    for number in 0..ROOMS.len() {
        let room = room(number);
        room.carve(&mut space, HEIGHT, number as u16);
        let (middle, from, to) = match front(number) {
            Wall::North => (room.west + DOOR_FROM_END, room.north, 0.0),
            _ => (room.east - DOOR_FROM_END, HALL_WIDTH, room.south),
        };
        let half = DOOR_WIDTH / 2.0;
        space.carve(
            [middle - half, from, 0.0],
            [middle + half, to, DOOR_HEIGHT],
            HALL_TAG,
        );
    }
    for number in [0, A_ROW] {
        let room = room(number);
        space.carve(
            [room.west - WINDOW_DEPTH, room.south + WINDOW[0], SILL[0]],
            [room.west, room.south + WINDOW[1], SILL[1]],
            WINDOW_TAG,
        );
    }
    let kitchen = room(1);
    space.carve(
        [kitchen.east, kitchen.north - ARCH[1], 0.0],
        [kitchen.east + WALL, kitchen.north - ARCH[0], ARCH_HEIGHT],
        2,
    );
    space.mesh(|face| {
        if face.air == WINDOW_TAG {
            let is_pane = face.normal.x > 0.5;
            return if is_pane { DAYLIGHT } else { CEILING_WHITE };
        }
        let (floor, walls) = match ROOMS.get(usize::from(face.air)) {
            None => (PARQUET, OCHRE),
            Some((Interior::Bathroom | Interior::Kitchen, paint)) => (STONE_FLOOR, *paint),
            Some((_, paint)) => (PARQUET, *paint),
        };
        Paint {
            floor,
            walls,
            ceiling: CEILING_WHITE,
        }
        .of(face)
    })
}
