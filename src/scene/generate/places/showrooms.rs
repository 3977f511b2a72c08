//! Scene B: a furniture house of 10 x 10 showrooms. Wide openings line up in both directions, so
//! every room sees a good part of the others.

use super::super::blocks::Blocks;
use super::super::dice::Dice;
use super::super::furniture::{
    ShelfSize, bed, chair, cupboard, floor_lamp, lantern, plant, round_table, shelf, sofa, table,
    vase,
};
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::palette::*;
use super::room::{Paint, Room, Wall};

/// Rooms along each side.
const COUNT: usize = 10;
/// Inner side of a room, thickness of walls, height, in metres.
const SIDE: f64 = 5.0;
const WALL: f64 = 0.2;
const HEIGHT: f64 = 3.0;
/// Width and height of the openings in the middle of every wall between rooms, in metres.
const OPENING_WIDTH: f64 = 1.8;
const OPENING_HEIGHT: f64 = 2.4;
/// Largest sides of mesh cells of the shell and the furniture in metres.
const SHELL_CELL: f64 = 1.7;
const FURNITURE_CELL: f64 = 1.5;
/// Sides of what is round.
const SEGMENTS: usize = 6;
/// One room in so many is lit.
const LIT_EVERY: usize = 5;
/// The lanterns' width and height, the height of their undersides, largest cell, in metres, and
/// their light.
const LAMP: [f64; 2] = [0.5, 0.6];
const LAMP_HEIGHT: f64 = 2.1;
const LAMP_CELL: f64 = 0.6;
const LAMP_LIGHT: Material = Material::lamp("lamp_on", [40.0, 38.0, 34.0]);
const LAMP_DARK: Material = Material::matte("lamp_off", [0.70, 0.70, 0.68]);

/// Builds the house.
pub fn showrooms() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.object("showrooms", &shell());
    for number in 0..COUNT * COUNT {
        let (column, row) = (number % COUNT, number / COUNT);
        let room = room(column, row);
        // Two columns on from row to row: the lit rooms lie like knights' moves on a chessboard.
        let lit = (column + 2 * row).is_multiple_of(LIT_EVERY);
        let light = if lit { LAMP_LIGHT } else { LAMP_DARK };
        let lamp = lantern(LAMP[0], LAMP[1], LAMP_CELL, STEEL, light);
        let middle = SIDE / 2.0;
        mesh.place("lamp", &lamp, room.hung(middle, middle, LAMP_HEIGHT));
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
    let from = (SIDE - OPENING_WIDTH) / 2.0;
    let to = from + OPENING_WIDTH;
    for number in 0..COUNT * COUNT {
        let (column, row) = (number % COUNT, number / COUNT);
        let room = room(column, row);
        room.carve(&mut space, HEIGHT, number as u16);
        if column + 1 < COUNT {
            space.carve(
                [room.east, room.south + from, 0.0],
                [room.east + WALL, room.south + to, OPENING_HEIGHT],
                number as u16,
            );
        }
        if row + 1 < COUNT {
            space.carve(
                [room.west + from, room.north, 0.0],
                [room.west + to, room.north + WALL, OPENING_HEIGHT],
                number as u16,
            );
        }
    }
    let walls = [WARM_WHITE, COOL_WHITE, SAGE, OCHRE, DUSTY_BLUE, TERRACOTTA];
    space.mesh(|face| {
        let number = usize::from(face.air);
        Paint {
            floor: [PARQUET, CARPET_GREY][(number + number / COUNT) % 2],
            walls: walls[Dice::new(face.air.into()).pick(walls.len())],
            ceiling: CEILING_WHITE,
        }
        .of(face)
    })
}

/// Furniture keeps to the four corners, seen from each wall in turn, and to the middle.
fn furnish(mesh: &mut Mesh, room: &Room, number: usize) {
    let cell = FURNITURE_CELL;
    let mut dice = Dice::new(500 + number as u64);
    let cloths = [CLOTH_BLUE, CLOTH_GREEN, CLOTH_RUST, RUG_RED];
    let first = dice.pick(4);
    for (turn, front) in [Wall::South, Wall::East, Wall::North, Wall::West]
        .into_iter()
        .enumerate()
    {
        let frame = room.seen_from(front);
        let cloth = cloths[dice.pick(cloths.len())];
        // Each corner holds what stands in the frame's south-western one.
        match (turn + first) % 4 {
            0 => {
                let books = ShelfSize {
                    width: 1.3,
                    height: 1.5,
                    depth: 0.32,
                    compartments: 3,
                    books: 1,
                };
                let piece = shelf(books, cell, PINE, &mut dice);
                mesh.place("bookcase", &piece, frame.against(Wall::South, 0.75, 0.32));
            }
            1 => {
                let piece = sofa(1, cell, cloth, OAK);
                mesh.place("armchair", &piece, frame.inside(0.95, 0.85, 140.0));
            }
            2 => {
                let piece = cupboard([1.3, 0.45, 1.0], 2, cell, OAK, PINE);
                mesh.place("sideboard", &piece, frame.against(Wall::South, 0.75, 0.45));
                let pot = vase(0.35, SEGMENTS, CLAY);
                mesh.place("vase", &pot, frame.hung(0.75, 0.25, 1.0));
            }
            _ => {
                let pot = plant(1.5, 1, SEGMENTS, CLAY, LEAF);
                mesh.place("plant", &pot, frame.inside(0.5, 0.5, 0.0));
                let lamp = floor_lamp(5, DARK_METAL, LAMPSHADE);
                mesh.place("floor_lamp", &lamp, frame.inside(1.25, 0.35, 0.0));
            }
        }
    }
    let middle = SIDE / 2.0;
    match dice.pick(3) {
        0 => {
            let piece = round_table(0.55, 0.74, SEGMENTS, WALNUT);
            mesh.place("round_table", &piece, room.inside(middle, middle, 0.0));
            let piece = chair(cell, OAK, CLOTH_GREEN);
            mesh.place("chair", &piece, room.inside(middle - 0.9, middle, 95.0));
        }
        1 => {
            let piece = bed(1.4, cell, OAK, RUG_RED, LINEN);
            mesh.place("bed", &piece, room.inside(middle, middle, 0.0));
        }
        _ => {
            let piece = table(1.5, 0.8, 0.74, cell, OAK);
            mesh.place("table", &piece, room.inside(middle, middle, 12.0));
            let piece = chair(cell, OAK, CLOTH_BLUE);
            mesh.place("chair", &piece, room.inside(middle, middle + 0.75, 5.0));
        }
    }
}
