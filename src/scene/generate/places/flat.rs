//! Scene E: a flat of eight rooms along a hall. Its only windows are those of a narrow veranda at
//! its western end, so daylight reaches the rooms through the hall, round corners.

use super::super::blocks::Blocks;
use super::super::furniture::{bench, cupboard, lantern, plant};
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
/// How far the veranda reaches out from the rooms' western walls in metres.
const VERANDA_DEPTH: f64 = 1.1;
/// Its windows: their southern ends' y, width, sill and head, how deep they are set, in metres, and
/// their light.
const WINDOWS: [f64; 4] = [-3.6, -1.2, 2.2, 4.6];
const WINDOW_WIDTH: f64 = 1.0;
const SILL: [f64; 2] = [0.95, 2.25];
const WINDOW_DEPTH: f64 = 0.15;
const DAYLIGHT: Material = Material::lamp("daylight", [16.0, 18.0, 22.0]);
/// Largest side of a mesh cell of the shell in metres.
const SHELL_CELL: f64 = 0.86;
const DETAIL: Detail = Detail {
    cell: 0.62,
    segments: 8,
    books: 3,
};
/// The lanterns, all off: width and height, the height of their undersides, largest cell, in metres.
const LAMP: [f64; 2] = [0.4, 0.5];
const LAMP_HEIGHT: f64 = 1.9;
const LAMP_CELL: f64 = 0.5;
const LAMP_DARK: Material = Material::matte("lamp_off", [0.70, 0.70, 0.68]);
/// What is in the rooms, southern ones first, each row from the west, and the walls' paint.
const ROOMS: [(Interior, Material); 8] = [
    (Interior::Library, OCHRE),
    (Interior::Kitchen, COOL_WHITE),
    (Interior::Sitting, WARM_WHITE),
    (Interior::Bedroom, DUSTY_BLUE),
    (Interior::Study, SAGE),
    (Interior::Study, DUSTY_BLUE),
    (Interior::Bathroom, COOL_WHITE),
    (Interior::Bedroom, TERRACOTTA),
];
/// Tag of the air in the hall and the doorways.
const HALL_TAG: u16 = 10;
/// Tags of the air in the windows and on the veranda.
const WINDOW_TAG: u16 = 11;
const VERANDA_TAG: u16 = 12;
/// Presses in the hall: width, depth, height, largest cell, and their middles' distances from the
/// hall's western end along its southern and its northern wall, in metres.
const PRESS: [f64; 3] = [1.8, 0.4, 2.2];
const PRESS_CELL: f64 = 1.2;
const PRESSES: [(Wall, f64); 5] = [
    (Wall::South, 3.0),
    (Wall::South, 10.4),
    (Wall::North, 4.2),
    (Wall::North, 9.0),
    (Wall::North, 13.4),
];
/// The veranda's plants, one before each window: height, distance of their middles from the western
/// wall, and from the southern one, in metres.
const PLANT: f64 = 1.5;
const PLANT_OFF: f64 = 0.42;
const PLANTS: [f64; 4] = [1.5, 4.0, 7.2, 9.6];
/// Its benches' middles from the southern wall in metres.
const BENCHES: [f64; 2] = [2.75, 8.4];

/// Builds the flat.
pub fn flat() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.object("flat", &shell());
    for (number, &(interior, _)) in ROOMS.iter().enumerate() {
        let frame = room(number).seen_from(front(number));
        let lamp = lantern(LAMP[0], LAMP[1], LAMP_CELL, STEEL, LAMP_DARK);
        let at = frame.hung(frame.width / 2.0, frame.depth / 2.0, LAMP_HEIGHT);
        mesh.place("lamp", &lamp, at);
        furnish(&mut mesh, interior, &frame, DETAIL, 40 + number as u64);
    }
    furnish_hall(&mut mesh);
    furnish_veranda(&mut mesh);
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

/// Presses and a bench between the doors.
fn furnish_hall(mesh: &mut Mesh) {
    let press = cupboard(PRESS, 2, PRESS_CELL, OAK, PINE);
    for (wall, along) in PRESSES {
        mesh.place("press", &press, hall().against(wall, along, PRESS[1]));
    }
    let seat = bench(1.4, DETAIL.cell, OAK);
    mesh.place("bench", &seat, hall().against(Wall::South, 7.2, 0.44));
}

fn furnish_veranda(mesh: &mut Mesh) {
    let veranda = veranda();
    for along in PLANTS {
        let pot = plant(PLANT, 3, DETAIL.segments, CLAY, LEAF);
        mesh.place("plant", &pot, veranda.inside(PLANT_OFF, along, 0.0));
    }
    let seat = bench(1.4, DETAIL.cell, OAK);
    for along in BENCHES {
        mesh.place("bench", &seat, veranda.against(Wall::East, along, 0.44));
    }
}

/// West of the rooms, as wide as the house.
fn veranda() -> Room {
    Room {
        west: -WALL - VERANDA_DEPTH,
        south: -WALL - ROOM_DEPTH,
        east: -WALL,
        north: HALL_WIDTH + WALL + ROOM_DEPTH,
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
    let veranda = veranda();
    veranda.carve(&mut space, HEIGHT, VERANDA_TAG);
    let half = DOOR_WIDTH / 2.0;
    space.carve(
        [veranda.east, HALL_WIDTH / 2.0 - half, 0.0],
        [0.0, HALL_WIDTH / 2.0 + half, DOOR_HEIGHT],
        HALL_TAG,
    );
    for from in WINDOWS {
        space.carve(
            [veranda.west - WINDOW_DEPTH, from, SILL[0]],
            [veranda.west, from + WINDOW_WIDTH, SILL[1]],
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
            None if face.air == VERANDA_TAG => (STONE_FLOOR, WARM_WHITE),
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
