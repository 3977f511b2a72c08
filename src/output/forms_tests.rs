//! `solution.glb` and `solution.vtu`, read back.

use super::{SolvedMesh, UpAxis, fixture, write_glb, write_vtu};
use crate::scene::{Facet, Side};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use glam::{DVec3, Vec3};
use std::path::Path;
use std::sync::atomic::AtomicBool;

static GO: AtomicBool = AtomicBool::new(false);

/// A room far from the origin, split at random, brighter towards +x, with a lit back.
fn mesh() -> SolvedMesh {
    let corner = DVec3::new(500.25, -20.5, 80.0);
    let scene = fixture::room(
        corner,
        corner + DVec3::new(3.0, 4.0, 2.0),
        fixture::grey(0.5, 0.0),
    );
    let mut facets = fixture::fronts(&scene);
    facets.push(Facet {
        polygon: crate::math::PolygonId(2),
        side: Side::Back,
    });
    let solution = fixture::solve(&scene, facets, 4, |_, [a, b, c]| {
        let e = 2.0 + (a.x + b.x + c.x) / 3.0;
        (0.5 * e, e)
    });
    SolvedMesh::new(&scene, &solution)
}

fn written(write: impl FnOnce(&Path)) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("solution");
    write(&path);
    std::fs::read(path).unwrap()
}

/// The corners of the triangles in a GLB, where its node puts them.
fn corners_of_glb(bytes: &[u8]) -> Vec<Vec3> {
    let file = gltf::Gltf::from_slice(bytes).unwrap();
    let blob = file.blob.as_deref().unwrap();
    let node = file.default_scene().unwrap().nodes().next().unwrap();
    let (translation, rotation, scale) = node.transform().decomposed();
    assert_eq!((rotation, scale), ([0.0, 0.0, 0.0, 1.0], [1.0; 3]));
    let primitive = node.mesh().unwrap().primitives().next().unwrap();
    let reader = primitive.reader(|_| Some(blob));
    let positions: Vec<Vec3> = (reader.read_positions().unwrap())
        .map(|p| Vec3::from_array(p) + Vec3::from_array(translation))
        .collect();
    (reader.read_indices().unwrap().into_u32())
        .map(|i| positions[i as usize])
        .collect()
}

#[test]
fn what_is_up_is_up_in_the_glb() {
    let mesh = mesh();
    let expected: Vec<DVec3> = mesh.faces.iter().flat_map(|f| mesh.corners(f)).collect();
    type Turn = fn(DVec3) -> DVec3;
    let turns: [(UpAxis, Turn); 2] = [
        (UpAxis::Z, |p| DVec3::new(p.x, p.z, -p.y)),
        (UpAxis::X, |p| DVec3::new(-p.y, p.x, p.z)),
    ];
    for (up, turn) in turns {
        let found = corners_of_glb(&written(|path| write_glb(path, &mesh, up, &GO).unwrap()));
        assert_eq!(found.len(), expected.len());
        for (&found, &expected) in found.iter().zip(&expected) {
            let off = (found - turn(expected).as_vec3()).length();
            assert!(off < 1e-3, "{up:?}: {off}");
        }
    }
}

