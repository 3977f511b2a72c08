//! Box-shaped rooms of six plates, each with a mesh of its own.

use super::material::Material;
use super::mesh::Mesh;
use super::plate::plate;
use glam::{DVec3, dvec3};

/// The six sides of a room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoomSide {
    /// At the least z, facing up.
    Floor,
    /// At the greatest z, facing down.
    Ceiling,
    /// At the least x.
    West,
    /// At the greatest x.
    East,
    /// At the least y.
    South,
    /// At the greatest y.
    North,
}

impl RoomSide {
    /// All sides.
    pub const ALL: [Self; 6] = [
        Self::Floor,
        Self::Ceiling,
        Self::West,
        Self::East,
        Self::South,
        Self::North,
    ];
}

/// The inside of the box from `min` to `max`; `dress` gives each side's cells along its two axes
/// (x before y before z) and its material. Sides share no vertices, so where their cells differ
/// their edges do not line up.
pub fn box_room(
    min: DVec3,
    max: DVec3,
    dress: impl Fn(RoomSide) -> ([usize; 2], Material),
) -> Mesh {
    let (dx, dy, dz) = (
        dvec3(max.x - min.x, 0.0, 0.0),
        dvec3(0.0, max.y - min.y, 0.0),
        dvec3(0.0, 0.0, max.z - min.z),
    );
    let mut mesh = Mesh::default();
    for side in RoomSide::ALL {
        let ([a, b], material) = dress(side);
        let piece = match side {
            RoomSide::Floor => plate(min, dx, dy, [a, b], material),
            RoomSide::Ceiling => plate(min + dz, dy, dx, [b, a], material),
            RoomSide::West => plate(min, dy, dz, [a, b], material),
            RoomSide::East => plate(min + dx, dz, dy, [b, a], material),
            RoomSide::South => plate(min, dz, dx, [b, a], material),
            RoomSide::North => plate(min + dy, dx, dz, [a, b], material),
        };
        mesh.append(&piece);
    }
    mesh
}
