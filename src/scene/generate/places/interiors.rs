//! Furnished interiors: what makes a room a bedroom or a study.
//!
//! The door is in the front wall (the frame's south), within 1.6 m of its eastern end; that corner
//! stays free. Rooms are at least 3.6 m wide and 4 m deep.

use super::super::dice::Dice;
use super::super::furniture::{
    ShelfSize, bath, bed, chair, counter, cupboard, desk, floor_lamp, plant, round_table, shelf,
    sofa, stool, table, table_lamp, vase,
};
use super::super::material::Material;
use super::super::mesh::Mesh;
use super::super::palette::*;
use super::super::placement::Placement;
use super::room::{Frame, Wall};

/// How finely a place is meshed.
#[derive(Clone, Copy, Debug)]
pub struct Detail {
    /// Largest side of a cell of flat furniture in metres.
    pub cell: f64,
    /// Sides of what is round.
    pub segments: usize,
    /// Groups of books in a compartment of a bookcase.
    pub books: usize,
}

/// Kinds of interiors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interior {
    /// Bed, wardrobe, dressing table.
    Bedroom,
    /// Sofa, armchair, low table, bookcase.
    Sitting,
    /// Desk and bookcases.
    Study,
    /// Counter, table with four chairs, dresser.
    Kitchen,
    /// Bath, washstand, cupboard.
    Bathroom,
    /// Bookcases around a reading table.
    Library,
}

const CLOTHS: [Material; 4] = [CLOTH_BLUE, CLOTH_GREEN, CLOTH_RUST, RUG_RED];

/// Furnishes a room.
pub fn furnish(mesh: &mut Mesh, interior: Interior, frame: &Frame, detail: Detail, seed: u64) {
    let mut room = Furnisher {
        mesh,
        frame,
        detail,
        dice: Dice::new(seed),
    };
    match interior {
        Interior::Bedroom => room.bedroom(),
        Interior::Sitting => room.sitting(),
        Interior::Study => room.study(),
        Interior::Kitchen => room.kitchen(),
        Interior::Bathroom => room.bathroom(),
        Interior::Library => room.library(),
    }
}

struct Furnisher<'a> {
    mesh: &'a mut Mesh,
    frame: &'a Frame,
    detail: Detail,
    dice: Dice,
}

