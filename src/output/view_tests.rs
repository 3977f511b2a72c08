//! Pictures of scenes whose every pixel is known.

use super::{
    Camera, Picture, Pixel, Shading, SolvedMesh, ToneMap, View, ViewConfig, fixture, write_exr,
    write_png,
};
use crate::embree::{Device, DeviceConfig};
use crate::math::PolygonId;
use crate::scene::{Facet, Scene, Side};
use glam::DVec3;
use std::f32::consts::PI;
use std::fs::File;
use std::sync::atomic::AtomicBool;

static GO: AtomicBool = AtomicBool::new(false);

fn device() -> Device {
    Device::new(&DeviceConfig::default()).unwrap()
}

/// A room far from the origin, 3 x 4 x 2, and a camera in its middle that looks along +x.
fn room() -> (Scene, Camera) {
    let corner = DVec3::new(500.3, -20.7, 80.1);
    let scene = fixture::room(
        corner,
        corner + DVec3::new(3.0, 4.0, 2.0),
        fixture::grey(0.5, 0.1),
    );
    let camera = Camera {
        eye: corner + DVec3::new(1.0, 2.0, 1.0),
        target: corner + DVec3::new(3.0, 2.0, 1.0),
        up: DVec3::Z,
        fov: 100.0,
        size: [97, 61],
    };
    (scene, camera)
}

fn picture(mesh: &SolvedMesh, camera: &Camera, shading: Shading) -> Picture {
    let config = ViewConfig {
        shading,
        ..ViewConfig::default()
    };
    View::new(mesh, &device())
        .unwrap()
        .render(&camera.pin_hole().unwrap(), &config, &GO)
        .unwrap()
}

fn at(picture: &Picture, x: u32, y: u32) -> Pixel {
    picture.pixels[(y * picture.size[0] + x) as usize]
}

#[test]
fn a_uniform_room_is_its_radiosity_over_pi_everywhere() {
    let (scene, camera) = room();
    let solution = fixture::solve(&scene, fixture::fronts(&scene), 5, |_, _| (6.0, 2.0));
    let mesh = SolvedMesh::new(&scene, &solution);
    for shading in [Shading::Smooth, Shading::Flat] {
        let picture = picture(&mesh, &camera, shading);
        for pixel in &picture.pixels {
            assert_eq!(pixel.alpha, 1.0);
            for (c, b) in [6.0, 3.0, 1.5].into_iter().enumerate() {
                assert!((pixel.radiance[c] * PI / b - 1.0).abs() < 1e-5, "{pixel:?}");
                assert!((pixel.irradiance[c] / 2.0 - 1.0).abs() < 1e-5);
            }
        }
        let middle = at(&picture, 48, 30);
        assert!((middle.depth - 2.0).abs() < 1e-4, "{}", middle.depth);
        assert_eq!(middle.face, 1.0);
        assert_eq!(middle.normal, [-1.0, 0.0, 0.0]);
        // Up is +z, so the top shows the ceiling (face 5), the bottom the floor (face 4); looking
        // along +x the left is +y (face 3).
        assert_eq!(at(&picture, 48, 0).face, 5.0);
        assert_eq!(at(&picture, 48, 60).face, 4.0);
        assert_eq!(at(&picture, 0, 30).face, 3.0);
    }
}

#[test]
fn every_thread_count_gives_the_same_picture() {
    let (scene, camera) = room();
    let solution = fixture::solve(&scene, fixture::fronts(&scene), 5, |_, [a, ..]| {
        (1.0 + a.x, 1.0 + a.y)
    });
    let mesh = SolvedMesh::new(&scene, &solution);
    let pictures = [1, 3].map(|threads| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap()
            .install(|| picture(&mesh, &camera, Shading::Smooth))
    });
    assert!(pictures[0] == pictures[1]);
}

#[test]
fn a_back_without_a_side_is_black_and_beyond_the_scene_is_nothing() {
    let (scene, mut camera) = room();
    let mut facets = fixture::fronts(&scene);
    // The wall +x (polygons 2 and 3) has a bright outside; the others have none.
    facets.extend([2, 3].map(|p| Facet {
        polygon: PolygonId(p),
        side: Side::Back,
    }));
    let solution = fixture::solve(&scene, facets, 4, |facet, _| match facet.side {
        Side::Front => (1.0, 1.0),
        Side::Back => (9.0, 1.0),
    });
    let mesh = SolvedMesh::new(&scene, &solution);
    let centre = camera.eye;
    camera.target = centre;
    camera.fov = 60.0;
    for (towards, expected) in [(DVec3::X, 9.0 / PI), (-DVec3::X, 0.0), (DVec3::Y, 0.0)] {
        camera.eye = centre + 20.0 * towards;
        let picture = picture(&mesh, &camera, Shading::Smooth);
        let middle = at(&picture, 48, 30);
        assert_eq!(middle.alpha, 1.0);
        assert!((middle.radiance[0] - expected).abs() < 1e-5, "{middle:?}");
        assert_eq!(middle.normal, towards.as_vec3().to_array());
        assert_eq!(at(&picture, 0, 0), Pixel::BACKGROUND);
        assert!(
            picture
                .pixels
                .iter()
                .any(|p| p.alpha > 0.0 && p.alpha < 1.0)
        );
    }
}

