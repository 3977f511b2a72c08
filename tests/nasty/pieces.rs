//! Walls and things that are hard on guarantees, in the room of side 1 around the origin.

use certilux::math::hash_u64;
use glam::{DQuat, DVec2, DVec3, EulerRot};
use std::f64::consts::{PI, TAU};

pub type Triangle = [DVec3; 3];

/// A stream of numbers that depends on its seed alone.
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(hash_u64(seed ^ 0x6e_6173_7479))
    }

    pub fn unit(&mut self) -> f64 {
        self.0 = hash_u64(self.0);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub fn below(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count - 1)
    }

    /// Ten to a power between the two.
    fn decades(&mut self, low: f64, high: f64) -> f64 {
        10.0f64.powf(self.between(low, high))
    }
}

/// A surface over the unit square, in quadrilaterals cut either way.
fn grid(columns: usize, rows: usize, at: impl Fn(f64, f64) -> DVec3) -> Vec<Triangle> {
    let point = |i: usize, j: usize| at(i as f64 / columns as f64, j as f64 / rows as f64);
    let mut triangles = Vec::new();
    for i in 0..columns {
        for j in 0..rows {
            let [a, b, c, d] = [
                point(i, j),
                point(i + 1, j),
                point(i + 1, j + 1),
                point(i, j + 1),
            ];
            if (i + j) % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    triangles
}

fn flipped(triangles: &[Triangle]) -> Vec<Triangle> {
    triangles.iter().map(|&[a, b, c]| [a, c, b]).collect()
}

/// A sheet along z, 0.9 or the whole room high, through a profile in the plane of x and y.
fn swept(profile: &[DVec2], low: f64, high: f64) -> Vec<Triangle> {
    profile
        .windows(2)
        .flat_map(|w| {
            let [a, b, c, d] = [
                w[0].extend(low),
                w[1].extend(low),
                w[1].extend(high),
                w[0].extend(high),
            ];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

/// A wall across the room near the plane x = 0, spoiled in one way or another, then put somewhere.
pub fn wall(dice: &mut Dice) -> Vec<Triangle> {
    let p = DVec2::new;
    // On the floor exactly, or a hair above it or below.
    let low = match dice.below(3) {
        0 => -0.5,
        1 => -0.5 + dice.decades(-8.0, -2.0),
        _ => -0.5 - dice.decades(-8.0, -5.0),
    };
    let high = if dice.below(2) == 0 { 0.5 } else { 0.3 };
    let door = [dice.between(-0.3, 0.0), dice.between(0.05, 0.3)];
    let step = dice.decades(-8.0, -1.5);
    let overlap = [0.0, dice.decades(-8.0, -2.0), -dice.decades(-8.0, -2.0)][dice.below(3)];
    let sheet = |y: [f64; 2], z: [f64; 2], x: f64, n: usize, m: usize| {
        grid(n, m, |s, t| {
            DVec3::new(x, y[0] + (y[1] - y[0]) * s, z[0] + (z[1] - z[0]) * t)
        })
    };
    let (n, m) = (1 + dice.below(7), 1 + dice.below(7));
    let whole = sheet([-0.5, 0.5], [low, high], 0.0, n, m);
    let triangles = match dice.below(10) {
        0 => whole,
        // With a doorway; the lintel abuts the jambs at T-junctions.
        1 => [
            sheet([-0.5, door[0]], [low, high], 0.0, n, m),
            sheet([door[1], 0.5], [low, high], 0.0, m, n),
            sheet(door, [0.1, high], 0.0, 1, 2),
        ]
        .concat(),
        // Every triangle moved by itself.
        2 => {
            let tear = dice.decades(-9.0, -4.5);
            let lift = [0.0, tear, 30.0 * tear][dice.below(3)];
            whole
                .iter()
                .map(|t| {
                    t.map(|v| {
                        let mut by = |most: f64| dice.between(-most, most);
                        v + DVec3::new(by(lift), by(tear), by(tear))
                    })
                })
                .collect()
        }
        // Two sheets that abut, overlap or leave a crack, at two heights.
        3 => [
            sheet([-0.5, 0.0], [low, high], 0.0, n, m),
            sheet([-overlap, 0.5], [low, high], step, m, n),
        ]
        .concat(),
        4 => [
            sheet([-0.5, 0.0], [low, high], 0.0, n, m),
            sheet([-overlap, 0.5], [low, high], 0.0, m, n),
        ]
        .concat(),
        // Folded hems, interlocked or apart.
        5 => {
            let reach = dice.between(-0.02, 0.03);
            [
                swept(
                    &[p(0.0, -0.5), p(0.0, reach), p(0.3 * step, reach - 0.02)],
                    low,
                    high,
                ),
                swept(
                    &[p(0.7 * step, 0.02), p(step, 0.0), p(step, 0.5)],
                    low,
                    high,
                ),
            ]
            .concat()
        }
        // One sheet folded in a Z.
        6 => swept(
            &[p(0.0, -0.5), p(0.0, 0.02), p(step, -0.02), p(step, 0.5)],
            low,
            high,
        ),
        // Doubled and back to back.
        7 => [whole.clone(), flipped(&whole)].concat(),
        // Bumpy, with a hole or two.
        8 => {
            let bump = dice.decades(-8.0, -2.0);
            let mut bumpy = grid(9, 9, |s, t| {
                let x = bump * (17.0 * s).sin() * (13.0 * t + 1.0).cos();
                DVec3::new(x, s - 0.5, low + (high - low) * t)
            });
            for _ in 0..dice.below(3) {
                bumpy.swap_remove(dice.below(bumpy.len()));
            }
            bumpy
        }
        // Strips that end as slivers of aspect 1e6.
        _ => grid(1, 40, |s, t| {
            let y = -0.5 + t * (1.0e-6 + s);
            DVec3::new(0.0, y, low + (high - low) * s)
        }),
    };
    place_upright(triangles, dice)
}

/// Somewhere in the room, turned by nothing, a right angle, or anything.
fn place_upright(triangles: Vec<Triangle>, dice: &mut Dice) -> Vec<Triangle> {
    let (turn, squeeze) = match dice.below(3) {
        0 => (0.0, 1.0),
        1 => (0.5 * PI, 1.0),
        // Turned walls have to fit between the others.
        _ => (dice.between(0.0, TAU), 0.6),
    };
    let turn = DQuat::from_rotation_z(turn);
    let shift = turn * DVec3::X * dice.between(-0.3, 0.3);
    triangles
        .iter()
        .map(|t| t.map(|v| turn * (v * DVec3::new(1.0, squeeze, 1.0)) + shift))
        .collect()
}

/// A thing to stand, hang or lie in the room.
pub fn piece(dice: &mut Dice) -> Vec<Triangle> {
    let sphere = |theta: [f64; 2], radius: f64| {
        grid(12, 6, move |s, t| {
            let (phi, theta) = (s * TAU, theta[0] + (theta[1] - theta[0]) * t);
            radius
                * DVec3::new(
                    phi.cos() * theta.sin(),
                    phi.sin() * theta.sin(),
                    theta.cos(),
                )
        })
    };
    let triangles = match dice.below(8) {
        0 => sphere([1.0e-3, PI - 1.0e-3], 0.12),
        // A bowl.
        1 => sphere([0.5 * PI, PI - 1.0e-3], 0.2),
        // A torus.
        2 => grid(14, 8, |s, t| {
            let (phi, theta) = (s * TAU, t * TAU);
            let radius = 0.15 + 0.05 * theta.cos();
            DVec3::new(radius * phi.cos(), radius * phi.sin(), 0.05 * theta.sin())
        }),
        // A spiral stair.
        3 => (0..16)
            .flat_map(|k| {
                let spoke = |k: i32, z: i32, r: f64| {
                    let angle = TAU * f64::from(k) / 12.0;
                    DVec3::new(r * angle.cos(), r * angle.sin(), 0.04 * f64::from(z) - 0.3)
                };
                let [a, b, c, d] = [
                    spoke(k, k, 0.02),
                    spoke(k, k, 0.18),
                    spoke(k + 1, k, 0.18),
                    spoke(k + 1, k, 0.02),
                ];
                let [e, f] = [spoke(k + 1, k + 1, 0.18), spoke(k + 1, k + 1, 0.02)];
                [[a, b, c], [a, c, d], [d, c, e], [d, e, f]]
            })
            .collect(),
        // Laths, down to hairs.
        4 => {
            let width = dice.decades(-6.0, -2.0);
            (0..12)
                .flat_map(|i| {
                    let x = 0.03 * f64::from(i) - 0.18;
                    grid(1, 1, move |s, t| {
                        DVec3::new(x + width * s, 0.0, 0.6 * t - 0.3)
                    })
                })
                .collect()
        }
        // A crate that touches what it stands against.
        5 => {
            let half = DVec3::new(0.1, 0.1, 0.1);
            let mut crate_ = Vec::new();
            for axis in 0..3 {
                for side in [-1.0, 1.0] {
                    let face = grid(1 + dice.below(3), 1 + dice.below(3), |s, t| {
                        let mut p = DVec3::splat(side);
                        p[(axis + 1) % 3] = 2.0 * s - 1.0;
                        p[(axis + 2) % 3] = 2.0 * t - 1.0;
                        p * half
                    });
                    crate_.extend(if side > 0.0 { face } else { flipped(&face) });
                }
            }
            let z = DVec3::new(dice.between(-0.4, 0.4), 0.4, -0.4);
            return crate_.iter().map(|t| t.map(|p| p + z)).collect();
        }
        // Two panels that meet at an edge.
        6 => [
            grid(3, 2, |s, t| DVec3::new(0.0, 0.3 * s, 0.5 * t - 0.25)),
            grid(2, 3, |s, t| DVec3::new(0.3 * s, 0.0, 0.5 * t - 0.25)),
        ]
        .concat(),
        // Loose triangles, some of them almost without area.
        _ => (0..25)
            .map(|_| {
                let mut point = |size: f64| {
                    size * DVec3::new(
                        dice.between(-1.0, 1.0),
                        dice.between(-1.0, 1.0),
                        dice.between(-1.0, 1.0),
                    )
                };
                let (centre, a, b) = (point(0.2), point(0.1), point(0.1));
                let thin = dice.decades(-7.0, 0.0);
                [centre, centre + a, centre + a * 0.5 + b * thin]
            })
            .collect(),
    };
    let turn = match dice.below(3) {
        0 => DQuat::IDENTITY,
        _ => DQuat::from_euler(
            EulerRot::XYZ,
            dice.between(0.0, TAU),
            dice.between(0.0, TAU),
            dice.between(0.0, TAU),
        ),
    };
    let shift = DVec3::new(
        dice.between(-0.25, 0.25),
        dice.between(-0.25, 0.25),
        dice.between(-0.2, 0.2),
    );
    triangles
        .iter()
        .map(|t| t.map(|p| turn * p + shift))
        .collect()
}
