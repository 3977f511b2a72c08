//! `certilux solve` leaves what the interface promises.

use crate::command::Folder;
use certilux::output::read_ply;
use glam::DVec3;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;

const KEYS: [(&str, &str); 5] = [
    (
        "",
        "format certilux embree command seed threads technique epsilon rays_per_exchange scene \
         hierarchy passes seconds power",
    ),
    (
        "/scene",
        "path faces polygons area bounds channels dropped_faces warnings",
    ),
    (
        "/hierarchy",
        "face_clusters volume_clusters occluders leaves bytes",
    ),
    ("/seconds", "load cluster occluders embree solve output"),
    (
        "/power",
        "emitted absorbed escaped escaped_stderr unshot imbalance",
    ),
];

const PASS_KEYS: &str = "pass seconds exchanges exchanges_blocked exchanges_sampled_clear rays rays_blocked \
    native_rays native_rays_blocked shafts occluded_claims visible_claims exchanges_visible unshot";

/// The promised keys and no value that JSON had to replace by null.
fn check_stats(stats: &Value) {
    for (place, keys) in KEYS {
        let block = stats.pointer(place).unwrap();
        for key in keys.split_whitespace() {
            assert!(block.get(key).is_some(), "{place}/{key} is missing");
        }
    }
    let passes = stats["passes"].as_array().unwrap();
    assert!(!passes.is_empty());
    for (i, pass) in passes.iter().enumerate() {
        for key in PASS_KEYS.split_whitespace() {
            assert!(pass[key].is_number(), "passes/{i}/{key}");
        }
        assert_eq!(pass["pass"], i + 1);
    }
    for block in ["seconds", "power", "hierarchy"] {
        for (key, value) in stats[block].as_object().unwrap() {
            assert!(value.is_number(), "{block}/{key} is {value}");
        }
    }
}

/// Faces of an OBJ text: the corners of each `f` line, in file order.
fn faces(obj: &str) -> Vec<Vec<DVec3>> {
    let mut vertices = Vec::new();
    let mut faces = Vec::new();
    for line in obj.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let c: Vec<f64> = words.map(|w| w.parse().unwrap()).collect();
                vertices.push(DVec3::new(c[0], c[1], c[2]));
            }
            Some("f") => faces.push(
                words
                    .map(|w| {
                        let index: usize = w.split('/').next().unwrap().parse().unwrap();
                        vertices[index - 1]
                    })
                    .collect(),
            ),
            _ => {}
        }
    }
    faces
}

/// Area of a plane polygon, convex or not, by Newell's sum.
fn area(corners: &[DVec3]) -> f64 {
    let origin = corners[0];
    let sum: DVec3 = (0..corners.len())
        .map(|i| (corners[i] - origin).cross(corners[(i + 1) % corners.len()] - origin))
        .sum();
    0.5 * sum.length()
}

#[test]
fn a_solve_writes_four_whole_files() {
    let folder = Folder::new();
    let run = folder.line("solve builtin:cornell --out results --epsilon 1e-4");
    run.ends_with(0, "solve");
    assert_eq!(
        folder.names("results"),
        ["solution.ply", "stats.json", "view.exr", "view.png"]
    );
    for name in folder.names("results") {
        assert!(run.stdout.contains(&name), "{name}: {}", run.stdout);
    }
    check_stats(&folder.stats("results"));
    let png = fs::read(folder.path("results/view.png")).unwrap();
    assert_eq!(&png[..8], b"\x89PNG\r\n\x1a\n");
    let exr = fs::read(folder.path("results/view.exr")).unwrap();
    assert_eq!(exr[..4], 20_000_630u32.to_le_bytes());
}

