//! The Embree layer against geometry worked out by other means.

use certilux::embree::{
    AllHitsScene, CommittedScene, Device, DeviceConfig, EmbreeError, Ray, RayPacket8, RayPacket16,
};
use certilux::math::{PolygonId, hash_u64};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// Random numbers that depend on nothing but their place.
struct Numbers(u64);

impl Numbers {
    /// In [0, 1).
    fn next(&mut self) -> f32 {
        self.0 += 1;
        (hash_u64(self.0) >> 40) as f32 / 16_777_216.0
    }

    /// In the cube around the origin with the given half side.
    fn point(&mut self, half: f32) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next()) * (2.0 * half) - half
    }
}

fn device() -> Device {
    Device::new(&DeviceConfig::default()).unwrap()
}

fn quad() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let positions = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]
        .map(|[x, y]| Vec3::new(x, y, 0.0))
        .to_vec();
    (positions, vec![[0, 1, 2], [0, 2, 3]])
}

/// Axis-aligned cube of the given half side around the origin, wound outwards.
fn cube(half: f32) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let positions = (0..8)
        .map(|i| {
            Vec3::new(
                (i & 1) as f32 - 0.5,
                (i >> 1 & 1) as f32 - 0.5,
                (i >> 2) as f32 - 0.5,
            ) * (2.0 * half)
        })
        .collect();
    let quads: [[u32; 4]; 6] = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]])
        .collect();
    (positions, triangles)
}

fn soup(count: u32, size: f32, seed: u64) -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let mut numbers = Numbers(seed);
    let positions = (0..count)
        .flat_map(|_| {
            let centre = numbers.point(0.5);
            [(); 3].map(|()| centre + numbers.point(size))
        })
        .collect();
    let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    (positions, triangles)
}

fn random_segments(count: usize, seed: u64) -> Vec<Ray> {
    let mut numbers = Numbers(seed);
    (0..count)
        .map(|_| Ray::segment(numbers.point(0.5), numbers.point(0.5)))
        .collect()
}

fn occluded_by_8(scene: &CommittedScene, rays: &[Ray]) -> Vec<bool> {
    let mut blocked = Vec::new();
    for rays in rays.chunks(8) {
        let mut packet = RayPacket8::EMPTY;
        for (lane, ray) in rays.iter().enumerate() {
            packet.set(lane, ray.origin, ray.direction, ray.tnear, ray.tfar);
        }
        let bits = scene.occluded8(&mut packet, RayPacket8::first(rays.len()));
        blocked.extend((0..rays.len()).map(|lane| bits >> lane & 1 == 1));
    }
    blocked
}

fn occluded_by_16(scene: &CommittedScene, rays: &[Ray]) -> Vec<bool> {
    let mut blocked = Vec::new();
    for rays in rays.chunks(16) {
        let mut packet = RayPacket16::EMPTY;
        for (lane, ray) in rays.iter().enumerate() {
            packet.set(lane, ray.origin, ray.direction, ray.tnear, ray.tfar);
        }
        let bits = scene.occluded16(&mut packet, RayPacket16::first(rays.len()));
        blocked.extend((0..rays.len()).map(|lane| bits >> lane & 1 == 1));
    }
    blocked
}

