//! Defects planted in plane meshes: what may be bridged and what may not.

use super::builders::{
    Placement, Random, Triangle, WELD, Wall, extract, extract_with, fronts, height_field,
    hierarchy_of, scene_of,
};
use super::soundness::attack;
use crate::math::PolygonId;
use crate::occluder::{OccluderConfig, OccluderSet, extract_occluders, flat_clusters};
use crate::scene::{Facet, Side};
use glam::{DVec2, DVec3};

fn sheet(size: DVec2, origin: DVec3) -> Vec<Triangle> {
    height_field(size, 3, 2, |_| 0.0)
        .iter()
        .map(|t| t.map(|p| p + origin))
        .collect()
}

/// Extent of the largest occluder along x.
fn widest(set: &OccluderSet) -> f32 {
    set.occluders
        .iter()
        .map(|o| {
            let x = o.slab.corners.map(|c| c.x);
            x.iter().copied().fold(f32::MIN, f32::max) - x.iter().copied().fold(f32::MAX, f32::min)
        })
        .fold(0.0, f32::max)
}

/// Two sheets 0.2 wide side by side, `gap` apart in x and `step` in z; the second meshed otherwise,
/// so that nothing but T-junctions joins them.
fn two_sheets(gap: f64, step: f64) -> Vec<Triangle> {
    let left = sheet(DVec2::new(0.2, 0.2), DVec3::new(-0.2, -0.1, 0.1));
    let right = height_field(DVec2::new(0.2, 0.2), 2, 7, |_| 0.0)
        .iter()
        .map(|t| t.map(|p| p + DVec3::new(gap, -0.1, 0.1 + step)))
        .collect();
    [left, right].concat()
}

#[test]
fn sheets_that_abut_at_one_height_are_one() {
    let (scene, set) = extract(&two_sheets(0.0, 0.0));
    assert_eq!(set.occluders.len(), 1);
    assert!(widest(&set) > 0.3999);
    attack(&scene, &set, 2_000, &mut Random::new(1));
}

#[test]
fn a_flush_rectangle_grazes_the_border_and_no_more() {
    let mesh = two_sheets(0.0, 0.0);
    let (scene, set) = extract(&mesh);
    let over = f64::from(widest(&set)) - 0.4;
    assert!(over > 2.0 * 0.5 * WELD && over < 2.0 * 0.7 * WELD, "{over}");
    attack(&scene, &set, 20_000, &mut Random::new(14));
    let inside = OccluderConfig {
        flush: false,
        ..OccluderConfig::default()
    };
    let (_, set) = extract_with(&mesh, &inside);
    assert!(f64::from(widest(&set)) < 0.4);
}

#[test]
fn sheets_that_abut_at_different_heights_are_two() {
    for step in [5.0 * WELD, 1.0e-4, 2.0e-3] {
        let (scene, set) = extract(&two_sheets(0.0, step));
        assert!(set.occluders.len() >= 2);
        assert!(widest(&set) < 0.201, "{step}: {}", widest(&set));
        attack(&scene, &set, 2_000, &mut Random::new(2));
    }
}

#[test]
fn cracks_narrower_than_the_weld_distance_close() {
    let (scene, set) = extract(&two_sheets(0.3 * WELD, 0.0));
    assert!(widest(&set) > 0.3999);
    attack(&scene, &set, 2_000, &mut Random::new(3));
    let (scene, set) = extract(&two_sheets(3.0 * WELD, 0.0));
    assert!(widest(&set) < 0.201);
    assert!(set.statistics.covered_share() > 0.999);
    attack(&scene, &set, 2_000, &mut Random::new(4));
}

#[test]
fn overlapping_sheets_in_one_plane_unite_and_others_do_not() {
    let (scene, set) = extract(&two_sheets(-0.05, 0.0));
    assert!(widest(&set) > 0.3499);
    attack(&scene, &set, 2_000, &mut Random::new(5));
    let (scene, set) = extract(&two_sheets(-0.05, 1.0e-3));
    assert!(widest(&set) < 0.201);
    attack(&scene, &set, 2_000, &mut Random::new(6));
}

/// A surface swept along y from a profile in the xz plane.
fn swept(profile: &[DVec2]) -> Vec<Triangle> {
    let at = |p: DVec2, y: f64| DVec3::new(p.x, y, p.y);
    profile
        .windows(2)
        .flat_map(|w| {
            let [a, b, c, d] = [at(w[0], -0.1), at(w[1], -0.1), at(w[1], 0.1), at(w[0], 0.1)];
            [[a, b, c], [a, c, d]]
        })
        .collect()
}

fn anything() -> OccluderConfig {
    OccluderConfig {
        cone_degrees: 180.0,
        ..OccluderConfig::default()
    }
}

#[test]
fn folded_hems_leave_their_slot_open() {
    // Each hem folds back under itself by 0.02; the folds overlap or just meet in projection, at
    // different heights. Every edge but the outer ones is matched within its own sheet.
    let z = 2.0e-3;
    for reach in [0.0, 0.01] {
        let left = swept(&[
            DVec2::new(-0.2, 0.0),
            DVec2::new(reach, 0.0),
            DVec2::new(reach - 0.02, -0.3 * z),
        ]);
        let right = swept(&[
            DVec2::new(0.02, z + 0.3 * z),
            DVec2::new(0.0, z),
            DVec2::new(0.2, z),
        ]);
        // The right hem folds over the top: its profile runs back first, so its lower layer faces up.
        let (scene, set) = extract_with(&[left, right].concat(), &anything());
        assert!(!set.occluders.is_empty());
        assert!(widest(&set) < 0.2201, "{}", widest(&set));
        attack(&scene, &set, 3_000, &mut Random::new(7));
    }
}

