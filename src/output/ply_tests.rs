//! What is written as `solution.ply` comes back bit by bit, tiles the input, and a damaged file is
//! refused with a reason.

use super::{OutputError, SolvedMesh, fixture, read_ply, write_ply};
use crate::math::PolygonId;
use crate::scene::{Facet, Scene, Side};
use crate::solve::Solution;
use glam::DVec3;
use std::collections::{BTreeMap, HashSet};
use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

static GO: AtomicBool = AtomicBool::new(false);

/// A room with corners that no binary fraction holds, far from the origin; both sides of some
/// polygons, in an order unlike the file's, and one polygon without a side.
fn solved_room() -> (Scene, Solution) {
    let corner = DVec3::new(1000.1, -0.3, 7.7);
    let scene = fixture::room(
        corner,
        corner + DVec3::new(3.3, 4.7, 2.9),
        fixture::grey(0.5, 0.1),
    );
    let mut facets = fixture::fronts(&scene);
    facets.remove(4);
    facets.extend([2, 9, 11].map(|p| Facet {
        polygon: PolygonId(p),
        side: Side::Back,
    }));
    facets.reverse();
    let solution = fixture::solve(&scene, facets, 5, |_, [a, b, c]| {
        let middle = (a + b + c) / 3.0;
        (1.0 + middle.x, 2.0 + middle.y)
    });
    (scene, solution)
}

#[test]
fn a_solution_comes_back_bit_by_bit() {
    let (scene, solution) = solved_room();
    let mesh = SolvedMesh::new(&scene, &solution);
    assert!(mesh.faces.len() > 200, "{} faces", mesh.faces.len());
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("solution.ply");
    write_ply(&path, &mesh, &GO).unwrap();
    let back = read_ply(&path).unwrap();
    assert_eq!(back, mesh);
    let bits = |mesh: &SolvedMesh| -> Vec<[u64; 3]> {
        (mesh.vertices.iter())
            .map(|v| v.to_array().map(f64::to_bits))
            .collect()
    };
    assert_eq!(bits(&back), bits(&mesh));
}

#[test]
fn patches_tile_their_faces_and_input_vertices_stand() {
    let (scene, solution) = solved_room();
    let mesh = SolvedMesh::new(&scene, &solution);
    let mut patches: BTreeMap<(u32, Side), f64> = BTreeMap::new();
    for face in &mesh.faces {
        *patches.entry((face.source_face, face.side)).or_default() += mesh.area(face);
    }
    let mut sides: BTreeMap<(u32, Side), f64> = BTreeMap::new();
    let unlit = Facet {
        polygon: PolygonId(4),
        side: Side::Front,
    };
    for facet in solution.facets.iter().chain([&unlit]) {
        let face = scene.polygons[facet.polygon.index()].source_face;
        let [a, b, c] = scene.source_corners(facet.polygon);
        *sides.entry((face, facet.side)).or_default() += 0.5 * (b - a).cross(c - a).length();
    }
    assert_eq!(patches.len(), sides.len());
    for (key, area) in sides {
        // Midpoints at a thousand units are rounded to 2^-43 of a unit.
        assert!((patches[&key] / area - 1.0).abs() < 1e-10, "{key:?}");
    }
    let present: HashSet<[u64; 3]> = (mesh.vertices.iter())
        .map(|v| v.to_array().map(f64::to_bits))
        .collect();
    assert_eq!(present.len(), mesh.vertices.len(), "vertices are shared");
    for v in &scene.source_positions {
        assert!(present.contains(&v.to_array().map(f64::to_bits)));
    }
}

#[test]
fn faces_turn_towards_their_side() {
    let (scene, solution) = solved_room();
    let mesh = SolvedMesh::new(&scene, &solution);
    let centre = 0.5 * (scene.source_positions[0] + scene.source_positions[7]);
    let mut backs = 0;
    for face in &mesh.faces {
        let [a, b, c] = mesh.corners(face);
        let inwards = (b - a).cross(c - a).dot(centre - a) > 0.0;
        assert_eq!(inwards, face.side == Side::Front);
        backs += usize::from(face.side == Side::Back);
    }
    assert!(backs > 3);
}

