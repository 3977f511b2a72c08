//! Proofs by test that full visibility is never claimed falsely and is claimed where it is plain.

use super::nasty_pairs::Draw;
use super::nasty_scenes::{Triangles, bowl, grid, room, sheet, sphere, spiral_stair, torus};
use super::proof_stage::Stage;
use super::{
    ElementBounds, Faults, SurvivorList, Verdict, VisibilityQuery, VisibilityScratch, WalkLimits,
};
use crate::math::Aabb;
use glam::{Quat, Vec3};

#[derive(Debug, Default)]
struct Tally {
    visible: u32,
    provable: u32,
    blocked: u32,
}

/// Asks for random pairs and lets exact arithmetic judge every claim.
fn tally(stage: &Stage, pairs: u32, seed: u64, patches_only: bool) -> Tally {
    let mut tally = Tally::default();
    let mut draw = Draw::new(seed);
    for pair in 0..pairs {
        let (a, b) = if patches_only {
            (stage.patch(&mut draw), stage.patch(&mut draw))
        } else {
            (stage.element(&mut draw), stage.element(&mut draw))
        };
        let visible = stage.ask(&a, &b).verdict == Verdict::Visible;
        let (blockers, proved) = stage.judge(&a, &b);
        assert!(
            !visible || blockers.is_empty(),
            "pair {pair} of seed {seed} is called visible, but {blockers:?} block it"
        );
        tally.visible += u32::from(visible);
        tally.provable += u32::from(blockers.is_empty() && proved);
        tally.blocked += u32::from(!blockers.is_empty());
    }
    println!("{tally:?} of {pairs}");
    tally
}

#[test]
fn loose_triangles_never_hide_in_a_claim() {
    let mut claims = 0;
    for seed in 0..8 {
        let mut draw = Draw::new(seed);
        let triangles = (0..40)
            .map(|_| {
                let (centre, size) = (draw.point(), draw.scale(1.0e-3, 0.3));
                [0; 3].map(|_| centre + draw.point() * size)
            })
            .collect();
        let stage = Stage::new(triangles);
        let tally = tally(&stage, 150, seed, false);
        assert!(tally.blocked > 10, "{tally:?}");
        // Everything that exact arithmetic can prove, but for contacts within the margins.
        assert!(tally.visible * 20 >= tally.provable * 17, "{tally:?}");
        claims += tally.visible;
    }
    assert!(claims > 200, "{claims} claims");
}

#[test]
fn curved_surfaces_shadow_themselves() {
    for (name, triangles, least) in [
        ("bowl", bowl(5), 20),
        ("sphere from inside", sphere(5), 20),
        ("torus", torus(7), 10),
        ("spiral stair", spiral_stair(24), 10),
    ] {
        let stage = Stage::new(triangles);
        let tally = tally(&stage, 150, 7, false);
        assert!(tally.visible >= least, "{name}: {tally:?}");
        assert!(
            name == "sphere from inside" || tally.blocked > 0,
            "{name}: {tally:?}"
        );
    }
}

#[test]
fn a_curved_cluster_is_not_seen_fully_though_nothing_stands_in_between() {
    // The box of half a bowl against a ceiling: parts of the bowl hide from parts of the ceiling.
    let mut triangles = bowl(6);
    let bowl_bounds = Aabb::from_points(triangles.iter().flatten().copied());
    triangles.extend(sheet(
        Vec3::new(-0.4, -0.4, 0.4),
        Vec3::X * 0.8,
        Vec3::Y * 0.8,
        2,
        2,
    ));
    let stage = Stage::new(triangles);
    let ceiling = ElementBounds::from_polygon(&stage.triangles[stage.triangles.len() - 1]);
    let answer = stage.ask(&ElementBounds::from_box(bowl_bounds), &ceiling);
    assert_eq!(answer.verdict, Verdict::Unknown);
}

