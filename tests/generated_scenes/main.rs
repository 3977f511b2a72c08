//! The built-in scenes are what they are said to be: the text is read back and judged.

mod contact;
mod frozen;
mod neighbours;
mod reader;

use certilux::scene::generate::{catalogue, generate};
use certilux::scene::{LoadConfig, load_text};
use glam::DVec3;
use reader::{ReadScene, ReadTriangle, read};
use std::collections::{BTreeMap, BTreeSet};

/// Scenes whose surfaces are open sheets: nothing closes them.
const OPEN: [&str; 7] = [
    "cornell",
    "cornell-spheres",
    "cie171-5.6",
    "parallel-plates",
    "perpendicular-plates",
    "infinite-plates",
    "coaxial-discs",
];

/// Scenes that are closed although the edges of neighbouring sides do not match.
const UNMATCHED: [&str; 4] = ["furnace-tjunctions", "sealed", "sealed-slab", "cie171-5.8"];

/// Triangle counts that are part of the scenes' descriptions, and how far off they may be. Those
/// of a to f are the counts of the paper's scenes A to F.
const COUNTS: [(&str, usize, f64); 10] = [
    ("a", 37_424, 0.02),
    ("b", 83_600, 0.02),
    ("c", 51_296, 0.02),
    ("d", 741, 0.02),
    ("e", 14_453, 0.02),
    ("f", 642, 0.02),
    ("cornell", 36, 0.0),
    ("two-rooms", 1400, 0.05),
    ("corridor", 1400, 0.05),
    ("offices", 21_000, 0.03),
];

fn names() -> impl Iterator<Item = &'static str> {
    catalogue().iter().map(|entry| entry.name)
}

#[test]
fn every_scene_is_well_formed_text() {
    for name in names() {
        let scene = read(name);
        assert_eq!(scene.library, format!("{name}.mtl"));
        assert!(!scene.triangles.is_empty(), "{name} is empty");
        for (material, read) in &scene.materials {
            let valid = |kd: f64| (0.0..1.0).contains(&kd);
            assert!(read.kd.into_iter().all(valid), "{name}: Kd of {material}");
            let valid = |ke: f64| ke.is_finite() && ke >= 0.0;
            assert!(read.ke.into_iter().all(valid), "{name}: Ke of {material}");
        }
        let used: BTreeSet<_> = scene.triangles.iter().map(|t| &t.material).collect();
        let defined: BTreeSet<_> = scene.materials.keys().collect();
        assert_eq!(used, defined, "{name}: materials");
        let lit = |t: &ReadTriangle| scene.materials[&t.material].ke != [0.0; 3];
        assert!(scene.triangles.iter().any(lit), "{name} has no emitter");
    }
}

#[test]
fn every_scene_loads_without_a_warning_and_whole() {
    for name in names() {
        let text = generate(name).unwrap();
        let library = format!("{name}.mtl");
        let files = [(library.as_str(), text.mtl.as_bytes())];
        let scene = load_text(name, text.obj.as_bytes(), &files, &LoadConfig::default());
        let scene = scene.unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(scene.warnings, [], "{name}");
        assert_eq!(scene.dropped_faces, [0_u32; 0], "{name}");
        assert_eq!(scene.polygons.len(), read(name).triangles.len());
    }
}

#[test]
fn every_scene_is_the_same_every_time() {
    for name in names() {
        assert_eq!(generate(name), generate(name));
    }
}

#[test]
fn triangle_counts_are_as_described() {
    for (name, asked, tolerance) in COUNTS {
        let count = read(name).triangles.len();
        let off = (count as f64 - asked as f64).abs() / asked as f64;
        assert!(off <= tolerance, "{name}: {count} instead of {asked}");
    }
}

#[test]
fn no_triangle_is_degenerate_or_there_twice() {
    for name in names() {
        let scene = read(name);
        let mut seen = BTreeSet::new();
        for triangle in &scene.triangles {
            let [a, b, c] = triangle.corners;
            let longest = (b - a).length().max((c - b).length()).max((a - c).length());
            let altitude = 2.0 * triangle.area() / longest;
            assert!(altitude > 4e-3, "{name}: a sliver {altitude} m high");
            let mut key = triangle.corners.map(position_key);
            key.sort();
            assert!(seen.insert(key), "{name}: {:?} twice", triangle.corners);
        }
    }
}

