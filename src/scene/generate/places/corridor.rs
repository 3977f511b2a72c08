//! A corridor with four turns and a light at one end: far rooms live on many reflections.

use super::super::blocks::Blocks;
use super::super::furniture::{bench, block, cupboard, lamp_panel, plant};
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::palette::*;
use super::room::{Paint, Room, Wall};

/// Width and height of the corridor in metres.
const WIDTH: f64 = 2.0;
const HEIGHT: f64 = 2.7;
/// The middle line's corners, from the lit end on; each turn is a right angle.
const CORNERS: [[f64; 2]; 6] = [
    [0.0, 0.0],
    [8.0, 0.0],
    [8.0, 7.0],
    [16.0, 7.0],
    [16.0, 14.0],
    [24.0, 14.0],
];
/// Largest side of a mesh cell of the shell in metres.
const CELL: f64 = 2.0;
/// The lamp panel's sides in metres and its light.
const LAMP: [f64; 2] = [1.2, 1.2];
const LAMP_LIGHT: Material = Material::lamp("ceiling_lamp", [40.0, 38.0, 34.0]);

/// Builds the corridor.
pub fn corridor() -> Mesh {
    let mut space = Blocks::solid().with_cell_size(CELL);
    let half = WIDTH / 2.0;
    for pair in CORNERS.windows(2) {
        let leg = Room {
            west: pair[0][0].min(pair[1][0]) - half,
            south: pair[0][1].min(pair[1][1]) - half,
            east: pair[0][0].max(pair[1][0]) + half,
            north: pair[0][1].max(pair[1][1]) + half,
        };
        leg.carve(&mut space, HEIGHT, 0);
    }
    let paint = Paint {
        floor: STONE_FLOOR,
        walls: WARM_WHITE,
        ceiling: CEILING_WHITE,
    };
    let mut mesh = Mesh::default();
    mesh.object("corridor", &space.mesh(|face| paint.of(face)));
    let lamp = lamp_panel(LAMP[0], LAMP[1], CELL, STEEL, LAMP_LIGHT);
    let lit_end = Room::at(-half, -half, WIDTH, WIDTH);
    mesh.place(
        "ceiling_lamp",
        &lamp,
        lit_end.hung(half, half, HEIGHT - 0.1),
    );
    furnish(&mut mesh);
    mesh
}

/// A bench, lockers, a plant and a box along the walls of every leg.
fn furnish(mesh: &mut Mesh) {
    let half = WIDTH / 2.0;
    for (index, pair) in CORNERS.windows(2).enumerate() {
        let [a, b] = [pair[0], pair[1]];
        let along_x = a[1] == b[1];
        let leg = if along_x {
            Room::at(a[0] + half, a[1] - half, b[0] - a[0] - WIDTH, WIDTH)
        } else {
            Room::at(a[0] - half, a[1] + half, WIDTH, b[1] - a[1] - WIDTH)
        };
        let (left, right, length) = if along_x {
            (Wall::North, Wall::South, leg.width())
        } else {
            (Wall::West, Wall::East, leg.depth())
        };
        let seat = bench(1.6, CELL, OAK);
        mesh.place("bench", &seat, leg.against(left, length * 0.3, 0.44));
        let locker = cupboard([1.2, 0.45, 1.9], 2, CELL, STEEL, DUSTY_BLUE);
        mesh.place("lockers", &locker, leg.against(right, length * 0.65, 0.45));
        let pot = plant(1.2, 1, 6, CLAY, LEAF);
        mesh.place("plant", &pot, leg.against(left, length - 0.5, 0.64));
        let box_on_floor = block([0.4, 0.4, 0.5], CELL, [CARDBOARD, PINE][index % 2]);
        mesh.place("box", &box_on_floor, leg.against(right, 0.5, 0.4));
    }
}