#[test]
fn flat_shading_shows_the_patch_under_each_pixel() {
    let (scene, camera) = room();
    let value = |corners: [glam::Vec3; 3]| {
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        2.0 + middle.y
    };
    let solution = fixture::solve(&scene, fixture::fronts(&scene), 4, |_, corners| {
        (value(corners), 1.0)
    });
    let mesh = SolvedMesh::new(&scene, &solution);
    let view = View::new(&mesh, &device()).unwrap();
    let config = ViewConfig {
        shading: Shading::Flat,
        samples_a_side: 1,
        gather: 0,
    };
    let pin_hole = camera.pin_hole().unwrap();
    let picture = view.render(&pin_hole, &config, &GO).unwrap();
    for (i, pixel) in picture.pixels.iter().enumerate() {
        let (x, y) = (i as u32 % picture.size[0], i as u32 / picture.size[0]);
        let direction =
            pin_hole.direction(glam::DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5));
        let seen = pin_hole.eye() + direction * f64::from(pixel.depth);
        // The brute-force answer: the patches of that face that hold the point, up to rounding.
        let matches = mesh.faces.iter().any(|face| {
            let [a, b, c] = mesh.corners(face);
            let area = (b - a).cross(c - a);
            let inside = [(a, b), (b, c), (c, a)]
                .iter()
                .all(|&(p, q)| (q - p).cross(seen - p).dot(area) >= -1e-5 * area.length_squared());
            face.source_face as f32 == pixel.face
                && inside
                && (face.radiosity[0] / PI - pixel.radiance[0]).abs() < 1e-5
        });
        assert!(matches, "pixel {x}, {y}: {pixel:?}");
    }
}

#[test]
fn a_mesh_read_back_gives_the_same_picture() {
    let (scene, camera) = room();
    let solution = fixture::solve(&scene, fixture::fronts(&scene), 5, |_, [a, ..]| {
        (1.0 + a.x, 1.0 + a.y)
    });
    let mesh = SolvedMesh::new(&scene, &solution);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("solution.ply");
    super::write_ply(&path, &mesh, &GO).unwrap();
    let back = super::read_ply(&path).unwrap();
    let [a, b] = [&mesh, &back].map(|mesh| picture(mesh, &camera, Shading::Smooth));
    assert!(a == b);
}

#[test]
fn the_exr_holds_every_layer() {
    use exr::prelude::*;
    let (scene, mut camera) = room();
    camera.eye += DVec3::new(30.0, 0.0, 0.0);
    camera.target = camera.eye - DVec3::X;
    camera.fov = 20.0;
    let mut facets = fixture::fronts(&scene);
    facets.extend([2, 3].map(|p| Facet {
        polygon: PolygonId(p),
        side: Side::Back,
    }));
    let solution = fixture::solve(&scene, facets, 4, |_, [a, ..]| (2.0 + a.y, 1.0 + a.z));
    let mesh = SolvedMesh::new(&scene, &solution);
    let picture = picture(&mesh, &camera, Shading::Smooth);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("view.exr");
    write_exr(&path, &picture, &GO).unwrap();

    let image = read_first_flat_layer_from_file(&path).unwrap();
    let layer = &image.layer_data;
    assert_eq!(layer.size, Vec2(97, 61));
    let channel = |name: &str| -> Vec<f32> {
        let found: Vec<_> = (layer.channel_data.list.iter())
            .filter(|c| c.name.to_string() == name)
            .collect();
        assert_eq!(found.len(), 1, "{name}");
        found[0].sample_data.values_as_f32().collect()
    };
    assert_eq!(layer.channel_data.list.len(), 12);
    let check = |name: &str, of: fn(&Pixel) -> f32| {
        let expected: Vec<f32> = picture.pixels.iter().map(of).collect();
        assert!(channel(name) == expected, "{name}");
        assert!(expected.iter().all(|x| x.is_finite()), "{name}");
    };
    check("R", |p| p.radiance[0]);
    check("G", |p| p.radiance[1]);
    check("B", |p| p.radiance[2]);
    check("A", |p| p.alpha);
    check("irradiance.R", |p| p.irradiance[0]);
    check("irradiance.B", |p| p.irradiance[2]);
    check("normal.X", |p| p.normal[0]);
    check("normal.Z", |p| p.normal[2]);
    check("depth.Z", |p| p.depth);
    check("face.ID", |p| p.face);
    assert!(channel("A").contains(&0.0) && channel("A").contains(&1.0));
}

#[test]
fn the_png_holds_the_tone_mapped_picture() {
    let mut picture = Picture {
        size: [2, 1],
        pixels: vec![Pixel::BACKGROUND; 2],
    };
    picture.pixels[1] = Pixel {
        radiance: [0.1, 0.2, 0.05],
        alpha: 0.5,
        ..Pixel::BACKGROUND
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("view.png");
    let tone_map = ToneMap::with_scale(2.0);
    write_png(&path, &picture, tone_map, &GO).unwrap();
    let decoder = png::Decoder::new(std::io::BufReader::new(File::open(&path).unwrap()));
    let mut reader = decoder.read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!((info.width, info.height), (2, 1));
    let [r, g, b] = tone_map.encode([0.2, 0.4, 0.1]);
    assert_eq!(bytes, [0, 0, 0, 0, r, g, b, 128]);
}

#[test]
fn an_interrupted_picture_is_none() {
    let (scene, camera) = room();
    let solution = fixture::solve(&scene, fixture::fronts(&scene), 1, |_, _| (1.0, 1.0));
    let mesh = SolvedMesh::new(&scene, &solution);
    let view = View::new(&mesh, &device()).unwrap();
    let stop = AtomicBool::new(true);
    let picture = view.render(&camera.pin_hole().unwrap(), &ViewConfig::default(), &stop);
    assert!(picture.is_none());
}