impl Furnisher<'_> {
    fn put(&mut self, name: &'static str, piece: &Mesh, at: Placement) {
        self.mesh.place(name, piece, at);
    }

    fn cloth(&mut self) -> Material {
        CLOTHS[self.dice.pick(CLOTHS.len())]
    }

    fn bookcase(&mut self, width: f64, height: f64, wall: Wall, along: f64) {
        let depth = 0.32;
        let size = ShelfSize {
            width,
            height,
            depth,
            compartments: (height / 0.38) as usize,
            books: self.detail.books,
        };
        let piece = shelf(size, self.detail.cell, PINE, &mut self.dice);
        self.put("bookcase", &piece, self.frame.against(wall, along, depth));
    }

    fn cupboard(&mut self, size: [f64; 3], doors: usize, wall: Wall, along: f64) {
        let piece = cupboard(size, doors, self.detail.cell, OAK, PINE);
        self.put("cupboard", &piece, self.frame.against(wall, along, size[1]));
    }

    fn potted_plant(&mut self, height: f64, x: f64, y: f64) {
        let piece = plant(height, 3, self.detail.segments, CLAY, LEAF);
        self.put("plant", &piece, self.frame.inside(x, y, 0.0));
    }

    fn chair(&mut self, x: f64, y: f64, degrees: f64) {
        let cloth = self.cloth();
        let turn = degrees + self.dice.between(-9.0, 9.0);
        let piece = chair(self.detail.cell, OAK, cloth);
        self.put("chair", &piece, self.frame.inside(x, y, turn));
    }

    fn bedroom(&mut self) {
        let (w, d) = (self.frame.width, self.frame.depth);
        let cloth = self.cloth();
        let piece = bed(1.6, self.detail.cell, OAK, cloth, LINEN);
        self.put("bed", &piece, self.frame.against(Wall::North, w / 2.0, 2.1));
        for x in [w / 2.0 - 1.1, w / 2.0 + 1.1] {
            let at = self.frame.inside(x, d - 0.3, 0.0);
            let night_table = round_table(0.22, 0.5, self.detail.segments, WALNUT);
            self.put("night_table", &night_table, at);
            let lamp = table_lamp(self.detail.segments, DARK_METAL, LAMPSHADE);
            self.put("table_lamp", &lamp, self.frame.hung(x, d - 0.3, 0.5));
        }
        self.cupboard([1.5, 0.58, 2.1], 3, Wall::West, 1.0);
        let dressing = table(1.0, 0.45, 0.74, self.detail.cell, PINE);
        let at = self.frame.against(Wall::East, 1.9, 0.45);
        self.put("dressing_table", &dressing, at);
        self.chair(w - 0.9, 1.9, 90.0);
    }

    fn sitting(&mut self) {
        let (w, d) = (self.frame.width, self.frame.depth);
        let cloth = self.cloth();
        let couch = sofa(3, self.detail.cell, cloth, OAK);
        self.put("sofa", &couch, self.frame.against(Wall::West, d / 2.0, 0.9));
        let low = table(0.6, 1.1, 0.42, self.detail.cell, OAK);
        self.put("low_table", &low, self.frame.inside(1.6, d / 2.0, 0.0));
        let armchair = sofa(1, self.detail.cell, cloth, OAK);
        let at = self.frame.inside(w - 0.9, d / 2.0 + 0.2, 284.0);
        self.put("armchair", &armchair, at);
        self.bookcase(1.6, 2.0, Wall::North, w / 2.0);
        self.potted_plant(1.3, 0.45, d - 0.45);
        let lamp = floor_lamp(self.detail.segments, DARK_METAL, LAMPSHADE);
        self.put(
            "floor_lamp",
            &lamp,
            self.frame.inside(w - 0.4, d - 0.4, 0.0),
        );
        let ornament = vase(0.3, self.detail.segments, CLAY);
        self.put("vase", &ornament, self.frame.hung(1.6, d / 2.0 + 0.2, 0.42));
    }

    fn study(&mut self) {
        let (w, d) = (self.frame.width, self.frame.depth);
        let writing = desk(1.6, self.detail.cell, OAK, STEEL, DARK_METAL);
        let at = self.frame.against(Wall::North, w / 2.0, 0.7);
        self.put("desk", &writing, at);
        let cloth = self.cloth();
        let seat = stool(self.detail.segments, DARK_METAL, cloth);
        let at = self.frame.inside(w / 2.0, d - 1.1, 0.0);
        self.put("stool", &seat, at);
        self.bookcase(1.6, 2.1, Wall::West, 1.2);
        self.bookcase(1.2, 1.4, Wall::West, 2.8);
        self.cupboard([1.2, 0.42, 1.1], 2, Wall::East, d - 1.4);
        self.potted_plant(1.2, 0.45, d - 0.4);
    }

    fn kitchen(&mut self) {
        let (w, d) = (self.frame.width, self.frame.depth);
        let sink = counter(w - 1.2, self.detail.cell, PINE, STEEL);
        let at = self.frame.against(Wall::North, w / 2.0 - 0.5, 0.6);
        self.put("counter", &sink, at);
        self.cupboard([0.7, 0.62, 2.0], 1, Wall::North, w - 0.45);
        let (x, y) = (w / 2.0, d / 2.0 - 0.2);
        let dining = table(1.3, 0.9, 0.75, self.detail.cell, OAK);
        self.put("dining_table", &dining, self.frame.inside(x, y, 0.0));
        self.chair(x - 0.32, y - 0.70, 180.0);
        self.chair(x + 0.32, y - 0.70, 180.0);
        self.chair(x - 0.32, y + 0.70, 0.0);
        self.chair(x + 0.32, y + 0.70, 0.0);
        self.cupboard([1.2, 0.42, 1.8], 2, Wall::West, 0.9);
        let bowl = vase(0.25, self.detail.segments, CLAY);
        self.put("vase", &bowl, self.frame.hung(x, y, 0.75));
    }

    fn bathroom(&mut self) {
        let (w, d) = (self.frame.width, self.frame.depth);
        let tub = bath(1.7, self.detail.cell, CEILING_WHITE);
        self.put("bath", &tub, self.frame.against(Wall::North, w / 2.0, 0.75));
        let washstand = counter(1.5, self.detail.cell, PINE, CEILING_WHITE);
        let at = self.frame.against(Wall::West, d / 2.0, 0.6);
        self.put("washstand", &washstand, at);
        self.cupboard([0.9, 0.35, 1.8], 2, Wall::East, d - 1.6);
        let cloth = self.cloth();
        let seat = stool(self.detail.segments, DARK_METAL, cloth);
        let at = self.frame.inside(w / 2.0, d / 2.0, 0.0);
        self.put("stool", &seat, at);
    }

    fn library(&mut self) {
        let (w, d) = (self.frame.width, self.frame.depth);
        self.bookcase(1.6, 2.2, Wall::North, w / 2.0 - 0.85);
        self.bookcase(1.6, 2.2, Wall::North, w / 2.0 + 0.85);
        self.bookcase(1.8, 2.2, Wall::West, 1.4);
        self.bookcase(1.2, 1.2, Wall::East, d - 1.4);
        let reading = round_table(0.6, 0.74, 2 * self.detail.segments, WALNUT);
        let (x, y) = (w / 2.0, d / 2.0);
        self.put("reading_table", &reading, self.frame.inside(x, y, 0.0));
        self.chair(x - 0.95, y, 90.0);
        self.chair(x + 0.95, y, 270.0);
        let lamp = table_lamp(self.detail.segments, DARK_METAL, LAMPSHADE);
        self.put("table_lamp", &lamp, self.frame.hung(x, y, 0.74));
    }
}