/// A convex room hides nothing from itself: every pair of patches has to be claimed, though all of
/// them touch their neighbours, at any orientation and proportion.
#[test]
fn every_pair_of_an_empty_room_is_claimed() {
    for (half, turn) in [
        (Vec3::splat(0.5), Quat::IDENTITY),
        (Vec3::new(0.5, 0.3, 0.2), Quat::IDENTITY),
        (Vec3::new(0.5, 0.05, 0.04), Quat::IDENTITY),
        (Vec3::new(0.4, 0.3, 0.2), Quat::from_rotation_z(0.4)),
        (
            Vec3::new(0.4, 0.3, 0.2),
            Quat::from_euler(glam::EulerRot::XYZ, 0.3, 0.7, 1.1),
        ),
    ] {
        let stage = Stage::new(room(half, 4, turn));
        let mut draw = Draw::new(11);
        let (mut asked, mut claimed) = (0, 0);
        for _ in 0..4_000 {
            let (a, b) = (stage.patch(&mut draw), stage.patch(&mut draw));
            // Two patches of one wall see nothing of each other.
            asked += 1;
            claimed += u32::from(stage.ask(&a, &b).verdict == Verdict::Visible);
        }
        println!("{half} {turn}: {claimed} of {asked}");
        assert!(
            claimed * 100 >= asked * 99,
            "{half} {turn}: {claimed} of {asked}"
        );
    }
}

fn wall_with_doorway(half_width: f32) -> Triangles {
    let mut triangles = Vec::new();
    let wall = |x0: f32, x1: f32, z0: f32, z1: f32| {
        sheet(
            Vec3::new(x0, 0.0, z0),
            Vec3::X * (x1 - x0),
            Vec3::Z * (z1 - z0),
            1,
            1,
        )
    };
    triangles.extend(wall(-0.5, -half_width, -0.5, 0.5));
    triangles.extend(wall(half_width, 0.5, -0.5, 0.5));
    triangles.extend(wall(-half_width, half_width, 0.2, 0.5));
    triangles
}

#[test]
fn a_doorway_as_wide_as_the_shaft() {
    let side = |y: f32| {
        ElementBounds::from_polygon(&[
            Vec3::new(-0.1, y, -0.1),
            Vec3::new(0.1, y, -0.1),
            Vec3::new(0.1, y, 0.1),
            Vec3::new(-0.1, y, 0.1),
        ])
    };
    for (half_width, expected) in [
        (0.2, Verdict::Visible),
        (0.100_003, Verdict::Visible),
        (0.1, Verdict::Visible),
        (0.099_99, Verdict::Unknown),
        (0.05, Verdict::Unknown),
    ] {
        let stage = Stage::new(wall_with_doorway(half_width));
        let (a, b) = (side(-0.3), side(0.4));
        assert_eq!(stage.ask(&a, &b).verdict, expected, "{half_width}");
        assert_eq!(
            stage.judge(&a, &b).0.is_empty(),
            expected == Verdict::Visible
        );
    }
}