#[test]
fn another_reader_finds_every_triangle_in_the_glb() {
    let mesh = mesh();
    let bytes = written(|path| write_glb(path, &mesh, UpAxis::Y, &GO).unwrap());
    assert_eq!(bytes.len() % 4, 0);
    // The reader refuses what is not valid glTF.
    let file = gltf::Gltf::from_slice(&bytes).unwrap();
    let blob = file.blob.as_deref().unwrap();
    let node = file.default_scene().unwrap().nodes().next().unwrap();
    let (translation, ..) = node.transform().decomposed();
    let primitive = node.mesh().unwrap().primitives().next().unwrap();
    assert!(primitive.material().unlit());
    let reader = primitive.reader(|_| Some(blob));
    let positions: Vec<Vec3> = (reader.read_positions().unwrap())
        .map(|p| Vec3::from_array(p) + Vec3::from_array(translation))
        .collect();
    let colours: Vec<[f32; 4]> = (reader.read_colors(0).unwrap()).into_rgba_f32().collect();
    let indices: Vec<u32> = reader.read_indices().unwrap().into_u32().collect();
    assert_eq!(positions.len(), colours.len());
    assert_eq!(indices.len(), 3 * mesh.faces.len());
    for (triangle, face) in indices.chunks(3).zip(&mesh.faces) {
        for (&i, corner) in triangle.iter().zip(mesh.corners(face)) {
            let off = (positions[i as usize] - corner.as_vec3()).length();
            assert!(off < 1e-3, "{off}");
        }
    }
    // Brightness grows along x, on every face.
    let [dark, bright] = [0.2f32, 2.8].map(|x| {
        let near = |p: &Vec3| (p.x - 500.25 - x).abs() < 0.25;
        let greys: Vec<f32> = (positions.iter().zip(&colours))
            .filter(|(p, _)| near(p))
            .map(|(_, c)| c[0])
            .collect();
        assert!(greys.len() > 5);
        greys.iter().sum::<f32>() / greys.len() as f32
    });
    assert!(bright > 1.2 * dark, "{dark} to {bright}");
    assert!(
        colours
            .iter()
            .all(|c| c[3] == 1.0 && c[0] > c[1] && c[1] > c[2])
    );
    // The smallest and greatest that the document promises are those of the data.
    let bounds = primitive.bounding_box();
    let least = positions.iter().fold(Vec3::INFINITY, |l, &p| l.min(p));
    let promised = Vec3::from_array(bounds.min) + Vec3::from_array(translation);
    assert!((least - promised).length() < 1e-3);
}

#[test]
fn a_mesh_of_nothing_is_still_a_document() {
    let bytes = written(|path| write_glb(path, &SolvedMesh::default(), UpAxis::Y, &GO).unwrap());
    let file = gltf::Gltf::from_slice(&bytes).unwrap();
    assert_eq!(file.meshes().count(), 0);
    let text = written(|path| write_vtu(path, &SolvedMesh::default(), &GO).unwrap());
    roxmltree::Document::parse(std::str::from_utf8(&text).unwrap()).unwrap();
}

#[test]
fn the_vtu_holds_every_number() {
    let mesh = mesh();
    let text = written(|path| write_vtu(path, &mesh, &GO).unwrap());
    let document = roxmltree::Document::parse(std::str::from_utf8(&text).unwrap()).unwrap();
    let piece = (document.descendants())
        .find(|n| n.has_tag_name("Piece"))
        .unwrap();
    let count = |name| piece.attribute(name).unwrap().parse::<usize>().unwrap();
    assert_eq!(count("NumberOfPoints"), mesh.vertices.len());
    assert_eq!(count("NumberOfCells"), mesh.faces.len());
    let array = |name: &str| -> Vec<u8> {
        let node = (document.descendants())
            .find(|n| n.has_tag_name("DataArray") && n.attribute("Name") == Some(name))
            .unwrap();
        let bytes = STANDARD.decode(node.text().unwrap().trim()).unwrap();
        let (length, data) = bytes.split_first_chunk::<8>().unwrap();
        assert_eq!(u64::from_le_bytes(*length), data.len() as u64, "{name}");
        data.to_vec()
    };
    let points: Vec<u8> = (mesh.vertices.iter())
        .flat_map(|v| v.to_array())
        .flat_map(f64::to_le_bytes)
        .collect();
    assert!(array("Points") == points);
    let corners: Vec<u8> = (mesh.faces.iter())
        .flat_map(|f| f.vertices)
        .flat_map(|v| i64::from(v).to_le_bytes())
        .collect();
    assert!(array("connectivity") == corners);
    let ends: Vec<u8> = (1..=mesh.faces.len() as i64)
        .flat_map(|i| (3 * i).to_le_bytes())
        .collect();
    assert!(array("offsets") == ends);
    assert!(array("types") == vec![5; mesh.faces.len()]);
    let floats = |of: fn(&super::SolvedFace) -> [f32; 3]| -> Vec<u8> {
        (mesh.faces.iter().flat_map(of))
            .flat_map(f32::to_le_bytes)
            .collect()
    };
    assert!(array("radiosity") == floats(|f| f.radiosity));
    assert!(array("irradiance") == floats(|f| f.irradiance));
    let faces: Vec<u8> = (mesh.faces.iter())
        .flat_map(|f| f.source_face.to_le_bytes())
        .collect();
    assert!(array("source_face") == faces);
    let sides = array("side");
    assert!(
        sides
            .iter()
            .zip(&mesh.faces)
            .all(|(&s, f)| s == f.side as u8)
    );
    assert!(sides.contains(&0) && sides.contains(&1));
}