#[test]
fn closed_scenes_match_every_edge_with_its_reverse() {
    let mut checked = 0;
    for name in names().filter(|n| !OPEN.contains(n) && !UNMATCHED.contains(n)) {
        let scene = read(name);
        // The balance of each directed edge against its reverse, object by object.
        let mut balance: BTreeMap<_, i32> = BTreeMap::new();
        for triangle in &scene.triangles {
            for k in 0..3 {
                let from = position_key(triangle.corners[k]);
                let to = position_key(triangle.corners[(k + 1) % 3]);
                let (edge, step) = if from < to {
                    ((from, to), 1)
                } else {
                    ((to, from), -1)
                };
                *balance.entry((triangle.object, edge)).or_default() += step;
            }
        }
        let unmatched = balance.values().filter(|&&b| b != 0).count();
        assert_eq!(unmatched, 0, "{name}: edges without a partner");
        checked += 1;
    }
    assert!(checked >= 9);
}

#[test]
fn the_area_vectors_of_closed_objects_cancel() {
    for name in names().filter(|n| !OPEN.contains(n) && *n != "sealed-slab") {
        let scene = read(name);
        let mut sums = vec![(DVec3::ZERO, 0.0); scene.object_names.len() + 1];
        for triangle in &scene.triangles {
            sums[triangle.object].0 += triangle.cross();
            sums[triangle.object].1 += triangle.area();
        }
        for (object, (sum, area)) in sums.into_iter().enumerate() {
            assert!(
                sum.length() <= 1e-5 * area,
                "{name}: object {object} is open"
            );
        }
    }
}

#[test]
fn no_two_triangles_share_area_or_pierce_each_other() {
    for name in names() {
        let scene = read(name);
        let triangles = &scene.triangles;
        let mut pairs = 0_usize;
        neighbours::for_each_near_pair(triangles, |i, j| {
            pairs += 1;
            let (a, b) = (&triangles[i], &triangles[j]);
            let shared = contact::shared_area(a, b);
            assert!(
                shared < 1e-5,
                "{}: {shared} m2",
                pair_names(name, &scene, i, j)
            );
            let pierced = contact::pierces(a, b);
            assert!(!pierced, "{} pierce", pair_names(name, &scene, i, j));
        });
        assert!(pairs > 0);
    }
}

/// The winding number of all surfaces about a point is -1 in lit space, 0 inside solids. So a
/// point just above the top of every object tells whether the object stands in a room, outside
/// other objects, with its front outwards.
#[test]
fn objects_stand_in_lit_space_with_their_fronts_towards_it() {
    for name in names().filter(|n| !OPEN.contains(n)) {
        let scene = read(name);
        if name == "concentric-spheres" {
            assert!(is_lit(&scene, DVec3::new(0.0, 0.75, 0.0)));
            continue;
        }
        let mut tops: BTreeMap<usize, Vec<&ReadTriangle>> = BTreeMap::new();
        // y is up in the file.
        for triangle in scene
            .triangles
            .iter()
            .filter(|t| t.cross().normalize().y > 0.5)
        {
            tops.entry(triangle.object).or_default().push(triangle);
        }
        assert!(!tops.is_empty());
        for (object, mut tops) in tops {
            let object = &scene.object_names[object - 1];
            // The slab reaches up to the ceiling: its top is no place.
            if object.starts_with("slab_") {
                continue;
            }
            // The highest may be covered by what stands there, but not the whole object.
            tops.sort_by(|a, b| b.centroid().y.total_cmp(&a.centroid().y));
            let lit = tops.iter().take(TOPS).any(|top| {
                let above = top.centroid() + top.cross().normalize() * 1e-3;
                is_lit(&scene, above)
            });
            assert!(lit, "{name}: {object}");
        }
    }
}

/// How many of an object's highest triangles are looked at.
const TOPS: usize = 20;

fn is_lit(scene: &ReadScene, point: DVec3) -> bool {
    let angles = scene.triangles.iter().map(|t| solid_angle(t, point));
    let winding = angles.sum::<f64>() / (4.0 * std::f64::consts::PI);
    (winding + 1.0).abs() < 1e-3
}

/// Signed solid angle of a triangle (van Oosterom and Strackee 1983), positive seen from behind.
fn solid_angle(triangle: &ReadTriangle, point: DVec3) -> f64 {
    let [a, b, c] = triangle.corners.map(|corner| corner - point);
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let volume = a.dot(b.cross(c));
    let rest = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * volume.atan2(rest)
}

#[test]
fn a_convex_room_lies_in_front_of_all_its_faces() {
    for name in ["furnace", "furnace-tjunctions", "cie171-5.4", "cie171-5.8"] {
        let scene = read(name);
        let total: f64 = scene.triangles.iter().map(ReadTriangle::area).sum();
        let weighted = scene.triangles.iter().map(|t| t.centroid() * t.area());
        let centre = weighted.sum::<DVec3>() / total;
        for triangle in &scene.triangles {
            let ahead = (centre - triangle.corners[0]).dot(triangle.cross());
            assert!(ahead > 0.0, "{name}: a face looks outwards");
        }
    }
}