#[test]
fn cracked_doubled_and_back_to_back_walls_still_block() {
    let left = |x: f32| {
        sheet(
            Vec3::new(-0.5, 0.0, -0.5),
            Vec3::X * (0.5 + x),
            Vec3::Z,
            1,
            1,
        )
    };
    let right = |x: f32| sheet(Vec3::new(x, 0.0, -0.5), Vec3::X * (0.5 - x), Vec3::Z, 1, 1);
    let flipped = |t: Triangles| {
        t.into_iter()
            .map(|[a, b, c]| [a, c, b])
            .collect::<Triangles>()
    };
    let both = |a: Triangles, b: Triangles| a.into_iter().chain(b).collect::<Triangles>();
    let slivers = grid(1, 200, |s, t| {
        // Strips far narrower than the weld distance at the left end.
        Vec3::new(-0.5 + s, 0.0, -0.5 + t * (1.0e-6 + s))
    });
    for (name, wall) in [
        ("whole", both(left(0.0), right(0.0))),
        ("cracked", both(left(-4.0e-7), right(4.0e-7))),
        ("overlapping", both(left(0.1), right(-0.1))),
        ("doubled", both(left(0.5), left(0.5))),
        ("back to back", both(left(0.5), flipped(left(0.5)))),
        ("strips", slivers),
    ] {
        let mut triangles = wall;
        triangles.extend(sheet(Vec3::new(-0.5, -0.5, -0.5), Vec3::X, Vec3::Z, 1, 1));
        let stage = Stage::new(triangles);
        let at = |y: f32| {
            ElementBounds::from_box(Aabb {
                min: Vec3::new(-0.1, y, -0.4),
                max: Vec3::new(0.1, y, -0.2),
            })
        };
        assert_eq!(
            stage.ask(&at(-0.3), &at(0.3)).verdict,
            Verdict::Unknown,
            "{name}"
        );
        assert_eq!(
            stage.ask(&at(-0.4), &at(-0.1)).verdict,
            Verdict::Visible,
            "{name}"
        );
    }
}

#[test]
fn planted_faults_lead_to_claims_that_exact_arithmetic_refutes() {
    let mut triangles = room(Vec3::splat(0.5), 3, Quat::IDENTITY);
    let first_sliver = triangles.len();
    // A blind of thin slats across the middle.
    for i in 0..60 {
        let x = -0.45 + 0.015 * i as f32;
        triangles.push([
            Vec3::new(x, 0.0, -0.4),
            Vec3::new(x + 0.004, 0.0, -0.4),
            Vec3::new(x, 0.0, 0.4),
        ]);
    }
    let stage = Stage::new(triangles);
    let (a, b) = (
        ElementBounds::from_box(Aabb::from_points([
            Vec3::new(-0.2, -0.5, -0.2),
            Vec3::new(0.2, -0.5, 0.2),
        ])),
        ElementBounds::from_box(Aabb::from_points([
            Vec3::new(-0.2, 0.5, -0.2),
            Vec3::new(0.2, 0.5, 0.2),
        ])),
    );
    let run = |faults: Faults, incoming: &SurvivorList| {
        let mut outgoing = SurvivorList::new();
        let answer = VisibilityQuery::new(&stage.tree).with_faults(faults).run(
            &a,
            &b,
            incoming,
            &mut outgoing,
            WalkLimits::default(),
            &mut VisibilityScratch::default(),
        );
        (answer.verdict, outgoing)
    };
    let whole = SurvivorList::whole_scene(&stage.tree);
    assert_eq!(run(Faults::NONE, &whole).0, Verdict::Unknown);
    let forgetful = Faults {
        slivers_forgotten: true,
        ..Faults::NONE
    };
    assert_eq!(run(forgetful, &whole).0, Verdict::Visible);
    let cutting = Faults {
        survivors_cut: true,
        ..Faults::NONE
    };
    let kept = run(cutting, &whole).1.polygons(&stage.tree).len();
    let blockers = stage.judge(&a, &b).0;
    assert!(blockers.iter().all(|&i| i as usize >= first_sliver));
    assert!(kept < blockers.len(), "{kept} of {} kept", blockers.len());
}

#[test]
fn triangles_alone_see_each_other() {
    let stage = Stage::new(vec![
        [Vec3::ZERO, Vec3::X * 0.3, Vec3::Y * 0.3],
        [
            Vec3::Z * 0.5,
            Vec3::new(0.3, 0.0, 0.5),
            Vec3::new(0.0, 0.3, 0.5),
        ],
    ]);
    assert_eq!(
        stage.ask(&stage.triangle(0), &stage.triangle(1)).verdict,
        Verdict::Visible
    );
    assert_eq!(
        stage.ask(&stage.triangle(0), &stage.triangle(0)).verdict,
        Verdict::Visible
    );
}