#[test]
fn a_quad_blocks_what_crosses_it_and_nothing_else() {
    let (positions, triangles) = quad();
    let scene = CommittedScene::build(&device(), &positions, &triangles).unwrap();
    let down = |x, y, to| Ray::segment(Vec3::new(x, y, 1.0), Vec3::new(x, y, to));
    let cases = [
        (down(0.3, 0.2, -1.0), true),
        (down(0.2, 0.3, -1.0), true),
        // On the diagonal that both triangles share: robust mode lets nothing through.
        (down(0.5, 0.5, -1.0), true),
        (down(0.37, 0.37, -1.0), true),
        (down(1.5, 0.5, -1.0), false),
        (down(-0.01, 0.5, -1.0), false),
        // Stops short of the quad.
        (down(0.3, 0.2, 0.01), false),
        // Starts beyond it.
        (
            Ray {
                tnear: 0.6,
                ..down(0.3, 0.2, -1.0)
            },
            false,
        ),
        // From below: both sides block.
        (
            Ray::segment(Vec3::new(0.3, 0.2, -1.0), Vec3::new(0.3, 0.2, 1.0)),
            true,
        ),
    ];
    let rays: Vec<Ray> = cases.iter().map(|(ray, _)| *ray).collect();
    let expected: Vec<bool> = cases.iter().map(|(_, blocked)| *blocked).collect();
    assert_eq!(occluded_by_8(&scene, &rays), expected);
    assert_eq!(occluded_by_16(&scene, &rays), expected);
    let single: Vec<bool> = rays.iter().map(|ray| scene.occluded1(ray)).collect();
    assert_eq!(single, expected);

    let mut hits = Vec::new();
    scene.closest_hits(&rays, &mut hits);
    let hit_any: Vec<bool> = hits.iter().map(Option::is_some).collect();
    assert_eq!(hit_any, expected);
    let hit = hits[0].unwrap();
    assert_eq!(hit.polygon, PolygonId(0));
    // Embree divides by an estimated reciprocal and refines it: the last bits are the processor's.
    assert!((hit.t - 0.5).abs() < 1e-6, "{}", hit.t);
    // The point is a + u (b - a) + v (c - a) with a = (0,0), b = (1,0), c = (1,1).
    assert!((hit.u - 0.1).abs() < 1e-6 && (hit.v - 0.2).abs() < 1e-6);
    // Counter-clockwise seen from +z: (b - a) x (c - a) = +z, from whichever side it is hit.
    assert_eq!(hit.geometric_normal, Vec3::Z);
    assert_eq!(hits[8].unwrap().geometric_normal, Vec3::Z);
    assert_eq!(hits[1].unwrap().polygon, PolygonId(1));
}

#[test]
fn only_active_lanes_answer() {
    let (positions, triangles) = quad();
    let scene = CommittedScene::build(&device(), &positions, &triangles).unwrap();
    for active in 0..=u8::MAX {
        let mut packet = RayPacket8::EMPTY;
        for lane in 0..8 {
            packet.set(lane, Vec3::new(0.3, 0.2, 1.0), -Vec3::Z, 0.0, 2.0);
        }
        assert_eq!(scene.occluded8(&mut packet, active), active);
    }
}

#[test]
fn every_ray_out_of_a_cube_hits_the_face_it_leaves_by() {
    let (positions, triangles) = cube(0.5);
    let scene = CommittedScene::build(&device(), &positions, &triangles).unwrap();
    let mut numbers = Numbers(11);
    let rays: Vec<Ray> = (0..10_000)
        .map(|_| Ray::half_line(numbers.point(0.4), numbers.point(1.0), 0.0))
        .collect();
    let mut hits = Vec::new();
    scene.closest_hits(&rays, &mut hits);
    for (ray, hit) in rays.iter().zip(&hits) {
        let hit = hit.expect("a closed cube stops every ray, edges and corners included");
        // Slab method in f64: the exit is the nearest of the three far planes.
        let exit = |axis: usize| {
            let (o, d) = (f64::from(ray.origin[axis]), f64::from(ray.direction[axis]));
            (0.5 * d.signum() - o) / d
        };
        let t = exit(0).min(exit(1)).min(exit(2));
        assert!(
            (f64::from(hit.t) - t).abs() <= 2e-6 * t.max(1.0),
            "{ray:?} {hit:?} {t}"
        );
        // Wound outwards: the ray leaves along the normal.
        assert!(hit.geometric_normal.dot(ray.direction) > 0.0);
    }
}

/// How a segment passes a triangle, by Moller and Trumbore (1997) in f64. `Some(true)` inside,
/// `Some(false)` outside, `None` within `margin` of the border, of an end, or edge-on.
fn crosses(ray: &Ray, [a, b, c]: [Vec3; 3], margin: f64) -> Option<bool> {
    let (a, b, c) = (a.as_dvec3(), b.as_dvec3(), c.as_dvec3());
    let (origin, direction): (DVec3, DVec3) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let (ab, ac) = (b - a, c - a);
    let p = direction.cross(ac);
    let determinant = ab.dot(p);
    if determinant.abs() < margin * direction.length() * ab.length() * ac.length() {
        return None;
    }
    let to_origin = origin - a;
    let q = to_origin.cross(ab);
    let u = to_origin.dot(p) / determinant;
    let v = direction.dot(q) / determinant;
    let t = ac.dot(q) / determinant;
    let least = u
        .min(v)
        .min(1.0 - u - v)
        .min(t - f64::from(ray.tnear))
        .min(f64::from(ray.tfar) - t);
    if least > margin {
        Some(true)
    } else if least < -margin {
        Some(false)
    } else {
        None
    }
}

