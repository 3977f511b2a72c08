//! Gathered irradiance against closed forms.

use super::fixture::{self, box_corners, box_triangles, grey};
use super::{Camera, Picture, SolvedMesh, View, ViewConfig};
use crate::embree::{Device, DeviceConfig};
use crate::reference::point_to_parallel_rectangle;
use crate::scene::{Facet, Scene, Side, Surface};
use glam::{DVec2, DVec3};
use std::f32::consts::PI;
use std::sync::atomic::AtomicBool;

static GO: AtomicBool = AtomicBool::new(false);

fn picture(mesh: &SolvedMesh, camera: &Camera, gather: u32) -> Picture {
    let device = Device::new(&DeviceConfig::default()).unwrap();
    let config = ViewConfig {
        gather,
        ..ViewConfig::default()
    };
    View::new(mesh, &device)
        .unwrap()
        .render(&camera.pin_hole().unwrap(), &config, &GO)
        .unwrap()
}

/// A floor of 8 x 8 at z = 0, a lamp of 1 x 1 at z = 2 above its middle that shines down, and, if
/// asked, a screen half-way that hides half of the lamp from the floor's middle.
fn floor_and_lamp(screen: bool) -> Scene {
    let square = |x0: f64, x1: f64, half: f64, z: f64| {
        [
            DVec3::new(x0, -half, z),
            DVec3::new(x1, -half, z),
            DVec3::new(x1, half, z),
            DVec3::new(x0, half, z),
        ]
    };
    let mut positions = square(-4.0, 4.0, 4.0, 0.0).to_vec();
    positions.extend(square(-0.5, 0.5, 0.5, 2.0));
    let mut triangles = vec![([0, 1, 2], 0, 0), ([0, 2, 3], 0, 0)];
    triangles.extend([([4, 6, 5], 1, 1), ([4, 7, 6], 1, 1)]);
    if screen {
        positions.extend(square(0.0, 3.0, 3.0, 1.0));
        triangles.extend([([8, 9, 10], 2, 2), ([8, 10, 11], 2, 2)]);
    }
    // In units of the lamp's radiance, so that its radiosity is pi.
    fixture::scene(
        positions,
        &triangles,
        vec![grey(0.5, 0.0), grey(0.0, 1.0), grey(0.0, 0.0)],
    )
}

/// The direct solution of [`floor_and_lamp`] with a value that is wrong everywhere on the floor: what
/// is gathered must not depend on it.
fn solved(scene: &Scene) -> SolvedMesh {
    let emits = |facet: Facet| scene.emission(facet)[0] > 0.0;
    let solution = fixture::solve(scene, fixture::fronts(scene), 3, |facet, [a, ..]| {
        if emits(facet) {
            (PI, 0.0)
        } else if scene.surface(facet.polygon).reflectance[0] > 0.0 {
            let wrong = 1.0 + a.x;
            (0.5 * wrong, wrong)
        } else {
            (0.0, 1.0)
        }
    });
    let mut mesh = SolvedMesh::new(scene, &solution);
    // The fixture darkens green and blue; here all is grey.
    for face in &mut mesh.faces {
        face.radiosity = [face.radiosity[0]; 3];
    }
    mesh
}

/// Looks down at the floor from below the lamp and the screen.
fn camera() -> Camera {
    Camera {
        eye: DVec3::new(0.0, 0.0, 0.9),
        target: DVec3::ZERO,
        up: DVec3::Y,
        fov: 90.0,
        size: [9, 9],
    }
}

/// Irradiance at a point of the floor under the part of the lamp with x from `x0` to `x1`.
fn under(x0: f64, x1: f64, at: DVec2) -> f64 {
    let corner = |x: f64, y: f64| {
        let (dx, dy) = (x - at.x, y - at.y);
        let sign = dx.signum() * dy.signum();
        sign * point_to_parallel_rectangle(dx.abs(), dy.abs(), 2.0)
    };
    let whole = corner(x1, 0.5) - corner(x0, 0.5) - corner(x1, -0.5) + corner(x0, -0.5);
    f64::from(PI) * whole
}

