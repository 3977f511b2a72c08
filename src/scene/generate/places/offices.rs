//! Four by four furnished offices joined by doors.

use super::super::blocks::Blocks;
use super::super::dice::Dice;
use super::super::furniture::{
    ShelfSize, chair, cupboard, desk, lamp_panel, plant, screen, shelf, stool, table,
};
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::palette::*;
use super::room::{Paint, Room, Wall};

/// Offices along each side.
const COUNT: usize = 4;
/// Inner side of an office, thickness of the walls between them, and height, in metres.
const SIDE: f64 = 4.6;
const WALL: f64 = 0.2;
const HEIGHT: f64 = 2.8;
/// A door's distance from the middle of the wall, its width and height.
const DOOR_OFFSET: f64 = 1.2;
const DOOR_WIDTH: f64 = 0.9;
const DOOR_HEIGHT: f64 = 2.1;
/// Largest side of a mesh cell of the shell and of the furniture in metres.
const SHELL_CELL: f64 = 1.2;
const FURNITURE_CELL: f64 = 1.0;
/// Every so many-th office has its lamp on.
const LIT_EVERY: usize = 2;
/// The lamp panel's sides in metres and its light.
const LAMP: [f64; 2] = [1.2, 0.6];
const LAMP_LIGHT: Material = Material::lamp("lamp_on", [42.0, 42.0, 40.0]);
const LAMP_DARK: Material = Material::matte("lamp_off", [0.70, 0.70, 0.68]);

/// Builds the offices.
pub fn offices() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.object("offices", &shell());
    for number in 0..COUNT * COUNT {
        let room = room(number % COUNT, number / COUNT);
        let lit = (number % COUNT + number / COUNT).is_multiple_of(LIT_EVERY);
        let light = if lit { LAMP_LIGHT } else { LAMP_DARK };
        let lamp = lamp_panel(LAMP[0], LAMP[1], 0.6, STEEL, light);
        mesh.place("lamp", &lamp, room.hung(2.3, 2.3, HEIGHT - 0.1));
        furnish(&mut mesh, &room, number);
    }
    mesh
}

fn room(column: usize, row: usize) -> Room {
    let pitch = SIDE + WALL;
    Room::at(pitch * column as f64, pitch * row as f64, SIDE, SIDE)
}

fn shell() -> Mesh {
    let mut space = Blocks::solid().with_cell_size(SHELL_CELL);
    for number in 0..COUNT * COUNT {
        let room = room(number % COUNT, number / COUNT);
        room.carve(&mut space, HEIGHT, number as u16);
        let from = SIDE / 2.0 + DOOR_OFFSET - DOOR_WIDTH / 2.0;
        let to = from + DOOR_WIDTH;
        if number % COUNT + 1 < COUNT {
            space.carve(
                [room.east, room.south + from, 0.0],
                [room.east + WALL, room.south + to, DOOR_HEIGHT],
                number as u16,
            );
        }
        if number / COUNT + 1 < COUNT {
            space.carve(
                [room.west + from, room.north, 0.0],
                [room.west + to, room.north + WALL, DOOR_HEIGHT],
                number as u16,
            );
        }
    }
    let walls = [WARM_WHITE, COOL_WHITE, SAGE, OCHRE];
    space.mesh(|face| {
        let number = usize::from(face.air);
        Paint {
            floor: CARPET_GREY,
            walls: walls[(number + number / COUNT) % walls.len()],
            ceiling: CEILING_WHITE,
        }
        .of(face)
    })
}

/// Doors open near the north-eastern ends of the walls, so furniture keeps to the other parts.
fn furnish(mesh: &mut Mesh, room: &Room, number: usize) {
    let cell = FURNITURE_CELL;
    let mut dice = Dice::new(100 + number as u64);
    let desk = desk(1.6, cell, OAK, STEEL, DARK_METAL);
    mesh.place("desk", &desk, room.against(Wall::West, 1.6, 0.7));
    let seat = stool(8, DARK_METAL, CLOTH_BLUE);
    mesh.place("stool", &seat, room.inside(1.05, 1.6, 0.0));
    let books = ShelfSize {
        width: 1.4,
        height: 2.0,
        depth: 0.32,
        compartments: 5,
        books: 3,
    };
    let books = shelf(books, cell, PINE, &mut dice);
    mesh.place("bookcase", &books, room.against(Wall::South, 2.0, 0.32));
    match number % 3 {
        0 => {
            let meeting = table(1.2, 0.8, 0.74, cell, OAK);
            mesh.place("table", &meeting, room.inside(2.7, 1.9, 0.0));
            for (x, y, turn) in [(2.4, 1.2, 175.0), (3.0, 2.65, 8.0)] {
                let seat = chair(cell, OAK, CLOTH_GREEN);
                mesh.place("chair", &seat, room.inside(x, y, turn));
            }
        }
        1 => {
            let divider = screen(1.6, 1.5, cell, CLOTH_BLUE, STEEL);
            mesh.place("screen", &divider, room.inside(2.4, 1.8, 90.0));
            let second = super::super::furniture::desk(1.4, cell, PINE, STEEL, DARK_METAL);
            mesh.place("desk", &second, room.inside(2.9, 1.8, 270.0));
        }
        _ => {
            let files = cupboard([1.6, 0.45, 1.4], 3, cell, STEEL, COOL_WHITE);
            mesh.place("files", &files, room.against(Wall::East, 1.2, 0.45));
            let pot = plant(1.4, 3, 8, CLAY, LEAF);
            mesh.place("plant", &pot, room.inside(2.8, 2.4, 0.0));
        }
    }
    let low = cupboard([1.2, 0.4, 0.8], 2, cell, WALNUT, PINE);
    mesh.place("low_cupboard", &low, room.against(Wall::North, 1.2, 0.4));
}