#[test]
fn the_patches_of_a_face_tile_it() {
    let folder = Folder::new();
    folder
        .line("generate cornell --out .")
        .ends_with(0, "generate");
    folder
        .line("solve cornell.obj --out results --no-view --epsilon 1e-4")
        .ends_with(0, "solve");
    assert_eq!(folder.names("results"), ["solution.ply", "stats.json"]);

    let faces = faces(&fs::read_to_string(folder.path("cornell.obj")).unwrap());
    let stats = folder.stats("results");
    assert_eq!(stats["scene"]["faces"], faces.len());
    let whole: f64 = faces.iter().map(|f| area(f)).sum();
    let told = stats["scene"]["area"].as_f64().unwrap();
    assert!((told - whole).abs() < 1e-9 * whole, "{told} for {whole}");

    let mesh = read_ply(&folder.path("results/solution.ply")).unwrap();
    let mut tiled: BTreeMap<(u32, u8), f64> = BTreeMap::new();
    for face in &mesh.faces {
        let corners = face.vertices.map(|v| mesh.vertices[v as usize]);
        *tiled
            .entry((face.source_face, face.side as u8))
            .or_default() += area(&corners);
        for (radiosity, irradiance) in face.radiosity.iter().zip(face.irradiance) {
            assert!(*radiosity >= 0.0 && irradiance >= 0.0, "{face:?}");
        }
    }
    assert!(mesh.faces.len() > 2 * tiled.len(), "nothing was split");
    for ((face, side), sum) in &tiled {
        let whole = area(&faces[*face as usize]);
        assert!(
            (sum - whole).abs() < 1e-9 * whole,
            "face {face} side {side}: {sum} for {whole}"
        );
    }
    for (face, corners) in faces.iter().enumerate() {
        let face_number = face as u32;
        assert!(
            tiled.keys().any(|(f, _)| *f == face_number),
            "face {face} is missing"
        );
        for corner in corners {
            assert!(mesh.vertices.contains(corner), "a vertex of {face} moved");
        }
    }
}

#[test]
fn the_header_of_the_solution_is_the_published_one() {
    let folder = Folder::new();
    folder
        .line("solve builtin:cornell --out results --no-view --passes 1 --epsilon 1e-3")
        .ends_with(0, "solve");
    let bytes = fs::read(folder.path("results/solution.ply")).unwrap();
    let end = bytes
        .windows(11)
        .position(|w| w == b"end_header\n")
        .unwrap();
    let header = std::str::from_utf8(&bytes[..end]).unwrap();
    let lines: Vec<&str> = header
        .lines()
        .filter(|l| !l.starts_with("comment"))
        .map(|l| {
            // Counts differ; the place of the element does not.
            if l.starts_with("element") {
                l.rsplit_once(' ').unwrap().0
            } else {
                l
            }
        })
        .collect();
    let expected = "ply|format binary_little_endian 1.0|element vertex|property double x|\
        property double y|property double z|property uchar red|property uchar green|\
        property uchar blue|element face|property list uchar int vertex_indices|\
        property int source_face|property uchar side|property float radiosity_r|\
        property float radiosity_g|property float radiosity_b|property float irradiance_r|\
        property float irradiance_g|property float irradiance_b";
    assert_eq!(lines.join("|"), expected);
    let mesh = read_ply(&folder.path("results/solution.ply")).unwrap();
    // A vertex: three doubles and three bytes; a face: a length, three indices, face, side, six floats.
    let body = mesh.vertices.len() * 27 + mesh.faces.len() * 42;
    assert_eq!(bytes.len() - end - 11, body);
}

#[test]
fn bright_closed_scenes_report_how_rows_were_normalised() {
    let folder = Folder::new();
    for (scene, normalised) in [("furnace-0.95", true), ("furnace-0.9", false)] {
        let line =
            format!("solve builtin:{scene} --out {scene} --no-view --passes 2 --epsilon 1e-3");
        let run = folder.line(&line);
        run.ends_with(0, scene);
        assert_eq!(
            run.stdout.contains("row normalisation"),
            normalised,
            "{}",
            run.stdout
        );
        match folder.stats(scene)["row_scales"].as_array() {
            Some(scales) => {
                assert!(normalised && scales.len() == 2);
                // Rows are right to some percent before they are scaled.
                let near_one = |x: &Value| (x.as_f64().unwrap() - 1.0).abs() < 0.05;
                assert!(scales.iter().all(near_one), "{scales:?}");
            }
            None => assert!(!normalised),
        }
    }
}
