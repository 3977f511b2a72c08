//! No claim is false: segments through both faces of an occluder are never surely clear.

use super::builders::{Random, Triangle, WELD, Wall, extract_with, height_field};
use crate::occluder::{OccluderConfig, OccluderSet, SlabRectangle};
use crate::scene::Scene;
use glam::{DMat3, DVec2, DVec3};
use robust::{Coord3D, orient3d};

/// Shoots random segments through both faces of every occluder; panics with the segment if one is
/// surely clear. A third of them are uniform, a third aim at the borders of the faces, a third at
/// the edges of triangles, where cracks are.
pub fn attack(scene: &Scene, set: &OccluderSet, segments: usize, random: &mut Random) {
    let mesh = &scene.polygons[..scene.polygons.len() - 2];
    let triangles = mesh
        .iter()
        .map(|p| p.vertices.map(|v| scene.positions[v as usize].as_dvec3()));
    let all: Vec<Triangle> = triangles.clone().collect();
    for occluder in &set.occluders {
        for i in 0..segments {
            let (top, bottom) = match i % 3 {
                2 => through_an_edge(&occluder.slab, &all, random),
                kind => (
                    point_of_face(&occluder.slab, 1.0, kind == 1, random),
                    point_of_face(&occluder.slab, -1.0, kind == 1 && i % 2 == 0, random),
                ),
            };
            assert!(
                comes_near(top, bottom, triangles.clone()),
                "{top} to {bottom} passes {occluder:?}"
            );
        }
    }
}

/// A segment from face to face, nearly upright, through a point on or close to an edge of a triangle
/// that lies in the slab; a uniform one if none is found.
fn through_an_edge(
    slab: &SlabRectangle,
    triangles: &[Triangle],
    random: &mut Random,
) -> (DVec3, DVec3) {
    let [a, b, _, d] = slab.face_corners(-1.0);
    let (u, v, n) = (b - a, d - a, slab.normal.as_dvec3());
    let thickness = 2.0 * f64::from(slab.half_thickness);
    for _ in 0..50 {
        let triangle = triangles[random.below(triangles.len())];
        let k = random.below(3);
        let on_edge = triangle[k].lerp(triangle[(k + 1) % 3], random.unit());
        let beside = 10f64.powf(random.between(-9.0, -5.0));
        let aim = on_edge
            + (u.normalize() * random.between(-1.0, 1.0)
                + v.normalize() * random.between(-1.0, 1.0))
                * beside;
        let tilt = thickness * 10f64.powf(random.between(-3.0, 1.0));
        let lean = u.normalize() * random.between(-tilt, tilt)
            + v.normalize() * random.between(-tilt, tilt);
        let st = |p: DVec3| {
            [
                (p - a).dot(u) / u.length_squared(),
                (p - a).dot(v) / v.length_squared(),
            ]
        };
        let inside = |p: DVec3| st(p).iter().all(|&c| (0.0..=1.0).contains(&c));
        if inside(aim + lean) && inside(aim - lean) {
            let at = |p: DVec3| a + u * st(p)[0] + v * st(p)[1];
            return (at(aim + lean) + n * thickness, at(aim - lean));
        }
    }
    (
        point_of_face(slab, 1.0, false, random),
        point_of_face(slab, -1.0, false, random),
    )
}

fn point_of_face(slab: &SlabRectangle, side: f64, border: bool, random: &mut Random) -> DVec3 {
    let [a, b, _, d] = slab.face_corners(side);
    let mut s = [random.unit(), random.unit()];
    if border {
        s[random.below(2)] = [0.0, 1.0, 1.0e-7, 1.0 - 1.0e-7][random.below(4)];
    }
    a + (b - a) * s[0] + (d - a) * s[1]
}

/// True when the segment crosses a triangle (exactly) or comes within w of one.
fn comes_near(p: DVec3, q: DVec3, triangles: impl Iterator<Item = Triangle> + Clone) -> bool {
    triangles.clone().any(|t| crosses(p, q, t))
        || triangles
            .flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]])
            .any(|[a, b]| segment_distance(p, q, a, b) <= WELD)
}