#[test]
fn soup_agrees_with_brute_force_in_f64_away_from_edges() {
    let (positions, triangles) = soup(300, 0.1, 3);
    let device = device();
    let scene = CommittedScene::build(&device, &positions, &triangles).unwrap();
    let all = AllHitsScene::build(&device, &positions, &triangles).unwrap();
    let rays = random_segments(20_000, 4);
    let blocked = scene.occluded_many(&rays);
    let mut closest = Vec::new();
    scene.closest_hits(&rays, &mut closest);

    let (mut surely_blocked, mut surely_clear, mut unsure) = (0, 0, 0);
    for (i, ray) in rays.iter().enumerate() {
        let verdicts: Vec<Option<bool>> = triangles
            .iter()
            .map(|t| crosses(ray, t.map(|v| positions[v as usize]), 1e-4))
            .collect();
        let mut listed = Vec::new();
        all.for_each_hit(ray, |hit| listed.push(hit));
        assert!(listed.is_sorted_by(|a, b| a.t <= b.t));
        for (polygon, verdict) in verdicts.iter().enumerate() {
            if let Some(expected) = verdict {
                let found = listed.iter().any(|hit| hit.polygon.index() == polygon);
                assert_eq!(found, *expected, "{ray:?} against polygon {polygon}");
            }
        }
        if verdicts.contains(&Some(true)) {
            surely_blocked += 1;
            assert!(blocked[i], "{ray:?}");
        } else if verdicts.iter().all(|v| *v == Some(false)) {
            surely_clear += 1;
            assert!(!blocked[i], "{ray:?}");
        } else {
            unsure += 1;
        }
        assert_eq!(blocked[i], closest[i].is_some());
        assert_eq!(
            closest[i].map(|hit| hit.t),
            listed.first().map(|hit| hit.t),
            "{ray:?}"
        );
    }
    // The comparison must have something to compare, on both sides.
    assert!(
        surely_blocked > 2_000 && surely_clear > 2_000,
        "{surely_blocked} {surely_clear}"
    );
    assert!(unsure < 2_000, "{unsure}");
}

#[test]
fn packets_and_single_rays_agree_bar_a_hair() {
    let (positions, triangles) = soup(2_000, 0.04, 7);
    let scene = CommittedScene::build(&device(), &positions, &triangles).unwrap();
    let rays = random_segments(100_000, 8);
    let single: Vec<bool> = rays.iter().map(|ray| scene.occluded1(ray)).collect();
    let blocked = single.iter().filter(|b| **b).count();
    assert!(blocked > 10_000 && blocked < 90_000, "{blocked}");
    for (kind, packets) in [
        ("8, incoherent", scene.occluded_many(&rays)),
        ("8, coherent", occluded_by_8(&scene, &rays)),
        ("16, coherent", occluded_by_16(&scene, &rays)),
    ] {
        // Embree's packet and single-ray kernels round differently: a ray within rounding of an
        // edge (relative size 2^-24 of the triangles' 0.04, over some 1e5 x 10 near edges) may
        // differ, no other.
        let differing: Vec<&Ray> = rays
            .iter()
            .zip(single.iter().zip(&packets))
            .filter(|(_, (a, b))| a != b)
            .map(|(ray, _)| ray)
            .collect();
        assert!(
            differing.len() <= 3,
            "packets of {kind}: {}",
            differing.len()
        );
        for ray in differing {
            assert!(
                triangles
                    .iter()
                    .any(|t| crosses(ray, t.map(|v| positions[v as usize]), 1e-4).is_none()),
                "packets of {kind}: {ray:?} grazes nothing"
            );
        }
    }
}

#[test]
fn answers_are_the_same_bits_from_any_thread_and_any_build() {
    let (positions, triangles) = soup(5_000, 0.03, 21);
    let rays = random_segments(50_000, 22);
    let answer = |scene: &CommittedScene, rays: &[Ray]| {
        let mut hits = Vec::new();
        scene.closest_hits(rays, &mut hits);
        let hits: Vec<_> = hits
            .iter()
            .map(|hit| hit.map(|h| (h.polygon, h.t.to_bits(), h.u.to_bits(), h.v.to_bits())))
            .collect();
        (scene.occluded_many(rays), hits)
    };
    let device = device();
    let scene = CommittedScene::build(&device, &positions, &triangles).unwrap();
    let expected = answer(&scene, &rays);
    for threads in [2, 5] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let parts: Vec<_> = pool.install(|| {
            rays.par_chunks(1_000)
                .map(|rays| answer(&scene, rays))
                .collect()
        });
        let (blocked, hits): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
        assert_eq!(blocked.concat(), expected.0);
        assert_eq!(hits.concat(), expected.1);
    }
    // A second build, on another thread.
    let again = std::thread::scope(|scope| {
        scope
            .spawn(|| {
                let device = Device::new(&DeviceConfig::default()).unwrap();
                let scene = CommittedScene::build(&device, &positions, &triangles).unwrap();
                answer(&scene, &rays)
            })
            .join()
            .unwrap()
    });
    assert!(again == expected);
}

