//! Crates on skids, stacks of them, and pallet racks.

use super::super::blocks::Blocks;
use super::super::dice::Dice;
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::placement::Placement;

/// Height of the skids under a crate in metres.
const SKID: f64 = 0.05;

/// A crate of `[width, depth, height]`, skids included, with a lid that stands out a little.
pub fn crate_box([width, depth, height]: [f64; 3], cell: f64, wood: Material) -> Mesh {
    let (x, y) = (width / 2.0, depth / 2.0);
    let mut blocks = Blocks::empty().with_cell_size(cell);
    for left in [-x, x - 0.1] {
        blocks.add([left, -y, 0.0], [left + 0.1, y, SKID], 0);
    }
    blocks.add([-x, -y, SKID], [x, y, height], 0);
    blocks.mesh(|_| wood)
}

/// `layers` crates on top of each other, each a little turned against the one below.
pub fn crate_stack(
    size: [f64; 3],
    layers: usize,
    cell: f64,
    woods: &[Material],
    dice: &mut Dice,
) -> Mesh {
    let mut stack = Mesh::default();
    for layer in 0..layers {
        let wood = woods[dice.pick(woods.len())];
        let turn = if layer == 0 {
            0.0
        } else {
            dice.between(-7.0, 7.0)
        };
        let placement = Placement::new(0.0, 0.0, size[2] * layer as f64, turn);
        stack.place("crate", &crate_box(size, cell, wood), placement);
    }
    stack.objects.clear();
    stack
}

/// A pallet rack: bays of 1.8 m between uprights, decks, and cartons on the decks.
#[derive(Clone, Copy, Debug)]
pub struct RackSize {
    /// Bays side by side.
    pub bays: usize,
    /// Decks one above the other.
    pub levels: usize,
    /// Height from deck to deck in metres.
    pub pitch: f64,
    /// Depth in metres.
    pub depth: f64,
    /// Largest side of a cell in metres.
    pub cell: f64,
}

/// Width of a bay between the axes of its uprights, and of an upright, in metres.
pub const BAY: f64 = 1.8;
const POST: f64 = 0.1;

/// Builds a rack centred on the origin; `boxes` are the materials of the cartons.
pub fn rack(size: RackSize, steel: Material, boxes: &[Material], dice: &mut Dice) -> Mesh {
    let (x, y) = (BAY * size.bays as f64 / 2.0, size.depth / 2.0);
    let top = size.pitch * size.levels as f64;
    let mut frame = Blocks::empty().with_cell_size(size.cell);
    for post in 0..=size.bays {
        let centre = -x + BAY * post as f64;
        for front in [-y, y - POST] {
            frame.add(
                [centre - POST / 2.0, front, 0.0],
                [centre + POST / 2.0, front + POST, top],
                0,
            );
        }
    }
    for level in 0..size.levels {
        let deck = size.pitch * level as f64 + 0.12;
        frame.add(
            [-x - POST / 2.0, -y, deck],
            [x + POST / 2.0, y, deck + 0.08],
            0,
        );
    }
    let mut rack = frame.mesh(|_| steel);
    for level in 0..size.levels {
        for bay in 0..size.bays {
            // Two cartons a bay, 2 cm clear of the uprights and of each other.
            let room = (BAY - POST) / 2.0 - 0.03;
            for side in [-0.5, 0.5] {
                let height = size.pitch * dice.between(0.50, 0.86) - 0.1;
                let width = room * dice.between(0.8, 1.0);
                let carton = [width, size.depth * 0.9, height];
                let wood = boxes[dice.pick(boxes.len())];
                let at = Placement::new(
                    -x + BAY * (bay as f64 + 0.5) + side * (BAY - POST) / 2.0,
                    0.0,
                    size.pitch * level as f64 + 0.20,
                    0.0,
                );
                rack.place("carton", &crate_box(carton, size.cell, wood), at);
            }
        }
    }
    rack.objects.clear();
    rack
}
