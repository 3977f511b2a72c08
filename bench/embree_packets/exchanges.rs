//! The rays of exchanges between the patches of a scene.

use crate::numbers::Numbers;
use crate::rooms::Rooms;
use certilux::embree::Ray;

/// Rays an exchange, the engine's default.
pub const RAYS: usize = 8;

/// How the eight rays of an exchange belong together.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Between two patches, half of the pairs in one room and half anywhere: what a solve casts.
    Coherent,
    /// Eight rays between eight pairs of their own.
    Incoherent,
}

impl Kind {
    pub const ALL: [Self; 2] = [Self::Coherent, Self::Incoherent];

    pub fn name(self) -> &'static str {
        match self {
            Self::Coherent => "coherent",
            Self::Incoherent => "incoherent",
        }
    }
}

/// `count` exchanges of [`RAYS`] rays each, one after another.
pub fn exchanges(rooms: &Rooms, kind: Kind, count: usize) -> Vec<Ray> {
    let mut numbers = Numbers::new(17);
    let mut rays = Vec::with_capacity(count * RAYS);
    for exchange in 0..count {
        let mut pair = pick(rooms, exchange, &mut numbers);
        for _ in 0..RAYS {
            if kind == Kind::Incoherent {
                pair = pick(rooms, exchange, &mut numbers);
            }
            let from = rooms.point(pair.0, &mut numbers);
            let to = rooms.point(pair.1, &mut numbers);
            // Trimmed by a hundred-thousandth at each end, to leave one surface and reach the other.
            rays.push(Ray {
                tnear: 1e-5,
                tfar: 1.0 - 1e-5,
                ..Ray::segment(from, to)
            });
        }
    }
    rays
}

fn pick(rooms: &Rooms, exchange: usize, numbers: &mut Numbers) -> (u32, u32) {
    let room = &rooms.by_room[numbers.below(rooms.by_room.len())];
    let receiver = room[numbers.below(room.len())];
    let source = if exchange.is_multiple_of(2) {
        room[numbers.below(room.len())]
    } else {
        numbers.below(rooms.triangles.len()) as u32
    };
    (receiver, source)
}
