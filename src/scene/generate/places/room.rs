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

    /// The room as seen from its wall `front`.
    pub fn seen_from(&self, front: Wall) -> Frame {
        let (width, depth) = (self.width(), self.depth());
        let (x, y, degrees, width, depth) = match front {
            Wall::South => (self.west, self.south, 0.0, width, depth),
            Wall::East => (self.east, self.south, 90.0, depth, width),
            Wall::North => (self.east, self.north, 180.0, width, depth),
            Wall::West => (self.west, self.north, 270.0, depth, width),
        };
        Frame {
            corner: Placement::on_floor(x, y, degrees),
            width,
            depth,
        }
    }

    /// [`Frame::against`] in the room as seen from the south.
    pub fn against(&self, wall: Wall, along: f64, depth: f64) -> Placement {
        self.seen_from(Wall::South).against(wall, along, depth)
    }

    /// [`Frame::inside`] in the room as seen from the south.
    pub fn inside(&self, x: f64, y: f64, degrees: f64) -> Placement {
        self.seen_from(Wall::South).inside(x, y, degrees)
    }

    /// [`Frame::hung`] in the room as seen from the south.
    pub fn hung(&self, x: f64, y: f64, z: f64) -> Placement {
        self.seen_from(Wall::South).hung(x, y, z)
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

/// A room seen from one of its walls: that wall is the frame's south, x runs to the right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    corner: Placement,
    /// Extent along the front wall in metres.
    pub width: f64,
    /// Extent away from the front wall in metres.
    pub depth: f64,
}

impl Frame {
    /// Where a piece of `depth` stands with its back to `wall`; `along` is the distance of its
    /// middle from the wall's western or southern end.
    pub fn against(&self, wall: Wall, along: f64, depth: f64) -> Placement {
        let off = CLEARANCE + depth / 2.0;
        match wall {
            Wall::North => self.inside(along, self.depth - off, 0.0),
            Wall::West => self.inside(off, along, 90.0),
            Wall::South => self.inside(along, off, 180.0),
            Wall::East => self.inside(self.width - off, along, 270.0),
        }
    }

    /// Where a piece stands at `(x, y)` from the frame's corner, turned by `degrees`.
    pub fn inside(&self, x: f64, y: f64, degrees: f64) -> Placement {
        self.corner.then(Placement::on_floor(x, y, degrees))
    }

    /// Where a piece stands or hangs with its base at height `z`, at `(x, y)` from the corner.
    pub fn hung(&self, x: f64, y: f64, z: f64) -> Placement {
        self.corner.then(Placement::new(x, y, z, 0.0))
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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    #[test]
    fn furniture_stands_inside_the_room_with_its_back_to_the_wall_from_every_side() {
        let room = Room::at(3.0, -2.0, 4.0, 6.0);
        for front in [Wall::South, Wall::East, Wall::North, Wall::West] {
            let frame = room.seen_from(front);
            for wall in [Wall::South, Wall::East, Wall::North, Wall::West] {
                let placed = frame.against(wall, 1.0, 0.6);
                let middle = placed.apply(dvec3(0.0, 0.0, 0.0));
                let back = placed.apply(dvec3(0.0, 0.3, 0.0));
                let gap = |p: glam::DVec3| {
                    (p.x - room.west)
                        .min(room.east - p.x)
                        .min(p.y - room.south)
                        .min(room.north - p.y)
                };
                assert!((gap(back) - CLEARANCE).abs() < 1e-12);
                assert!((gap(middle) - CLEARANCE - 0.3).abs() < 1e-12);
            }
        }
    }
}
