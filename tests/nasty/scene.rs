//! A room with a few nasty things in it, as OBJ text.

use crate::pieces::{Dice, Triangle, piece, wall};
use glam::DVec3;
use std::fmt::Write;

/// The materials that scenes name.
pub const MTL: &str = "newmtl lamp\nKd 0.5 0.5 0.5\nKe 1 1 1\nnewmtl wall\nKd 0.5 0.5 0.5\n";

/// The scene of a seed.
pub fn nasty_scene(seed: u64) -> String {
    let mut dice = Dice::new(seed);
    let mut triangles: Vec<(bool, Triangle)> = room(&mut dice);
    for _ in 0..2 + dice.below(3) {
        triangles.extend(wall(&mut dice).into_iter().map(|t| (false, t)));
    }
    for _ in 0..1 + dice.below(4) {
        triangles.extend(piece(&mut dice).into_iter().map(|t| (false, t)));
    }
    // Sizes of 1e-4 and 1e6, and a room 1e6 of its sizes away.
    let (size, offset) = match dice.below(6) {
        0 => (1.0e-4, DVec3::ZERO),
        1 => (1.0e6, DVec3::ZERO),
        2 => (1.0, DVec3::new(1.0e6, -1.0e6, 3.0e5)),
        _ => (1.0, DVec3::ZERO),
    };
    let mut obj = "mtllib m.mtl\n".to_owned();
    for (lamp, triangle) in triangles {
        let _ = writeln!(obj, "usemtl {}", if lamp { "lamp" } else { "wall" });
        for p in triangle.map(|p| p * size + offset) {
            let _ = writeln!(obj, "v {:?} {:?} {:?}", p.x, p.y, p.z);
        }
        obj += "f -3 -2 -1\n";
    }
    obj
}

/// The inside of the unit box, each wall meshed in its own way; true for the ceiling, which emits.
fn room(dice: &mut Dice) -> Vec<(bool, Triangle)> {
    let mut triangles = Vec::new();
    for axis in 0..3 {
        for side in [-0.5, 0.5] {
            let (columns, rows) = (1 + dice.below(4), 1 + dice.below(4));
            let at = |i: usize, j: usize| {
                let mut p = DVec3::splat(side);
                p[(axis + 1) % 3] = i as f64 / columns as f64 - 0.5;
                p[(axis + 2) % 3] = j as f64 / rows as f64 - 0.5;
                p
            };
            for i in 0..columns {
                for j in 0..rows {
                    let mut quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                    if side > 0.0 {
                        quad.reverse();
                    }
                    let [a, b, c, d] = quad;
                    let lamp = axis == 2 && side > 0.0;
                    triangles.extend([(lamp, [a, b, c]), (lamp, [a, c, d])]);
                }
            }
        }
    }
    triangles
}