#[test]
fn damage_is_named() {
    let (scene, solution) = solved_room();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("solution.ply");
    write_ply(&path, &SolvedMesh::new(&scene, &solution), &GO).unwrap();
    let whole = fs::read(&path).unwrap();
    let reason = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        match read_ply(&path).unwrap_err() {
            OutputError::Malformed { reason, .. } => reason,
            other => panic!("{other}"),
        }
    };
    // Every length that a stopped copy could leave.
    for length in (0..whole.len()).step_by(97).chain([whole.len() - 1]) {
        reason(&whole[..length]);
    }
    assert!(reason(&whole[..whole.len() - 1]).contains("ends early"));
    assert!(reason(&[&whole[..], b"x"].concat()).contains("follow its end"));
    assert!(reason(b"v 0 0 0\nf 1 1 1\n").contains("begin with"));
    assert!(reason(b"ply\nformat ascii 1.0\nend_header\n").contains("ascii"));

    let head = "ply\nformat binary_little_endian 1.0\n";
    let with = |rest: &str| reason(format!("{head}{rest}end_header\n").as_bytes());
    assert!(with("").contains("no element"));
    assert!(with("element vertex 9999999999999999\n").contains("ends early"));
    assert!(with("element vertex -1\n").contains("count"));
    assert!(with("element vertex 0\nproperty float x\n").contains("\"y\""));
    assert!(with("element vertex 0\nproperty quad x\n").contains("quad"));
    assert!(with("property float x\n").contains("before the first element"));

    let text = String::from_utf8_lossy(&whole).into_owned();
    let end = text.find("end_header\n").unwrap() + "end_header\n".len();
    let edit = |from: &str, to: &str| {
        let header = text[..end].replacen(from, to, 1);
        reason(&[header.as_bytes(), &whole[end..]].concat())
    };
    assert!(edit("source_face", "face_of_obj").contains("source_face"));
    assert!(edit("property float radiosity_r\n", "").contains("radiosity_r"));

    let mut far = whole.clone();
    let last_face = whole.len() - (1 + 12 + 4 + 1 + 24);
    far[last_face + 1..last_face + 5].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(reason(&far).contains("whole number"));
    far[last_face + 1..last_face + 5].copy_from_slice(&i32::MAX.to_le_bytes());
    assert!(reason(&far).contains("beyond"));
    let mut nan = whole.clone();
    let end = nan.len();
    nan[end - 4..].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(reason(&nan).contains("not finite"));
}

#[test]
fn added_columns_and_elements_are_passed_over() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("solution.ply");
    let mut bytes = b"ply\r\nformat binary_little_endian 1.0\r\n\
        element vertex 3\r\nproperty uchar alpha\r\nproperty float z\r\nproperty float x\r\nproperty float y\r\n\
        element note 1\r\nproperty list uchar short words\r\n\
        element face 1\r\nproperty short weight\r\nproperty list uchar int vertex_indices\r\n\
        property uchar side\r\nproperty uint source_face\r\n"
        .to_vec();
    for name in ["irradiance", "radiosity"] {
        for channel in ["r", "g", "b"] {
            bytes.extend(format!("property double {name}_{channel}\r\n").bytes());
        }
    }
    bytes.extend(b"end_header\r\n");
    for corner in [[0.0f32, 1.0, 2.0], [0.0, 3.0, 2.0], [5.0, 1.0, 2.0]] {
        bytes.push(9);
        bytes.extend(corner.iter().flat_map(|x| x.to_le_bytes()));
    }
    bytes.extend([2, 1, 0, 2, 0]);
    bytes.extend([7, 0, 3]);
    bytes.extend([0u32, 1, 2].iter().flat_map(|x| x.to_le_bytes()));
    bytes.push(1);
    bytes.extend(41u32.to_le_bytes());
    bytes.extend((1..=6).flat_map(|x| f64::from(x).to_le_bytes()));
    fs::write(&path, &bytes).unwrap();
    let mesh = read_ply(&path).unwrap();
    assert_eq!(mesh.vertices[0], DVec3::new(1.0, 2.0, 0.0));
    let face = mesh.faces[0];
    assert_eq!((face.side, face.source_face), (Side::Back, 41));
    assert_eq!(face.irradiance, [1.0, 2.0, 3.0]);
    assert_eq!(face.radiosity, [4.0, 5.0, 6.0]);
}

#[test]
fn a_missing_file_is_an_io_error_with_its_name() {
    let error = read_ply(Path::new("no/such/solution.ply")).unwrap_err();
    assert!(matches!(error, OutputError::Io { .. }));
    assert!(error.to_string().contains("no/such/solution.ply"));
}
