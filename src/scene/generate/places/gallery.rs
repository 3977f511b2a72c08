//! Scene F: an exhibition hall of few large polygons. Walls that do not reach its sides and
//! blocks to the ceiling: what one sees is wholly in view or wholly hidden.

use super::super::blocks::Blocks;
use super::super::furniture::{bench, block, lamp_panel};
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::palette::*;
use super::room::{Paint, Room};

/// The hall in metres.
const HALL: Room = Room {
    west: 0.0,
    south: 0.0,
    east: 24.0,
    north: 16.0,
};
const HEIGHT: f64 = 5.0;
/// Standing walls up to the ceiling: from corner to corner of their plan, in metres.
const WALLS: [[[f64; 2]; 2]; 4] = [
    [[6.4, 0.0], [6.8, 9.6]],
    [[16.0, 5.4], [16.4, 16.0]],
    [[0.0, 11.0], [4.8, 11.4]],
    [[20.0, 5.0], [24.0, 5.4]],
];
/// Blocks lower than the hall: middle of their plan, sides and height, in metres.
const BLOCKS: [([f64; 2], [f64; 3]); 11] = [
    ([3.6, 5.0], [2.4, 2.4, 2.6]),
    ([11.2, 4.4], [1.6, 4.0, 3.8]),
    ([11.6, 12.2], [3.0, 3.0, 4.0]),
    ([20.4, 10.8], [2.6, 1.8, 3.4]),
    ([6.4, 13.6], [1.6, 1.6, 3.6]),
    ([20.2, 2.4], [2.0, 2.0, 1.6]),
    ([4.4, 1.4], [2.2, 0.8, 2.0]),
    ([22.4, 14.2], [1.2, 1.2, 2.8]),
    ([18.4, 14.0], [1.0, 2.4, 1.8]),
    ([14.2, 8.0], [0.3, 5.0, 4.2]),
    ([9.0, 13.0], [0.3, 4.0, 4.2]),
];
/// A window of frosted glass in the western wall: from y to y, sill and head in metres, its light.
const WINDOW: [f64; 2] = [2.0, 8.0];
const SILL: [f64; 2] = [1.0, 4.0];
const DAYLIGHT: Material = Material::lamp("daylight", [16.0, 18.0, 22.0]);
/// Tag of its pane; the standing walls have the tags from 1 on.
const PANE: u16 = 100;
/// Largest sides of mesh cells of the shell and of the blocks in metres.
const SHELL_CELL: f64 = 3.6;
const BLOCK_CELL: f64 = 4.0;
/// The lamp panel's middle, sides and largest cell in metres, and its light.
const PANEL: [f64; 2] = [3.0, 8.0];
const LAMP: [f64; 2] = [2.0, 1.0];
const LAMP_CELL: f64 = 1.0;
const LAMP_LIGHT: Material = Material::lamp("gallery_lamp", [60.0, 58.0, 54.0]);

/// Builds the hall.
pub fn gallery() -> Mesh {
    let mut space = Blocks::solid().with_cell_size(SHELL_CELL);
    HALL.carve(&mut space, HEIGHT, 0);
    for (number, [from, to]) in WALLS.into_iter().enumerate() {
        let tag = 1 + number as u16;
        space.add([from[0], from[1], 0.0], [to[0], to[1], HEIGHT], tag);
    }
    // Glass as thick as it pleases: only its inner side shows.
    space.add(
        [-0.1, WINDOW[0], SILL[0]],
        [HALL.west, WINDOW[1], SILL[1]],
        PANE,
    );
    let colours = [TERRACOTTA, DUSTY_BLUE, OCHRE, SAGE];
    let paint = |walls| Paint {
        floor: STONE_FLOOR,
        walls,
        ceiling: CEILING_WHITE,
    };
    let shell = space.mesh(|face| match face.solid {
        0 => paint(WARM_WHITE).of(face),
        PANE => DAYLIGHT,
        wall => paint(colours[usize::from(wall) - 1]).of(face),
    });
    let mut mesh = Mesh::default();
    mesh.object("hall", &shell);
    let lamp = lamp_panel(LAMP[0], LAMP[1], LAMP_CELL, STEEL, LAMP_LIGHT);
    mesh.place("lamp", &lamp, HALL.hung(PANEL[0], PANEL[1], HEIGHT - 0.2));
    for ([x, y], size) in BLOCKS {
        let piece = block(size, BLOCK_CELL, CEILING_WHITE);
        mesh.place("exhibit", &piece, HALL.inside(x, y, 0.0));
    }
    for x in [3.4, 11.4, 20.4] {
        let seat = bench(2.0, BLOCK_CELL, OAK);
        mesh.place("bench", &seat, HALL.inside(x, 8.0, 0.0));
    }
    mesh
}