#[test]
fn light_of_a_lamp_is_the_closed_form() {
    let scene = floor_and_lamp(false);
    let picture = picture(&solved(&scene), &camera(), 1024);
    let mut mean = 0.0;
    for (i, pixel) in picture.pixels.iter().enumerate() {
        let [x, y] = [i % 9, i / 9].map(|k| (k as f64 - 4.0) * 0.2);
        // A pixel is 0.2 wide; across that the light is all but linear.
        let expected = under(-0.5, 0.5, DVec2::new(x, -y)) as f32;
        let off = pixel.irradiance[0] / expected - 1.0;
        assert!(off.abs() < 0.01, "pixel {i}: {pixel:?} for {expected}");
        mean += off / 81.0;
        // The floor's reflectance is 0.5, whatever the solution says of its light.
        assert!((pixel.radiance[0] * PI / pixel.irradiance[0] - 0.5).abs() < 1e-4);
    }
    assert!(mean.abs() < 2e-3, "on average {mean}");
}

#[test]
fn what_stands_between_casts_its_shadow_within_a_patch() {
    let scene = floor_and_lamp(true);
    let picture = picture(&solved(&scene), &camera(), 4096);
    let middle = picture.pixels[4 * 9 + 4].irradiance[0];
    // At the middle of the floor the screen's edge covers the lamp's half x > 0.
    let expected = under(-0.5, 0.0, DVec2::ZERO) as f32;
    assert!(
        (middle / expected - 1.0).abs() < 0.02,
        "{middle} for {expected}"
    );
    // At x = 0.8 the edge hides the lamp up to x = -0.8; the screen itself is black.
    let right = picture.pixels[4 * 9 + 8].irradiance[0];
    assert!(right < 0.01 * middle, "{right}");
}

/// In a closed room where every wall sends out the same, that is what arrives everywhere, in corners
/// too, whether it is emitted or reflected.
#[test]
fn a_furnace_stays_a_furnace() {
    let corner = DVec3::new(500.3, -20.7, 80.1);
    let least = corner;
    let greatest = corner + DVec3::new(3.0, 4.0, 2.0);
    let walls: Vec<_> = (box_triangles(0).into_iter())
        .map(|(v, f, _)| (v, f, u32::from(f % 2 == 0)))
        .collect();
    let surfaces: Vec<Surface> = vec![grey(0.5, 1.0), grey(0.25, 1.5)];
    let scene = fixture::scene(box_corners(least, greatest), &walls, surfaces);
    let solution = fixture::solve(&scene, fixture::fronts(&scene), 3, |_, _| {
        (2.0 * PI, 2.0 * PI)
    });
    let mut mesh = SolvedMesh::new(&scene, &solution);
    for face in &mut mesh.faces {
        face.radiosity = [2.0 * PI; 3];
    }
    let camera = Camera {
        eye: corner + DVec3::new(1.0, 2.0, 1.0),
        target: corner + DVec3::new(3.0, 2.0, 0.3),
        up: DVec3::Z,
        fov: 110.0,
        size: [12, 9],
    };
    let picture = picture(&mesh, &camera, 256);
    for pixel in &picture.pixels {
        assert_eq!(pixel.alpha, 1.0);
        let off = pixel.irradiance[0] / (2.0 * PI) - 1.0;
        assert!(off.abs() < 0.02, "{pixel:?}");
    }
}

#[test]
fn every_thread_count_gathers_the_same() {
    let scene = floor_and_lamp(true);
    let mesh = solved(&scene);
    let pictures = [1, 3].map(|threads| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap()
            .install(|| picture(&mesh, &camera(), 16))
    });
    assert!(pictures[0] == pictures[1]);
    let lit = |p: &Picture| p.pixels.iter().any(|pixel| pixel.irradiance[0] > 0.0);
    assert!(lit(&pictures[0]));
}

#[test]
fn a_face_without_a_lit_side_stays_black() {
    let scene = floor_and_lamp(false);
    let lamp_only: Vec<Facet> = (fixture::fronts(&scene).into_iter())
        .filter(|f| f.side == Side::Front && scene.emission(*f)[0] > 0.0)
        .collect();
    let solution = fixture::solve(&scene, lamp_only, 0, |_, _| (PI, 0.0));
    let mesh = SolvedMesh::new(&scene, &solution);
    let picture = picture(&mesh, &camera(), 8);
    for pixel in &picture.pixels {
        assert_eq!((pixel.radiance, pixel.alpha), ([0.0; 3], 1.0));
    }
}
