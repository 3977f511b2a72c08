//! The demo: a living room and a bedroom joined by a door; only the living room has a lamp.

use super::super::blocks::Blocks;
use super::super::dice::Dice;
use super::super::furniture::{
    ShelfSize, bed, cupboard, floor_lamp, lamp_panel, panel_chair, plant, round_table, shelf, sofa,
    table,
};
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::palette::*;
use super::room::{Paint, Room, Wall};

const LIVING: Room = Room {
    west: 0.0,
    south: 0.0,
    east: 5.2,
    north: 4.2,
};
const BEDROOM: Room = Room {
    west: 5.35,
    south: 0.0,
    east: 9.15,
    north: 4.2,
};
const HEIGHT: f64 = 2.6;
/// The door: from y to y, and its height.
const DOOR: [f64; 2] = [1.3, 2.2];
const DOOR_HEIGHT: f64 = 2.1;
/// Largest side of a mesh cell of the shell in metres.
const SHELL_CELL: f64 = 1.3;
/// Largest side of a mesh cell of the furniture in metres.
const FURNITURE_CELL: f64 = 1.5;
/// The lamp panel's sides in metres and its light, that of a warm white lamp.
const LAMP: [f64; 2] = [1.2, 0.8];
const LAMP_LIGHT: Material = Material::lamp("ceiling_lamp", [34.0, 27.0, 18.0]);

/// Builds the two rooms.
pub fn two_rooms() -> Mesh {
    let mut mesh = Mesh::default();
    mesh.object("rooms", &shell());
    let lamp = lamp_panel(LAMP[0], LAMP[1], FURNITURE_CELL, STEEL, LAMP_LIGHT);
    mesh.place("ceiling_lamp", &lamp, LIVING.hung(2.6, 2.1, HEIGHT - 0.1));
    furnish_living_room(&mut mesh);
    furnish_bedroom(&mut mesh);
    mesh
}

fn shell() -> Mesh {
    let mut space = Blocks::solid().with_cell_size(SHELL_CELL);
    LIVING.carve(&mut space, HEIGHT, 0);
    BEDROOM.carve(&mut space, HEIGHT, 1);
    space.carve(
        [LIVING.east, DOOR[0], 0.0],
        [BEDROOM.west, DOOR[1], DOOR_HEIGHT],
        2,
    );
    let living = Paint {
        floor: PARQUET,
        walls: WARM_WHITE,
        ceiling: CEILING_WHITE,
    };
    let bedroom = Paint {
        floor: PARQUET,
        walls: TERRACOTTA,
        ceiling: CEILING_WHITE,
    };
    space.mesh(|face| match face.air {
        1 => bedroom.of(face),
        _ => living.of(face),
    })
}

fn furnish_living_room(mesh: &mut Mesh) {
    let cell = FURNITURE_CELL;
    let mut dice = Dice::new(1);
    mesh.place(
        "sofa",
        &sofa(3, cell, CLOTH_RUST, OAK),
        LIVING.against(Wall::South, 2.4, 0.9),
    );
    mesh.place(
        "coffee_table",
        &table(1.1, 0.6, 0.42, cell, OAK),
        LIVING.inside(2.4, 1.75, 0.0),
    );
    let books = ShelfSize {
        width: 1.6,
        height: 2.0,
        depth: 0.32,
        compartments: 4,
        books: 2,
    };
    mesh.place(
        "bookcase",
        &shelf(books, cell, OAK, &mut dice),
        LIVING.against(Wall::North, 1.5, 0.32),
    );
    mesh.place(
        "sideboard",
        &cupboard([1.4, 0.42, 0.8], 1, cell, WALNUT, OCHRE),
        LIVING.against(Wall::North, 3.6, 0.42),
    );
    mesh.place(
        "floor_lamp",
        &floor_lamp(6, DARK_METAL, LAMPSHADE),
        LIVING.inside(0.55, 0.6, 0.0),
    );
    mesh.place(
        "plant",
        &plant(1.3, 1, 6, CLAY, LEAF),
        LIVING.inside(4.7, 0.5, 0.0),
    );
}

fn furnish_bedroom(mesh: &mut Mesh) {
    let cell = FURNITURE_CELL;
    mesh.place(
        "bed",
        &bed(1.6, cell, OAK, RUG_RED, LINEN),
        BEDROOM.against(Wall::North, 2.4, 2.1),
    );
    mesh.place(
        "bedside_table",
        &round_table(0.24, 0.5, 6, WALNUT),
        BEDROOM.inside(1.2, 3.8, 0.0),
    );
    mesh.place(
        "wardrobe",
        &cupboard([1.6, 0.6, 2.1], 2, cell, OAK, PINE),
        BEDROOM.against(Wall::South, 2.8, 0.6),
    );
    mesh.place(
        "writing_table",
        &table(1.0, 0.55, 0.74, cell, PINE),
        BEDROOM.against(Wall::South, 1.1, 0.55),
    );
    let chair = BEDROOM.inside(1.15, 0.95, 24.0);
    mesh.place("chair", &panel_chair(PINE, CLOTH_BLUE), chair);
}
