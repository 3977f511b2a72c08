//! Solids: a face counts as covered just where surface is.

use super::builders::{Random, Triangle, WELD, extract};
use crate::occluder::{OccluderSet, Solid};
use crate::scene::Scene;
use glam::{DMat3, DVec3, Vec3};

/// The faces of a box around `centre`, turned, as fans of two triangles; `left_out` are not there.
fn box_faces(centre: DVec3, half: DVec3, turn: DMat3, left_out: &[usize]) -> Vec<Triangle> {
    let mut triangles = Vec::new();
    for face in (0..6).filter(|face| !left_out.contains(face)) {
        let (axis, side) = (face / 2, if face % 2 == 0 { -1.0 } else { 1.0 });
        let at = |s: f64, t: f64| {
            let mut p = DVec3::ZERO;
            p[axis] = side * half[axis];
            p[(axis + 1) % 3] = s * half[(axis + 1) % 3];
            p[(axis + 2) % 3] = side * t * half[(axis + 2) % 3];
            centre + turn * p
        };
        let [a, b, c, d] = [at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)];
        triangles.extend([[a, b, c], [a, c, d]]);
    }
    triangles
}

/// The place of a point of a triangle that is nearest to `p` (Ericson 2004, section 5.1.5).
fn distance(p: DVec3, [a, b, c]: [DVec3; 3]) -> f64 {
    let normal = (b - a).cross(c - a).normalize();
    let inside = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|&(u, v)| normal.dot((v - u).cross(p - u)) >= 0.0);
    if inside {
        return normal.dot(p - a).abs();
    }
    let to_edge = |(u, v): (DVec3, DVec3)| {
        let t = ((p - u).dot(v - u) / (v - u).length_squared()).clamp(0.0, 1.0);
        (u + (v - u) * t - p).length()
    };
    [(a, b), (b, c), (c, a)]
        .map(to_edge)
        .into_iter()
        .fold(f64::INFINITY, f64::min)
}

/// Every covered face is within w of polygons: at random points, along its border and at its corners.
fn assert_covered(scene: &Scene, solids: &[Solid], random: &mut Random) -> usize {
    let triangles: Vec<[DVec3; 3]> = (0..scene.polygons.len())
        .map(|i| {
            scene
                .corners(crate::math::PolygonId::new(i))
                .map(Vec3::as_dvec3)
        })
        .collect();
    let mut faces = 0;
    for solid in solids {
        for axis in 0..3 {
            for (side, covered) in [-1.0, 1.0].into_iter().zip(solid.covered[axis]) {
                if !covered {
                    continue;
                }
                faces += 1;
                let [a, b, _, d] = solid.face(axis, side);
                for sample in 0..60 {
                    let mut place = || match sample % 3 {
                        0 => random.unit(),
                        1 => [0.0, 1.0][random.below(2)],
                        _ => [0.0, 1.0, random.unit()][random.below(3)],
                    };
                    let p = a + (b - a) * place() + (d - a) * place();
                    let least = triangles
                        .iter()
                        .fold(f64::INFINITY, |m, &t| m.min(distance(p, t)));
                    assert!(least < WELD, "{} w from all surface", least / WELD);
                }
            }
        }
    }
    faces
}

/// The solid that is the box, up to a few w, if it is there.
fn find(set: &OccluderSet, centre: DVec3, half: DVec3) -> Option<&Solid> {
    let volume = 8.0 * half.x * half.y * half.z;
    set.solids.iter().find(|solid| {
        (solid.centre.as_dvec3() - centre).length() < 8.0 * WELD
            && (f64::from(solid.volume()) / volume - 1.0).abs() < 1.0e-3
    })
}

fn covered_faces(solid: &Solid) -> usize {
    solid.covered.as_flattened().iter().filter(|c| **c).count()
}

#[test]
fn a_closed_box_is_a_solid_and_a_missing_face_is_open() {
    let mut random = Random::new(5);
    let half = DVec3::new(0.2, 0.11, 0.05);
    for round in 0..24 {
        let turn = if round == 0 {
            DMat3::IDENTITY
        } else {
            random.rotation()
        };
        let centre = DVec3::new(random.between(-0.1, 0.1), random.between(-0.1, 0.1), 0.02);
        for left_out in [&[][..], &[3], &[0, 4], &[0, 1]] {
            let (scene, set) = extract(&box_faces(centre, half, turn, left_out));
            let solid = find(&set, centre, half).expect("the box is found");
            assert_eq!(
                covered_faces(solid),
                6 - left_out.len(),
                "round {round}, {left_out:?}"
            );
            assert!(assert_covered(&scene, &set.solids, &mut random) > 0);
        }
    }
}

#[test]
fn a_slot_in_a_face_leaves_it_open_and_a_crack_does_not() {
    let half = DVec3::new(0.2, 0.11, 0.05);
    for (slot, expected) in [(0.05, 6), (4.0, 5), (1000.0, 5)] {
        let mut triangles = box_faces(DVec3::ZERO, half, DMat3::IDENTITY, &[5]);
        // The lid in two parts with a slot of so many w between them, across.
        for [low, high] in [[-half.x, -0.5 * slot * WELD], [0.5 * slot * WELD, half.x]] {
            let at = |x: f64, y: f64| DVec3::new(x, y * half.y, half.z);
            let [a, b, c, d] = [at(low, -1.0), at(high, -1.0), at(high, 1.0), at(low, 1.0)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
        let (scene, set) = extract(&triangles);
        let solid = find(&set, DVec3::ZERO, half).expect("the box is found");
        assert_eq!(covered_faces(solid), expected, "a slot of {slot} w");
        assert_covered(&scene, &set.solids, &mut Random::new(1));
    }
}

#[test]
fn what_stands_on_a_floor_is_closed_by_the_floor() {
    let half = DVec3::new(0.1, 0.1, 0.15);
    let mut triangles = box_faces(
        DVec3::new(0.0, 0.0, half.z - 0.4),
        half,
        DMat3::IDENTITY,
        &[4],
    );
    let at = |x: f64, y: f64| DVec3::new(x, y, -0.4);
    let [a, b, c, d] = [
        at(-0.45, -0.45),
        at(0.45, -0.45),
        at(0.45, 0.45),
        at(-0.45, 0.45),
    ];
    triangles.extend([[a, b, c], [a, c, d]]);
    let (scene, set) = extract(&triangles);
    let solid = find(&set, DVec3::new(0.0, 0.0, half.z - 0.4), half).expect("found");
    assert_eq!(covered_faces(solid), 6);
    assert_covered(&scene, &set.solids, &mut Random::new(2));
    // It reaches a little below the floor: what lies on it on both sides is hidden.
    let lowest = solid
        .corners()
        .iter()
        .fold(f64::INFINITY, |m, c| m.min(c.z));
    assert!(lowest < -0.4 && lowest > -0.4 - WELD);
}
