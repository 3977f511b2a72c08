//! A rectangular room as furniture sees it: walls to stand against.

use super::super::blocks::Blocks;
use super::super::cell_grid::BorderFace;
use super::super::material::Material;
use super::super::placement::Placement;

/// Clearance between a wall and what stands against it, in metres.
const CLEARANCE: f64 = 0.02;

/// One of the four walls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wall {
    /// At the greatest y.
    North,
    /// At the least x.
    West,
    /// At the least y.
    South,
    /// At the greatest x.
    East,
}

/// The plan of a room in metres; its floor is at z = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Least x.
    pub west: f64,
    /// Least y.
    pub south: f64,
    /// Greatest x.
    pub east: f64,
    /// Greatest y.
    pub north: f64,
}

impl Room {
    /// A room `width` (x) by `depth` (y) with its south-western corner at `(west, south)`.
    pub fn at(west: f64, south: f64, width: f64, depth: f64) -> Self {
        Self {
            west,
            south,
            east: west + width,
            north: south + depth,
        }
    }

    /// Carves the room out of `space`, `height` high, as air of tag `tag`.
    pub fn carve(&self, space: &mut Blocks, height: f64, tag: u16) {
        space.carve(
            [self.west, self.south, 0.0],
            [self.east, self.north, height],
            tag,
        );
    }

    /// Where a piece of `depth` stands with its back to `wall`; `along` is the distance of its
    /// middle from the wall's western or southern end.
    pub fn against(&self, wall: Wall, along: f64, depth: f64) -> Placement {
        let off = CLEARANCE + depth / 2.0;
        match wall {
            Wall::North => Placement::on_floor(self.west + along, self.north - off, 0.0),
            Wall::West => Placement::on_floor(self.west + off, self.south + along, 90.0),
            Wall::South => Placement::on_floor(self.west + along, self.south + off, 180.0),
            Wall::East => Placement::on_floor(self.east - off, self.south + along, 270.0),
        }
    }

    /// Where a piece stands at `(x, y)` from the south-western corner, turned by `degrees`.
    pub fn inside(&self, x: f64, y: f64, degrees: f64) -> Placement {
        Placement::on_floor(self.west + x, self.south + y, degrees)
    }

    /// Where a piece hangs with its base at height `z`, at `(x, y)` from the south-western corner.
    pub fn hung(&self, x: f64, y: f64, z: f64) -> Placement {
        Placement::new(self.west + x, self.south + y, z, 0.0)
    }

    /// Extent along x in metres.
    pub fn width(&self) -> f64 {
        self.east - self.west
    }

    /// Extent along y in metres.
    pub fn depth(&self) -> f64 {
        self.north - self.south
    }
}

/// The paints of a room.
#[derive(Clone, Copy, Debug)]
pub struct Paint {
    /// What faces up.
    pub floor: Material,
    /// What stands upright.
    pub walls: Material,
    /// What faces down.
    pub ceiling: Material,
}

impl Paint {
    /// The paint of one face of the shell.
    pub fn of(&self, face: &BorderFace) -> Material {
        if face.faces_up() {
            self.floor
        } else if face.faces_down() {
            self.ceiling
        } else {
            self.walls
        }
    }
}
