//! Welding of vertices, for adjacency only: nothing is moved.
//!
//! Vertices are taken in index order; each joins the first earlier representative within the weld
//! distance or becomes one itself. Representatives are then farther apart than the weld distance,
//! so a grid cell holds a bounded number of them and the whole is linear, however many vertices
//! crowd into one place.

use crate::math::{Aabb, hash_u64};
use glam::Vec3;
use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

/// Cell size in weld distances. At 8 a vertex looks into 1.25^3, about two, cells on average and
/// the representatives of a cell stay few.
const CELL: f64 = 8.0;

/// End of a linked list.
const NONE: u32 = u32::MAX;

/// Passes on a key that is a hash already.
#[derive(Default)]
struct HashedKey(u64);

impl Hasher for HashedKey {
    fn finish(&self) -> u64 {
        self.0
    }
    fn write(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = hash_u64(self.0 ^ u64::from(byte));
        }
    }
    fn write_u64(&mut self, key: u64) {
        self.0 = key;
    }
}

/// The representative (a vertex index, at most its own) of every vertex, for the weld distance
/// `distance` in the units of `positions`.
pub(super) fn weld_vertices(positions: &[Vec3], distance: f64) -> Vec<u32> {
    let origin = Aabb::from_points(positions.iter().copied()).min.as_dvec3();
    let cell = (CELL * distance).max(f64::MIN_POSITIVE);
    let reach = distance.max(f64::MIN_POSITIVE);
    // Only looked up, never walked: its order cannot reach the result. Two cells whose hashes
    // agree share a list, which costs a comparison and changes nothing.
    let mut first: HashMap<u64, u32, BuildHasherDefault<HashedKey>> = HashMap::default();
    let mut next = vec![NONE; positions.len()];
    let mut representative = Vec::with_capacity(positions.len());
    for (index, position) in positions.iter().enumerate() {
        let local = position.as_dvec3() - origin;
        let low = ((local - reach) / cell).floor().as_i64vec3();
        let high = ((local + reach) / cell).floor().as_i64vec3();
        let mut best = NONE;
        for x in low.x..=high.x {
            for y in low.y..=high.y {
                for z in low.z..=high.z {
                    let mut candidate = first.get(&cell_key(x, y, z)).copied().unwrap_or(NONE);
                    while candidate != NONE {
                        let other = positions[candidate as usize].as_dvec3() - origin;
                        if other.distance_squared(local) <= reach * reach {
                            best = best.min(candidate);
                        }
                        candidate = next[candidate as usize];
                    }
                }
            }
        }
        if best == NONE {
            best = index as u32;
            let home = (local / cell).floor().as_i64vec3();
            let head = first
                .entry(cell_key(home.x, home.y, home.z))
                .or_insert(NONE);
            next[index] = *head;
            *head = best;
        }
        representative.push(best);
    }
    representative
}

fn cell_key(x: i64, y: i64, z: i64) -> u64 {
    // Cells number at most 1 / (CELL * 1e-6) an axis: 21 bits each are enough to tell them apart.
    hash_u64(
        ((x as u64 & 0x1f_ffff) << 42) | ((y as u64 & 0x1f_ffff) << 21) | (z as u64 & 0x1f_ffff),
    )
}
