//! Scene E: a flat of six rooms around a hall.

use super::super::blocks::Blocks;
use super::super::furniture::{bench, lamp_panel};
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
/// Inner widths of the three southern and the three northern rooms, from the west, in metres.
const WIDTHS: [[f64; 3]; 2] = [[4.2, 3.6, 5.0], [4.0, 4.6, 4.2]];
/// A door's middle from the end of the front wall, its width and height, in metres.
const DOOR_FROM_END: f64 = 0.8;
const DOOR_WIDTH: f64 = 0.9;
const DOOR_HEIGHT: f64 = 2.1;
/// The arch between kitchen and living room: its ends' distances from the front walls, height.
const ARCH: [f64; 2] = [1.7, 3.3];
const ARCH_HEIGHT: f64 = 2.2;
/// Largest side of a mesh cell of the shell in metres.
const SHELL_CELL: f64 = 0.48;
const DETAIL: Detail = Detail {
    cell: 0.44,
    segments: 8,
    books: 4,
};
/// Which lamps are on, southern rooms first.
const LIT: [bool; 6] = [true, false, true, false, true, false];
/// The lamp panels' sides and largest cell in metres, and their light.
const LAMP: [f64; 2] = [0.9, 0.9];
const LAMP_CELL: f64 = 0.45;
const LAMP_LIGHT: Material = Material::lamp("lamp_on", [34.0, 29.0, 22.0]);
const LAMP_DARK: Material = Material::matte("lamp_off", [0.70, 0.70, 0.68]);
/// What is in the rooms, in the order of [`LIT`], and the walls' paint.
const ROOMS: [(Interior, Material); 6] = [
    (Interior::Bedroom, DUSTY_BLUE),
    (Interior::Kitchen, COOL_WHITE),
    (Interior::Sitting, WARM_WHITE),
    (Interior::Bathroom, COOL_WHITE),
    (Interior::Study, SAGE),
    (Interior::Bedroom, TERRACOTTA),
];
/// Tag of the air in the hall and the doorways.
const HALL_TAG: u16 = 10;

/// Builds the flat.
pub fn flat() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.object("flat", &shell());
    for (number, &(interior, _)) in ROOMS.iter().enumerate() {
        let frame = room(number).seen_from(front(number));
        let light = if LIT[number] { LAMP_LIGHT } else { LAMP_DARK };
        let lamp = lamp_panel(LAMP[0], LAMP[1], LAMP_CELL, STEEL, light);
        let at = frame.hung(frame.width / 2.0, frame.depth / 2.0, HEIGHT - 0.1);
        mesh.place("lamp", &lamp, at);
        furnish(&mut mesh, interior, &frame, DETAIL, 40 + number as u64);
    }
    let seat = bench(1.4, DETAIL.cell, OAK);
    mesh.place("bench", &seat, hall().against(Wall::South, 7.2, 0.44));
    mesh
}

fn room(number: usize) -> Room {
    let widths = WIDTHS[number / 3];
    let before: f64 = widths[..number % 3].iter().map(|w| w + WALL).sum();
    let south = if number < 3 {
        -WALL - ROOM_DEPTH
    } else {
        HALL_WIDTH + WALL
    };
    Room::at(before, south, widths[number % 3], ROOM_DEPTH)
}

fn front(number: usize) -> Wall {
    if number < 3 { Wall::North } else { Wall::South }
}

fn hall() -> Room {
    let length = WIDTHS[0].iter().sum::<f64>() + 2.0 * WALL;
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
    let kitchen = room(1);
    space.carve(
        [kitchen.east, kitchen.north - ARCH[1], 0.0],
        [kitchen.east + WALL, kitchen.north - ARCH[0], ARCH_HEIGHT],
        2,
    );
    space.mesh(|face| {
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