#[test]
fn furnaces_emit_and_reflect_alike_everywhere() {
    for content in ["", "-blocks", "-partitions", "-tjunctions", "-sphere"] {
        for rho in ["0", "0.5", "0.9", "0.99"] {
            let name = format!("furnace{content}-{rho}");
            let scene = read(&name);
            let rho: f64 = rho.parse().unwrap();
            assert_eq!(scene.materials.len(), 1, "{name}");
            let material = scene.materials.values().next().unwrap();
            assert_eq!(material.kd, [rho; 3]);
            assert_eq!(material.ke, [1.0; 3]);
            // Inward faces around the room, outward ones around what stands in it.
            let volume: f64 = scene
                .triangles
                .iter()
                .map(|t| t.corners[0].dot(t.cross()) / 6.0)
                .sum();
            assert!(
                (-60.0 - 1e-6..-0.9 * 60.0).contains(&volume),
                "{name}: {volume}"
            );
        }
    }
}

#[test]
fn plates_and_cubes_have_the_flux_that_their_closed_forms_need() {
    let flux = |name: &str, material: &str| -> f64 {
        let scene = read(name);
        let area: f64 = scene
            .triangles
            .iter()
            .filter(|t| t.material == material)
            .map(ReadTriangle::area)
            .sum();
        area * scene.materials[material].ke[0] * std::f64::consts::PI
    };
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-6, "{a} is not {b}");
    close(flux("cie171-5.4", "source"), 1000.0);
    close(flux("cie171-5.6", "floor_source"), 500.0 * 16.0);
    close(flux("cie171-5.8-0.9", "wall"), 10_000.0);
    close(flux("parallel-plates", "source"), 1.0);
    close(flux("perpendicular-plates", "source"), 1.0);
    close(flux("coaxial-discs", "source"), std::f64::consts::PI);
}

#[test]
fn sealed_rooms_are_parted_from_the_lit_one_by_five_centimetres() {
    let scene = read("sealed");
    let is_sealed = |t: &&ReadTriangle| t.material.starts_with("sealed_");
    let (sealed, lit): (Vec<_>, Vec<_>) = scene.triangles.iter().partition(is_sealed);
    assert!(sealed.len() > 100 && lit.len() > 100);
    assert!(
        sealed
            .iter()
            .all(|t| scene.materials[&t.material].ke == [0.0; 3])
    );
    // All surfaces are parallel to the axes, so the distance of the boxes of two triangles is that
    // of the surfaces or less.
    let bounds = |t: &ReadTriangle| {
        let [a, b, c] = t.corners;
        (a.min(b).min(c), a.max(b).max(c))
    };
    let mut least = f64::INFINITY;
    for s in &sealed {
        for l in &lit {
            let ((a, b), (c, d)) = (bounds(s), bounds(l));
            least = least.min((c - b).max(a - d).max(DVec3::ZERO).length());
        }
    }
    assert!((least - 0.05).abs() < 1e-9, "{least}");
}

#[test]
fn a_wrong_name_is_told_what_was_meant() {
    let error = generate("cornel").unwrap_err();
    assert_eq!(error.near[0], "cornell");
    assert!(error.to_string().contains("`cornel`") && error.to_string().contains("cornell,"));
    for wrong in [
        "",
        "furnace-",
        "furnace-1",
        "furnace-1.0",
        "furnace--0.5",
        "furnace-nan",
        "furnace-1e-3",
        "furnace-0.5.1",
        "furnace-.",
        "cornell-0.5",
        "furnace-../x",
        "cie171-5.8-2",
    ] {
        let error = generate(wrong).unwrap_err();
        assert_eq!(error.name, wrong);
        assert_eq!(error.near.is_empty(), wrong.is_empty(), "{wrong}");
    }
}

/// A position in micrometres.
fn position_key(p: DVec3) -> [i64; 3] {
    p.to_array().map(|x| (x * 1e6).round() as i64)
}

fn pair_names(name: &str, scene: &ReadScene, i: usize, j: usize) -> String {
    let object = |k: usize| {
        let triangle = &scene.triangles[k];
        let object = triangle.object.checked_sub(1);
        let object = object.map_or("-", |o| &scene.object_names[o]);
        format!("{object} at {}", triangle.centroid())
    };
    format!("{name}: {} and {}", object(i), object(j))
}