#[test]
fn one_sheet_folded_in_a_z_is_still_one() {
    let z = 1.0e-3;
    let mesh = swept(&[
        DVec2::new(-0.2, 0.0),
        DVec2::new(0.02, 0.0),
        DVec2::new(-0.02, z),
        DVec2::new(0.2, z),
    ]);
    let (scene, set) = extract_with(&mesh, &anything());
    assert!(widest(&set) > 0.399, "{}", widest(&set));
    attack(&scene, &set, 3_000, &mut Random::new(8));
}

#[test]
fn crossing_sheets_are_sound() {
    let mut mesh = sheet(DVec2::new(0.4, 0.2), DVec3::new(-0.2, -0.1, 0.0));
    mesh.extend(swept(&[
        DVec2::new(-0.2, -2.0e-3),
        DVec2::new(0.25, 2.0e-3),
    ]));
    let (scene, set) = extract(&mesh);
    assert!(!set.occluders.is_empty());
    attack(&scene, &set, 2_000, &mut Random::new(9));
}

#[test]
fn back_to_back_sheets_do_not_cancel() {
    // The second sheet winds the other way; seen from above, its back facets join in.
    let front = sheet(DVec2::new(0.3, 0.2), DVec3::new(-0.1, -0.1, 0.1));
    let back: Vec<Triangle> = front.iter().map(|&[a, b, c]| [a, c, b]).collect();
    let scene = scene_of(&[front.clone(), back].concat());
    let mut facets = fronts(front.len());
    facets.extend((front.len()..2 * front.len()).map(|i| Facet {
        polygon: PolygonId::new(i),
        side: Side::Back,
    }));
    let hierarchy = hierarchy_of(&scene, facets);
    let set = extract_occluders(&scene, &hierarchy, &OccluderConfig::default());
    assert_eq!(set.occluders.len(), 1);
    assert!(set.statistics.covered_share() > 0.9999);
}

#[test]
fn both_sides_of_a_sheet_give_one_occluder() {
    let mesh = sheet(DVec2::new(0.3, 0.2), DVec3::new(-0.1, -0.1, 0.1));
    let scene = scene_of(&mesh);
    let mut facets = fronts(mesh.len());
    facets.extend((0..mesh.len()).map(|i| Facet {
        polygon: PolygonId::new(i),
        side: Side::Back,
    }));
    let hierarchy = hierarchy_of(&scene, facets);
    assert_eq!(
        flat_clusters(&scene, &hierarchy, &OccluderConfig::default()).len(),
        1
    );
    let set = extract_occluders(&scene, &hierarchy, &OccluderConfig::default());
    assert_eq!(set.occluders.len(), 1);
}

#[test]
fn sheets_on_the_scenes_box_are_left_out() {
    let mesh = sheet(DVec2::new(0.3, 0.2), DVec3::new(-0.1, -0.1, 0.5));
    let (_, set) = extract(&mesh);
    assert_eq!(set.statistics.flat_clusters, 0);
    assert!(set.occluders.is_empty());
}

#[test]
fn slivers_do_not_spoil_a_wall() {
    // Slivers of aspect 1e6 along a diagonal crack, their vertices rounded off the plane.
    let mut mesh = Vec::new();
    let p = |x: f64, y: f64| DVec2::new(x, y);
    let thin = 4.0e-7;
    mesh.push([p(0.0, 0.0), p(0.4, 0.0), p(0.4, 0.4)]);
    mesh.push([p(0.0, 0.0), p(0.4, 0.4), p(0.0, thin)]);
    mesh.push([p(0.0, thin), p(0.4, 0.4), p(0.2, 0.2 + 0.5 * thin)]);
    mesh.push([p(0.0, thin), p(0.2, 0.2 + 0.5 * thin), p(0.0, 0.4)]);
    mesh.push([p(0.2, 0.2 + 0.5 * thin), p(0.4, 0.4), p(0.0, 0.4)]);
    for seed in 0..5 {
        let placement = Placement::turned(seed);
        let (scene, set) = extract(&placement.place(&mesh));
        assert!(
            set.statistics.covered_area > 0.999 * 0.16,
            "{seed} {:?}",
            set.statistics
        );
        attack(&scene, &set, 1_000, &mut Random::new(10));
    }
}

#[test]
fn almost_flat_noise_is_one_slab() {
    let mut random = Random::new(12);
    let heights: Vec<f64> = (0..101 * 101)
        .map(|_| random.between(-5e-5, 5e-5))
        .collect();
    let mesh = height_field(DVec2::new(0.4, 0.3), 100, 100, |p| {
        let (i, j) = (
            (p.x * 250.0).round() as usize,
            (p.y / 0.003).round() as usize,
        );
        heights[101 * j + i]
    });
    let (scene, set) = extract(&mesh);
    assert_eq!(set.occluders.len(), 1);
    assert!(set.statistics.covered_share() > 0.9999);
    assert!(set.occluders[0].slab.half_thickness < 6.0e-5);
    attack(&scene, &set, 200, &mut Random::new(13));
}

#[test]
fn a_million_coplanar_triangles_take_seconds() {
    let wall = Wall::with_door_and_windows();
    let mesh = Placement::turned(1).place(&wall.regular(1_000_000));
    let scene = scene_of(&mesh);
    let hierarchy = hierarchy_of(&scene, fronts(mesh.len()));
    let started = std::time::Instant::now();
    let set = extract_occluders(&scene, &hierarchy, &OccluderConfig::default());
    let seconds = started.elapsed().as_secs_f64();
    println!(
        "{} triangles: {seconds:.2} s, {:?}",
        mesh.len(),
        set.statistics
    );
    assert!(set.statistics.covered_share() > 0.85);
    assert!(seconds < 20.0, "{seconds} s");
}
