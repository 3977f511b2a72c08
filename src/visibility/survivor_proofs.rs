//! Proofs by test that the lists handed down are complete, and no longer than they need be.

use super::exact::{PolygonStanding, judge_polygon};
use super::nasty_pairs::Draw;
use super::nasty_scenes::{Triangles, room, sheet, torus, turned};
use super::proof_stage::Stage;
use super::{ElementBounds, SurvivorList, Verdict, WalkLimits};
use crate::math::Aabb;
use glam::{Quat, Vec3};

fn furnished_room() -> Triangles {
    let mut triangles = room(Vec3::new(0.5, 0.4, 0.3), 5, Quat::IDENTITY);
    triangles.extend(room(
        Vec3::new(0.08, 0.1, 0.1),
        2,
        Quat::from_rotation_z(0.5),
    ));
    triangles.extend(sheet(
        Vec3::new(0.25, -0.4, -0.3),
        Vec3::Y * 0.5,
        Vec3::Z * 0.4,
        3,
        3,
    ));
    triangles.extend(
        turned(torus(5), Quat::from_rotation_x(0.8))
            .iter()
            .map(|t| t.map(|p| p * 0.3 + Vec3::new(-0.3, 0.2, 0.0))),
    );
    triangles
}

/// The lists of a chain of ever smaller pairs hold every polygon that blocks the pair at its end,
/// and never cost a claim that the whole scene would have allowed.
#[test]
fn survivors_are_complete_down_a_chain_of_pairs() {
    let stage = Stage::new(furnished_room());
    let mut draw = Draw::new(23);
    let (mut visible, mut blocked, mut shorter) = (0, 0, 0);
    for _ in 0..60 {
        let (mut a_box, mut b_box) = (
            stage.element(&mut draw).aabb(),
            stage.element(&mut draw).aabb(),
        );
        let mut list = SurvivorList::whole_scene(&stage.tree);
        for _ in 0..6 {
            let (a, b) = (
                ElementBounds::from_box(a_box),
                ElementBounds::from_box(b_box),
            );
            let (answer, outgoing) = stage.ask_with(&a, &b, &list);
            let fresh = stage.ask(&a, &b).verdict;
            let (blockers, _) = stage.judge(&a, &b);
            if answer.verdict == Verdict::Visible {
                assert!(blockers.is_empty());
                visible += 1;
                break;
            }
            assert_eq!(fresh, Verdict::Unknown, "the list cost a claim");
            let held = outgoing.polygons(&stage.tree);
            for &i in &blockers {
                assert!(held.iter().any(|p| p.0 == i), "polygon {i} is lost");
            }
            blocked += u32::from(!blockers.is_empty());
            shorter += u32::from(held.len() < stage.triangles.len());
            list = outgoing;
            if draw.below(2) == 0 {
                a_box = quarter(a_box, &mut draw);
            } else {
                b_box = quarter(b_box, &mut draw);
            }
        }
    }
    println!("{visible} visible, {blocked} blocked, {shorter} shorter");
    assert!(visible > 10 && blocked > 100 && shorter > 100);
}

fn quarter(bounds: Aabb, draw: &mut Draw) -> Aabb {
    let middle = bounds.centre();
    let mut part = bounds;
    for axis in 0..3 {
        if draw.below(2) == 0 {
            part.min[axis] = middle[axis];
        } else {
            part.max[axis] = middle[axis];
        }
    }
    part
}

#[test]
fn collecting_walks_leave_exactly_the_polygons_in_the_way() {
    let stage = Stage::new(furnished_room());
    let whole = SurvivorList::whole_scene(&stage.tree);
    let mut draw = Draw::new(31);
    let limits = WalkLimits {
        blocking_leaves: 1_000,
        ..WalkLimits::default()
    };
    let mut blocked = 0;
    for _ in 0..200 {
        let (a, b) = (stage.patch(&mut draw), stage.patch(&mut draw));
        let (answer, list) = stage.walk(&a, &b, &whole, limits);
        let held = list.polygons(&stage.tree);
        assert!(answer.complete);
        let (blockers, _) = stage.judge(&a, &b);
        for &i in &blockers {
            assert!(held.iter().any(|p| p.0 == i));
        }
        for &p in &held {
            let standing =
                judge_polygon(&a, &b, stage.triangles[p.index()], stage.tree.tolerance());
            assert_ne!(standing, PolygonStanding::Harmless);
        }
        blocked += u32::from(!blockers.is_empty());
    }
    assert!(blocked > 40, "{blocked}");
}

#[test]
fn a_walk_cut_short_hands_down_the_rest() {
    let stage = Stage::new(furnished_room());
    let whole = SurvivorList::whole_scene(&stage.tree);
    let mut draw = Draw::new(37);
    for nodes in [0, 1, 2, 5, 20] {
        let (a, b) = (stage.patch(&mut draw), stage.patch(&mut draw));
        let limits = WalkLimits {
            nodes,
            ..WalkLimits::default()
        };
        let (_, list) = stage.walk(&a, &b, &whole, limits);
        let held = list.polygons(&stage.tree);
        for i in stage.judge(&a, &b).0 {
            assert!(held.iter().any(|p| p.0 == i));
        }
    }
}
