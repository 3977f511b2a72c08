//! Scene D: one living room with few pieces, two screens among them: most things see most others.

use super::super::blocks::Blocks;
use super::super::dice::Dice;
use super::super::furniture::{
    ShelfSize, bench, lamp_panel, panel_chair, plant, screen, shelf, sofa, table,
};
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::palette::*;
use super::room::{Paint, Room, Wall};

/// The room in metres, with a deep window bay in its northern wall.
const ROOM: Room = Room {
    west: 0.0,
    south: 0.0,
    east: 6.4,
    north: 4.8,
};
const HEIGHT: f64 = 2.7;
/// The window: from x to x, sill and head, and how deep it is set, in metres.
const WINDOW: [f64; 2] = [2.0, 4.4];
const SILL: [f64; 2] = [0.9, 2.2];
const WINDOW_DEPTH: f64 = 0.3;
/// Largest sides of mesh cells of the shell and the furniture in metres.
const SHELL_CELL: f64 = 1.7;
const FURNITURE_CELL: f64 = 2.4;
/// The lamp panel over the seats: its middle, sides and largest cell in metres, and its light.
const LAMP_AT: [f64; 2] = [2.1, 2.4];
const LAMP: [f64; 2] = [1.2, 1.2];
const LAMP_CELL: f64 = 0.6;
const LAMP_LIGHT: Material = Material::lamp("ceiling_lamp", [30.0, 26.0, 20.0]);

/// Builds the room.
pub fn living_room() -> Mesh {
    let mut space = Blocks::solid().with_cell_size(SHELL_CELL);
    ROOM.carve(&mut space, HEIGHT, 0);
    space.carve(
        [WINDOW[0], ROOM.north, SILL[0]],
        [WINDOW[1], ROOM.north + WINDOW_DEPTH, SILL[1]],
        1,
    );
    let paint = Paint {
        floor: PARQUET,
        walls: WARM_WHITE,
        ceiling: CEILING_WHITE,
    };
    let shell = space.mesh(|face| match face.air {
        1 if face.normal.y < -0.5 => GLASS_DARK,
        1 => CEILING_WHITE,
        _ => paint.of(face),
    });
    let mut mesh = Mesh::default();
    mesh.object("room", &shell);
    let lamp = lamp_panel(LAMP[0], LAMP[1], LAMP_CELL, STEEL, LAMP_LIGHT);
    mesh.place(
        "lamp",
        &lamp,
        ROOM.hung(LAMP_AT[0], LAMP_AT[1], HEIGHT - 0.1),
    );
    furnish(&mut mesh);
    mesh
}

fn furnish(mesh: &mut Mesh) {
    let cell = FURNITURE_CELL;
    let couch = sofa(2, cell, CLOTH_GREEN, OAK);
    mesh.place("sofa", &couch, ROOM.against(Wall::West, 2.4, 0.9));
    let low = table(1.0, 0.6, 0.42, cell, OAK);
    mesh.place("low_table", &low, ROOM.inside(1.9, 2.4, 90.0));
    let seat = panel_chair(OAK, CLOTH_RUST);
    mesh.place("chair", &seat, ROOM.inside(5.0, 3.1, 305.0));
    let books = ShelfSize {
        width: 1.4,
        height: 1.2,
        depth: 0.32,
        compartments: 2,
        books: 2,
    };
    let books = shelf(books, cell, PINE, &mut Dice::new(3));
    mesh.place("bookcase", &books, ROOM.against(Wall::East, 1.6, 0.32));
    let divider = screen(2.0, 1.9, cell, CLOTH_BLUE, OAK);
    mesh.place("screen", &divider, ROOM.inside(3.9, 3.4, 90.0));
    let folding = screen(2.0, 1.9, cell, LINEN, DARK_METAL);
    mesh.place("screen", &folding, ROOM.inside(4.3, 1.2, 75.0));
    let seat = bench(1.4, cell, OAK);
    mesh.place("bench", &seat, ROOM.against(Wall::South, 2.6, 0.44));
    let pot = plant(1.2, 1, 6, CLAY, LEAF);
    mesh.place("plant", &pot, ROOM.inside(5.8, 4.2, 0.0));
}
