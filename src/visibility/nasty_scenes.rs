//! Small scenes for the proofs of full visibility.

use glam::{Quat, Vec3};
use std::f32::consts::{PI, TAU};

pub(super) type Triangles = Vec<[Vec3; 3]>;

/// A grid of `columns x rows` quadrilaterals over the unit square, mapped by `shape`.
pub(super) fn grid(columns: u32, rows: u32, shape: impl Fn(f32, f32) -> Vec3) -> Triangles {
    let at = |i: u32, j: u32| shape(i as f32 / columns as f32, j as f32 / rows as f32);
    let mut triangles = Vec::new();
    for i in 0..columns {
        for j in 0..rows {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles.retain(|[a, b, c]| (*b - *a).cross(*c - *a).length() > 1.0e-9);
    triangles
}

/// A parallelogram.
pub(super) fn sheet(corner: Vec3, u: Vec3, v: Vec3, columns: u32, rows: u32) -> Triangles {
    grid(columns, rows, |s, t| corner + u * s + v * t)
}

/// The inside of a box with these half-extents, each wall of `n x n` quadrilaterals, turned.
pub(super) fn room(half: Vec3, n: u32, turn: Quat) -> Triangles {
    let (x, y, z) = (Vec3::X * half.x, Vec3::Y * half.y, Vec3::Z * half.z);
    let mut triangles = Vec::new();
    for (a, b, c) in [(x, y, z), (y, z, x), (z, x, y)] {
        triangles.extend(sheet(-a - b - c, a * 2.0, b * 2.0, n, n));
        triangles.extend(sheet(-a - b + c, b * 2.0, a * 2.0, n, n));
    }
    turned(triangles, turn)
}

pub(super) fn turned(triangles: Triangles, turn: Quat) -> Triangles {
    triangles.into_iter().map(|t| t.map(|p| turn * p)).collect()
}

pub(super) fn sphere(n: u32) -> Triangles {
    grid(2 * n, n, |s, t| {
        let (phi, theta) = (s * TAU, t * PI);
        0.4 * Vec3::new(
            phi.cos() * theta.sin(),
            phi.sin() * theta.sin(),
            theta.cos(),
        )
    })
}

/// The lower half of a sphere, seen from above.
pub(super) fn bowl(n: u32) -> Triangles {
    grid(4 * n, n, |s, t| {
        let (phi, theta) = (s * TAU, PI - t * 0.5 * PI);
        0.4 * Vec3::new(
            phi.cos() * theta.sin(),
            phi.sin() * theta.sin(),
            theta.cos(),
        )
    })
}

pub(super) fn torus(n: u32) -> Triangles {
    grid(2 * n, n, |s, t| {
        let (phi, theta) = (s * TAU, t * TAU);
        let radius = 0.3 + 0.12 * theta.cos();
        Vec3::new(radius * phi.cos(), radius * phi.sin(), 0.12 * theta.sin())
    })
}

/// Treads and risers of two turns around a pole.
pub(super) fn spiral_stair(steps: u32) -> Triangles {
    let mut triangles = Vec::new();
    let (turns, rise) = (2.0, 0.9);
    for i in 0..steps {
        let angle = |k: u32| TAU * turns * k as f32 / steps as f32;
        let height = |k: u32| rise * k as f32 / steps as f32 - 0.45;
        let spoke = |k: u32, z: f32, r: f32| Vec3::new(r * angle(k).cos(), r * angle(k).sin(), z);
        let (z, next) = (height(i), height(i + 1));
        let [a, b, c, d] = [
            spoke(i, z, 0.05),
            spoke(i, z, 0.4),
            spoke(i + 1, z, 0.4),
            spoke(i + 1, z, 0.05),
        ];
        triangles.extend([[a, b, c], [a, c, d]]);
        let [e, f] = [spoke(i + 1, next, 0.4), spoke(i + 1, next, 0.05)];
        triangles.extend([[d, c, e], [d, e, f]]);
    }
    triangles
}
