//! Scene C: one open hall full of racks, stacks and screens. Everything hides something, and
//! there is no door to reason about.

use super::super::blocks::Blocks;
use super::super::dice::Dice;
use super::super::furniture::{BAY, RackSize, crate_stack, desk, lamp_panel, rack, screen, stool};
use super::super::lathe::cylinder;
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::palette::*;
use super::super::placement::Placement;
use super::room::{Paint, Room, Wall};

/// The hall in metres.
const HALL: Room = Room {
    west: 0.0,
    south: 0.0,
    east: 32.0,
    north: 22.0,
};
const HEIGHT: f64 = 6.5;
/// Middles of the pillars and their side in metres.
const PILLARS: [[f64; 2]; 3] = [[8.0, 18.3], [16.0, 18.3], [24.0, 11.0]];
const PILLAR: f64 = 0.6;
/// Rows of racks, the first row's distance from the south wall, and the way from row to row.
const ROWS: usize = 5;
const FIRST_ROW: f64 = 2.2;
const ROW_PITCH: f64 = 3.0;
/// Racks in a row, where the row begins, and the gap between its racks.
const RACKS: usize = 3;
const ROW_START: f64 = 2.0;
const RACK_GAP: f64 = 1.4;
const RACK: RackSize = RackSize {
    bays: 3,
    levels: 3,
    pitch: 1.5,
    depth: 1.1,
    cell: 0.6,
};
/// Stacks of crates in the open part, columns by rows, and the way from one to the next.
const STACKS: [usize; 2] = [3, 7];
const STACK_PITCH: [f64; 2] = [2.3, 2.2];
/// Largest side of a mesh cell of the shell in metres.
const SHELL_CELL: f64 = 0.95;
/// Lamp panels: where they hang along the hall, over which rows of racks (counted from the south),
/// the height of their undersides, just above the racks, sides and largest cell, in metres; light.
const LAMPS: [f64; 4] = [4.75, 11.65, 18.55, 27.9];
const LAMP_ROWS: [f64; 2] = [1.0, 3.0];
const LAMP_HEIGHT: f64 = 4.55;
const LAMP: [f64; 2] = [2.4, 0.6];
const LAMP_CELL: f64 = 0.6;
const LAMP_LIGHT: Material = Material::lamp("hall_lamp", [60.0, 60.0, 58.0]);

/// Builds the hall.
pub fn warehouse() -> Mesh {
    let mut space = Blocks::solid().with_cell_size(SHELL_CELL);
    HALL.carve(&mut space, HEIGHT, 0);
    for [x, y] in PILLARS {
        let half = PILLAR / 2.0;
        space.add([x - half, y - half, 0.0], [x + half, y + half, HEIGHT], 0);
    }
    let paint = Paint {
        floor: CONCRETE,
        walls: COOL_WHITE,
        ceiling: CEILING_WHITE,
    };
    let mut mesh = Mesh::default();
    mesh.object("hall", &space.mesh(|face| paint.of(face)));
    let lamp = lamp_panel(LAMP[0], LAMP[1], LAMP_CELL, STEEL, LAMP_LIGHT);
    for x in LAMPS {
        for row in LAMP_ROWS {
            let y = FIRST_ROW + ROW_PITCH * row;
            mesh.place("lamp", &lamp, HALL.hung(x, y, LAMP_HEIGHT));
        }
    }
    let mut dice = Dice::new(7);
    place_racks(&mut mesh, &mut dice);
    place_stacks(&mut mesh, &mut dice);
    place_packing_corner(&mut mesh);
    mesh
}

fn place_racks(mesh: &mut Mesh, dice: &mut Dice) {
    let cartons = [CARDBOARD, PINE, BOOKS[1], BOOKS[4]];
    let length = BAY * RACK.bays as f64 + 0.1;
    for row in 0..ROWS {
        for column in 0..RACKS {
            let x = ROW_START + length / 2.0 + (length + RACK_GAP) * column as f64;
            let y = FIRST_ROW + ROW_PITCH * row as f64;
            let piece = rack(RACK, STEEL, &cartons, dice);
            mesh.place("rack", &piece, Placement::on_floor(x, y, 0.0));
        }
    }
}

fn place_stacks(mesh: &mut Mesh, dice: &mut Dice) {
    for column in 0..STACKS[0] {
        for row in 0..STACKS[1] {
            let size = [
                dice.between(1.0, 1.3),
                dice.between(0.9, 1.2),
                dice.between(0.7, 1.0),
            ];
            let layers = 2 + dice.pick(3);
            let woods = [PINE, OAK, CARDBOARD];
            let piece = crate_stack(size, layers, RACK.cell, &woods, dice);
            let x = HALL.east - 1.8 - STACK_PITCH[0] * column as f64 + dice.between(-0.2, 0.2);
            let y = HALL.south + 1.8 + STACK_PITCH[1] * row as f64 + dice.between(-0.2, 0.2);
            let turn = dice.between(-20.0, 20.0);
            mesh.place("crates", &piece, Placement::on_floor(x, y, turn));
        }
    }
}

/// Desks between screens along the north wall, where goods are packed.
fn place_packing_corner(mesh: &mut Mesh) {
    let divider = screen(2.6, 2.2, RACK.cell, DUSTY_BLUE, STEEL);
    let writing = desk(1.6, RACK.cell, OAK, STEEL, DARK_METAL);
    let seat = stool(12, DARK_METAL, CLOTH_BLUE);
    for place in 0..6 {
        let x = 3.0 + 4.2 * f64::from(place);
        mesh.place("desk", &writing, HALL.against(Wall::North, x, 0.7));
        mesh.place("stool", &seat, HALL.inside(x, HALL.depth() - 1.2, 0.0));
        let across = HALL.inside(x + 2.1, HALL.depth() - 1.5, 90.0);
        mesh.place("screen", &divider, across);
    }
    let drum = cylinder(0.3, 0.9, 16, BOOKS[0]);
    for (x, off) in [
        (22.5, 0.5),
        (22.6, 1.2),
        (27.4, 0.5),
        (28.1, 0.6),
        (27.8, 1.25),
    ] {
        mesh.place("drum", &drum, HALL.inside(x, HALL.depth() - off, 0.0));
    }
}