fn side(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let coord = |p: DVec3| Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    };
    orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// True when the closed segment meets the closed triangle and is not parallel to it, exactly.
fn crosses(p: DVec3, q: DVec3, [a, b, c]: Triangle) -> bool {
    if side(a, b, c, p) * side(a, b, c, q) > 0.0 {
        return false;
    }
    let s = [side(p, q, a, b), side(p, q, b, c), side(p, q, c, a)];
    s.iter().any(|&s| s != 0.0) && (s.iter().all(|&s| s >= 0.0) || s.iter().all(|&s| s <= 0.0))
}

/// Distance between two segments, by alternating projection from a closed form on the lines.
fn segment_distance(p: DVec3, q: DVec3, a: DVec3, b: DVec3) -> f64 {
    let (u, v, w) = (q - p, b - a, p - a);
    let (uu, uv, vv) = (u.dot(u), u.dot(v), v.dot(v));
    let det = uu * vv - uv * uv;
    let s = if det > 1.0e-30 {
        ((uv * v.dot(w) - vv * u.dot(w)) / det).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let t = ((p + u * s - a).dot(v) / vv).clamp(0.0, 1.0);
    let s = ((a + v * t - p).dot(u) / uu).clamp(0.0, 1.0);
    (p + u * s - a - v * t).length()
}

fn turned(triangles: &[Triangle], axes: DMat3) -> Vec<Triangle> {
    triangles.iter().map(|t| t.map(|p| axes * p)).collect()
}

/// Anything goes, down to rectangles of a thousandth of the scene.
fn greedy() -> OccluderConfig {
    OccluderConfig {
        per_cluster: 16,
        min_area: 1.0e-5,
        flatness_degrees: 30.0,
        cone_degrees: 180.0,
        flush: true,
        solids: true,
    }
}

#[test]
fn bumpy_surfaces_are_never_passed() {
    let mut random = Random::new(11);
    let mut found = 0;
    for round in 0..60 {
        let n = 2 + random.below(12);
        let amplitude = 10f64.powf(random.between(-7.5, -1.0));
        let phase = [random.between(0.0, 9.0), random.between(0.0, 9.0)];
        let noise = random.below(2) == 0;
        let mut own = Random::new(round);
        let mut mesh = height_field(DVec2::splat(0.4), n, n, |p| {
            if noise {
                amplitude * (p.x * 20.0 + phase[0]).sin() * (p.y * 15.0 + phase[1]).cos()
            } else {
                amplitude * ((p.x * 937.0 + p.y * 411.0 + phase[0]).sin())
            }
        });
        // Holes, and vertices pulled sideways until triangles fold over.
        for _ in 0..own.below(4) {
            mesh.swap_remove(own.below(mesh.len()));
        }
        let fold = own.between(0.0, 0.3);
        let shift = |p: DVec3| {
            let h = (p.x * 7919.0 + p.y * 104_729.0).sin();
            DVec3::new(p.x + 0.4 / n as f64 * fold * 4.0 * h, p.y, p.z)
        };
        let mesh: Vec<Triangle> = mesh.iter().map(|t| t.map(shift)).collect();
        let mesh = turned(&mesh, own.rotation());
        let (scene, set) = extract_with(&mesh, &greedy());
        found += set.occluders.len();
        attack(&scene, &set, 400, &mut random);
    }
    assert!(found > 100, "only {found} occluders put to the test");
}

#[test]
fn triangle_soups_are_never_passed() {
    let mut random = Random::new(5);
    let mut found = 0;
    for _ in 0..60 {
        // Random triangles near a plane: overlapping, crossing, abutting at different heights.
        let height = 10f64.powf(random.between(-8.0, -3.0));
        let count = 20 + random.below(100);
        let mesh: Vec<Triangle> = (0..count)
            .map(|_| {
                let centre = DVec2::new(random.between(-0.2, 0.2), random.between(-0.2, 0.2));
                let mut corner = || {
                    let r = DVec2::new(random.between(-0.2, 0.2), random.between(-0.2, 0.2));
                    (centre + r).extend(random.between(-height, height))
                };
                let [a, b, c] = [corner(), corner(), corner()];
                if (b - a).cross(c - a).z > 0.0 {
                    [a, b, c]
                } else {
                    [a, c, b]
                }
            })
            .collect();
        let mesh = turned(&mesh, random.rotation());
        let (scene, set) = extract_with(&mesh, &greedy());
        found += set.occluders.len();
        attack(&scene, &set, 400, &mut random);
    }
    assert!(found > 100, "only {found} occluders put to the test");
}

#[test]
fn meshes_torn_at_the_weld_distance_are_never_passed() {
    let mut random = Random::new(31);
    let mut found = 0;
    let whole = Wall {
        size: DVec2::new(0.3, 0.2),
        holes: vec![[DVec2::new(0.1, 0.05), DVec2::new(0.15, 0.1)]],
    };
    for round in 0..80 {
        // Every triangle is moved by itself, flat or in all directions, by a hundredth of w to 10 w.
        let tear = WELD * 10f64.powf(random.between(-2.0, 1.0));
        let lift = [0.0, 0.2, 1.0, 30.0][random.below(4)] * tear;
        let mesh: Vec<Triangle> = whole
            .cut_at_random(40 + random.below(200), round)
            .iter()
            .map(|t| {
                t.map(|p| {
                    let mut by = |most: f64| random.between(-most, most);
                    p.extend(0.0) + DVec3::new(by(tear), by(tear), by(lift))
                })
            })
            .collect();
        let mesh = if round % 3 == 0 {
            mesh
        } else {
            turned(&mesh, random.rotation())
        };
        let (scene, set) = extract_with(&mesh, &greedy());
        found += set.occluders.len();
        attack(&scene, &set, 300, &mut random);
    }
    assert!(found > 300, "only {found} occluders put to the test");
}

#[test]
fn the_attack_finds_a_planted_slot() {
    // Two sheets a hundred w apart in height, abutting in projection, claimed as one.
    let low = height_field(DVec2::new(0.2, 0.2), 1, 1, |_| 0.0);
    let high: Vec<Triangle> = low
        .iter()
        .map(|t| t.map(|p| p + DVec3::new(0.2, 0.0, 1.0e-2)))
        .collect();
    let mesh = [low, high].concat();
    let (scene, mut set) = extract_with(&mesh, &greedy());
    let slab = SlabRectangle::new(
        glam::Vec3::new(0.2, 0.1, 0.005),
        glam::Vec3::X * 0.19,
        glam::Vec3::Y * 0.09,
        glam::Vec3::Z,
        0.0051,
    );
    attack(&scene, &set, 2_000, &mut Random::new(1));
    set.occluders[0].slab = slab;
    let caught = std::panic::catch_unwind(|| attack(&scene, &set, 2_000, &mut Random::new(1)));
    assert!(caught.is_err());
}

#[test]
fn curved_surfaces_give_only_sound_slabs() {
    let mut random = Random::new(21);
    for radius in [0.1, 0.4] {
        let sphere = height_field(DVec2::new(0.2, 0.2), 16, 16, |p| {
            let d = p - DVec2::splat(0.1);
            (0.4f64.powi(2) - d.length_squared()).sqrt() * radius / 0.4
        });
        let (_, none) = extract_with(&sphere, &OccluderConfig::default());
        let (scene, set) = extract_with(&sphere, &greedy());
        assert!(!set.occluders.is_empty());
        // As a whole a bowl is not flat; its leaves of 0.0002 of the squared diagonal are.
        for occluder in &none.occluders {
            assert!(occluder.slab.half_thickness < 2.0e-3);
        }
        attack(&scene, &none, 300, &mut random);
        attack(&scene, &set, 300, &mut random);
    }
}