#[test]
fn handles_may_cross_threads() {
    fn shared<T: Send + Sync>() {}
    shared::<Device>();
    shared::<CommittedScene>();
    shared::<AllHitsScene>();

    let (positions, triangles) = cube(0.5);
    let scene = CommittedScene::build(&device(), &positions, &triangles).unwrap();
    let scene = std::thread::spawn(move || {
        assert!(scene.occluded1(&Ray::half_line(Vec3::ZERO, Vec3::X, 0.0)));
        scene
    })
    .join()
    .unwrap();
    assert!(scene.occluded1(&Ray::half_line(Vec3::ZERO, Vec3::Y, 0.0)));
}

#[test]
fn an_index_out_of_range_is_an_error_and_not_a_crash() {
    let (positions, _) = quad();
    let error = CommittedScene::build(&device(), &positions, &[[0, 1, 2], [0, 1, 4]]).unwrap_err();
    assert_eq!(
        error,
        EmbreeError::IndexOutOfRange {
            triangle: 1,
            index: 4,
            vertices: 4
        }
    );
    assert!(error.to_string().contains("triangle 1"));
}

#[test]
fn nothing_and_nan_do_no_harm() {
    let device = device();
    let down = Ray::segment(Vec3::new(0.3, 0.2, 1.0), Vec3::new(0.3, 0.2, -1.0));
    for (positions, triangles) in [
        (vec![], vec![]),
        (quad().0, vec![]),
        (vec![Vec3::NAN; 3], vec![[0, 1, 2]]),
        (vec![Vec3::INFINITY; 3], vec![[0, 1, 2]]),
        (vec![Vec3::ZERO; 3], vec![[0, 1, 2]]),
    ] {
        let scene = CommittedScene::build(&device, &positions, &triangles).unwrap();
        assert!(!scene.occluded1(&down));
        let mut hits = Vec::new();
        scene.closest_hits(&[down], &mut hits);
        assert_eq!(hits, [None]);
    }
    let (positions, triangles) = quad();
    let scene = CommittedScene::build(&device, &positions, &triangles).unwrap();
    let mut hits = Vec::new();
    for broken in [
        Ray {
            origin: Vec3::NAN,
            ..down
        },
        Ray {
            direction: Vec3::NAN,
            ..down
        },
        Ray {
            direction: Vec3::ZERO,
            ..down
        },
        Ray {
            tfar: f32::NAN,
            ..down
        },
    ] {
        scene.occluded1(&broken);
        // The sound ray beside it is unharmed.
        assert!(scene.occluded_many(&[broken, down])[1]);
        scene.closest_hits(&[broken, down], &mut hits);
        assert!(hits[1].is_some());
    }
    scene.closest_hits(&[], &mut hits);
    assert!(hits.is_empty());
    assert!(scene.occluded_many(&[]).is_empty());
}

#[test]
fn a_ray_through_a_stack_lists_every_sheet_in_order() {
    // More sheets than a first call has room for, two of them in the same place.
    let sheets = 101;
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..sheets {
        let z = if i == 100 { 0.99 } else { i as f32 / 100.0 };
        let base = positions.len() as u32;
        positions.extend([[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, z)));
        triangles.push([base, base + 1, base + 2]);
    }
    let scene = AllHitsScene::build(&device(), &positions, &triangles).unwrap();
    let mut seen = Vec::new();
    let ray = Ray::segment(Vec3::new(0.1, 0.0, -1.0), Vec3::new(0.1, 0.0, 2.0));
    scene.for_each_hit(&ray, |hit| seen.push(hit));
    let ids: Vec<u32> = seen.iter().map(|hit| hit.polygon.0).collect();
    assert_eq!(ids, (0..sheets).collect::<Vec<u32>>());
    for hit in &seen[..100] {
        let t = (1.0 + hit.polygon.0 as f32 / 100.0) / 3.0;
        assert!((hit.t - t).abs() < 1e-6);
    }
    seen.clear();
    scene.for_each_hit(&Ray::segment(Vec3::splat(3.0), Vec3::splat(4.0)), |hit| {
        seen.push(hit);
    });
    assert!(seen.is_empty());
}
