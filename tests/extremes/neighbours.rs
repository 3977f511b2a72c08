//! Polygons that lie on, in and beside each other.

use crate::agreement::{AGREEMENT, coarse, faces, hold, hold_within, prepare, solve_by};
use crate::mesh::{DARK_ROOM, Facing, LIT_ROOM, Mesh, two_rooms};
use certilux::scene::Side;
use certilux::solve::{Stop, Technique};
use glam::DVec3;

/// Relative difference of the light of faces that a change of meshing leaves as they were.
const MESHING: f64 = 0.01;

/// Light behind a wall without thickness over that in front of it: a ray that leaves a floor at so small an angle that it
/// is within tau of the floor where it meets the wall passes under it.
const LEAK: f64 = 1.0e-4;

/// Share of the emitted power that may be missing.
const IMBALANCE: f64 = 0.01;

fn v(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// A wall of the room's width and 1.3 high, in the plane z = `z`, looking to +z.
fn wall(z: f64, cells: [usize; 2]) -> Mesh {
    Mesh::default().sheet(
        "wall",
        [v(-1.0, -1.0, z), v(2.0, 0.0, 0.0), v(0.0, 1.3, 0.0)],
        cells,
    )
}

/// Walls of several cuts, each within tau of the next (the room's is 3.5e-6), the first beyond it of the last.
fn layers(order: [usize; 5]) -> Mesh {
    order.into_iter().fold(Mesh::default(), |mesh, k| {
        mesh.with(wall(2.5e-6 * k as f64, [k + 1, 3]))
    })
}

fn turned(mesh: Mesh) -> Mesh {
    // Half a turn about the upright axis: what looked to +z looks to -z.
    mesh.mapped(|p| v(-p.x, p.y, -p.z))
}

#[test]
fn polygons_on_and_through_each_other() {
    let cases = [
        ("a wall", wall(0.0, [1, 1])),
        (
            "the same wall twice",
            wall(0.0, [1, 1]).with(wall(0.0, [1, 1])),
        ),
        (
            "coincident, cut otherwise",
            wall(0.0, [1, 1]).with(wall(0.0, [3, 2])),
        ),
        (
            "overlapping in part",
            wall(0.0, [1, 1]).with(wall(0.0, [1, 1]).mapped(|p| v(0.5 * p.x, p.y + 0.2, p.z))),
        ),
        (
            "a rounding error apart",
            wall(0.0, [2, 2]).with(wall(1.0e-7, [3, 3])),
        ),
        ("five layers, the lowest first", layers([0, 1, 2, 3, 4])),
        ("five layers, the highest first", layers([4, 3, 2, 1, 0])),
        ("five layers, shuffled", layers([3, 0, 4, 1, 2])),
        (
            "back to back",
            wall(0.0, [2, 3]).with(turned(wall(0.0, [3, 2]))),
        ),
        (
            "back to back, a rounding error apart",
            wall(1.0e-7, [2, 3]).with(turned(wall(1.0e-7, [3, 2]))),
        ),
        (
            "face to face, a rounding error apart",
            wall(-1.0e-7, [2, 3]).with(turned(wall(-1.0e-7, [3, 2]))),
        ),
        (
            "crossing",
            wall(0.0, [1, 1]).with(wall(0.0, [1, 1]).mapped(|p| v(p.z, p.y, p.x))),
        ),
        ("crossing boxes", {
            let block =
                |min: DVec3, max: DVec3| Mesh::default().cuboid("red", min, max, Facing::Outwards);
            block(v(-0.5, -1.0, -0.5), v(0.2, 0.0, 0.2))
                .with(block(v(-0.2, -0.7, -0.2), v(0.5, 0.3, 0.5)))
        }),
        (
            "a wall through the floor",
            wall(0.0, [2, 2]).mapped(|p| v(p.x, p.y - 0.5, p.z)),
        ),
    ];
    let mut least = u64::MAX;
    for (what, mesh) in cases {
        let prepared = prepare(&Mesh::room().with(mesh));
        // One ray of one exchange that grazes the line in which they cross.
        let agreement = if what == "a wall through the floor" {
            1.0e-4
        } else {
            AGREEMENT
        };
        let claims = hold_within(agreement, what, &prepared, &coarse());
        least = least.min(claims.audited);
        let power = solve_by(&prepared, Technique::Occlusion, &coarse()).power;
        println!("{what}: imbalance {:+.4}", power.imbalance);
        assert!(power.imbalance.abs() < IMBALANCE, "{what}: {power:?}");
    }
    assert!(least > 10, "nothing was claimed");
}

/// Sheets that cross at an angle a are closer than tau, where no answer is promised, over tau / a on each side of the line
/// in which they cross: techniques may differ by the share of the area that this is.
#[test]
fn sheets_that_cross_at_next_to_no_angle() {
    for angle in [1.0e-2, 2.0e-4, 1.0e-5] {
        let crossing = wall(0.0, [1, 1]).mapped(|p| v(p.x, p.y, angle * p.x));
        let prepared = prepare(&Mesh::room().with(wall(0.0, [1, 1])).with(crossing));
        let tau = f64::from(prepared.scene.tau()) / prepared.scene.normalisation.scale;
        let what = format!("crossing at {angle:e}");
        hold_within((2.0 * tau / angle).min(1.0), &what, &prepared, &coarse());
        let power = solve_by(&prepared, Technique::Occlusion, &coarse()).power;
        println!("{what}: imbalance {:+.4}", power.imbalance);
    }
}

/// A wall that meets the floor in T-junctions, or is itself meshed with them, is a wall: faces that did not change
/// receive the same light, and next to none gets through.
#[test]
fn t_junctions_let_next_to_nothing_through() {
    let rooms = |wall: Mesh| {
        // Two rooms under one lamp at z = 0.5; the wall at z = 0 goes up to the ceiling.
        prepare(&two_rooms().with(wall))
    };
    let whole = |cells| {
        Mesh::default().sheet(
            "wall",
            [v(-1.0, -1.0, 0.0), v(2.0, 0.0, 0.0), v(0.0, 2.0, 0.0)],
            cells,
        )
    };
    let bricks = |rows: usize| {
        let mut mesh = Mesh::default();
        for row in 0..rows {
            let height = 2.0 / rows as f64;
            let corner = v(-1.0, -1.0 + height * row as f64, 0.0);
            mesh = mesh.sheet(
                "wall",
                [corner, v(2.0, 0.0, 0.0), v(0.0, height, 0.0)],
                [3 + row % 3, 1],
            );
        }
        mesh
    };
    let mut config = coarse();
    config.stop = Stop::Passes(3);
    let mut first: Option<Vec<f64>> = None;
    for (what, wall) in [
        ("one quadrilateral", whole([1, 1])),
        ("a grid", whole([7, 5])),
        ("bricks", bricks(7)),
    ] {
        let prepared = rooms(wall);
        hold(what, &prepared, &coarse());
        let found = faces(
            &prepared,
            &solve_by(&prepared, Technique::Occlusion, &config),
        );
        let light = |f: u32| {
            found
                .get(&(f, Side::Front))
                .map_or(0.0, |f| f.irradiance[0] / f.area)
        };
        let dark: Vec<f64> = DARK_ROOM.map(light).collect();
        let lit: Vec<f64> = LIT_ROOM.map(light).collect();
        println!("{what}: dark {dark:?} lit {lit:?}");
        for (dark, lit) in dark.iter().zip(&lit) {
            assert!(
                dark / lit <= LEAK,
                "{what} lets light through: {dark} beside {lit}"
            );
        }
        for (a, b) in lit.iter().zip(first.get_or_insert_with(|| lit.clone())) {
            assert!((a / *b - 1.0).abs() < MESHING, "{what}: {a} {b}");
        }
    }
}
