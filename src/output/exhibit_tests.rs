//! Pictures of `--show` whose pixels are known.

use super::fixture::{self, grey};
use super::{
    Camera, Canvas, ColourScale, Exhibit, PinHole, SolvedMesh, Spread, ToneMap, View, ViewConfig,
};
use crate::cluster::{ClusterConfig, build_hierarchy};
use crate::embree::{Device, DeviceConfig};
use crate::math::NodeId;
use crate::occluder::{Occluder, OccluderSet, SlabRectangle};
use crate::scene::Scene;
use glam::{DVec3, Vec3};
use std::sync::atomic::AtomicBool;

static GO: AtomicBool = AtomicBool::new(false);

/// Two unit squares side by side in the plane z = 0, two triangles each: faces 0 and 1.
fn squares() -> Scene {
    let corner = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let positions = vec![
        corner(0.0, 0.0),
        corner(1.0, 0.0),
        corner(2.0, 0.0),
        corner(0.0, 1.0),
        corner(1.0, 1.0),
        corner(2.0, 1.0),
    ];
    let triangles = [
        ([0, 1, 4], 0, 0),
        ([0, 4, 3], 0, 0),
        ([1, 2, 5], 1, 0),
        ([1, 5, 4], 1, 0),
    ];
    fixture::scene(positions, &triangles, vec![grey(0.5, 0.0)])
}

fn mesh(scene: &Scene) -> SolvedMesh {
    let solution = fixture::solve(scene, fixture::fronts(scene), 0, |_, _| (1.0, 2.0));
    SolvedMesh::new(scene, &solution)
}

/// Looks straight down on both squares, which fill the picture: 60 pixels are a unit.
fn camera() -> PinHole {
    Camera {
        eye: DVec3::new(1.0, 0.5, 0.5),
        target: DVec3::new(1.0, 0.5, 0.0),
        up: DVec3::Y,
        fov: 90.0,
        size: [120, 60],
    }
    .pin_hole()
    .unwrap()
}

fn at(canvas: &Canvas, x: usize, y: usize) -> [f32; 4] {
    canvas.pixels[y * 120 + x]
}

fn device() -> Device {
    Device::new(&DeviceConfig::default()).unwrap()
}

/// Makes `show` of the squares, `read` being asked for the canvas.
fn with(show: impl Fn(&Exhibit<'_>, &View<'_>) -> Canvas) -> Canvas {
    let scene = squares();
    let mesh = mesh(&scene);
    let view = View::new(&mesh, &device()).unwrap();
    let camera = camera();
    let exhibit = Exhibit {
        view: &view,
        camera: &camera,
        interrupted: &GO,
    };
    show(&exhibit, &view)
}

#[test]
fn a_number_is_its_colour_and_none_is_grey() {
    let scale = ColourScale::new("x", "", Spread::Linear, [(1.0, 1.0)].into_iter(), Some(4.0));
    let values = [Some(1.0), Some(1.0), None, Some(3.0)];
    let canvas = with(|exhibit, _| exhibit.values(&values, scale.clone()).unwrap().canvas);
    let close = |[r, g, b, a]: [f32; 4], colour: [f32; 3]| {
        a == 1.0
            && [r, g, b]
                .iter()
                .zip(colour)
                .all(|(x, y)| (x - y).abs() < 1e-6)
    };
    // Face 0 is 1; of face 1 the triangle below the diagonal is unknown, the one above is 3.
    assert!(close(at(&canvas, 15, 30), scale.colour(1.0)));
    assert!(close(at(&canvas, 45, 30), scale.colour(1.0)));
    assert!(close(at(&canvas, 75, 20), scale.colour(3.0)));
    let [r, g, b, _] = at(&canvas, 105, 40);
    assert!(r == g && g == b);
}

#[test]
fn the_mesh_is_drawn_along_edges_only() {
    let canvas = with(|exhibit, view| {
        let picture = view
            .render(exhibit.camera, &ViewConfig::default(), &GO)
            .unwrap();
        let tone_map = ToneMap::with_scale(1.0);
        exhibit.mesh(&picture, tone_map).unwrap().canvas
    });
    let ground = at(&canvas, 40, 10);
    for (x, y) in [(10, 20), (50, 50), (70, 20), (110, 50)] {
        assert_eq!(at(&canvas, x, y), ground, "inside a patch at {x}, {y}");
    }
    // The edge between the squares stands between pixels 59 and 60; the diagonals run through (x, 59 - x).
    for (x, y) in [(59, 20), (60, 50), (20, 39), (80, 39)] {
        assert_ne!(at(&canvas, x, y), ground, "on an edge at {x}, {y}");
    }
}

#[test]
fn clusters_have_one_colour_each() {
    let scene = squares();
    let hierarchy = build_hierarchy(&scene, &fixture::fronts(&scene), &ClusterConfig::default());
    let of = |count: usize| {
        let mut clusters = 0;
        let canvas = with(|exhibit, _| {
            exhibit
                .clusters(&scene, &hierarchy, count)
                .unwrap()
                .0
                .canvas
        });
        let mut seen: Vec<[u32; 3]> = Vec::new();
        // A place in each triangle, all seen under the same angle.
        for (x, y) in [(36, 48), (36, 11), (83, 48), (83, 11)] {
            let [r, g, b, _] = at(&canvas, x, y);
            let colour = [r, g, b].map(|c| (c * 1000.0).round() as u32);
            if !seen.contains(&colour) {
                seen.push(colour);
                clusters += 1;
            }
        }
        clusters
    };
    assert_eq!(of(1), 1);
    assert_eq!(of(2), 2);
    assert_eq!(of(4), 4);
}

#[test]
fn occluders_lie_over_what_is_before_and_behind_nothing() {
    let scene = squares();
    // The left square's right half, and a sheet behind the right square.
    let sheet = |x: f32, z: f32| {
        let place = |x: f32, y: f32| {
            let file = DVec3::new(f64::from(x), f64::from(y), f64::from(z));
            scene.normalisation.to_normalised(file)
        };
        let (a, b) = (place(x, 0.0), place(x + 0.5, 1.0));
        let half = 0.5 * (b - a);
        let slab = SlabRectangle::new(
            0.5 * (a + b),
            Vec3::X * half.x,
            Vec3::Y * half.y,
            Vec3::Z,
            1.0e-6,
        );
        Occluder {
            slab,
            node: NodeId(0),
        }
    };
    let set = OccluderSet {
        occluders: vec![sheet(0.5, 0.0), sheet(1.5, -0.2)],
        ..OccluderSet::default()
    };
    let canvas = with(|exhibit, view| {
        let picture = view
            .render(exhibit.camera, &ViewConfig::default(), &GO)
            .unwrap();
        let tone_map = ToneMap::with_scale(1.0);
        exhibit
            .occluders(&picture, tone_map, &scene, &set, &device())
            .unwrap()
            .unwrap()
            .canvas
    });
    let is_grey = |[r, g, b, _]: [f32; 4]| r == g && g == b;
    assert!(!is_grey(at(&canvas, 45, 30)), "no occluder where one is");
    assert!(is_grey(at(&canvas, 15, 30)), "an occluder where none is");
    assert!(
        is_grey(at(&canvas, 105, 30)),
        "an occluder seen through a wall"
    );
}

#[test]
fn irradiance_has_the_colour_of_its_mean() {
    let canvas = with(|exhibit, view| {
        let picture = view
            .render(exhibit.camera, &ViewConfig::default(), &GO)
            .unwrap();
        let shown = exhibit.irradiance(&picture, Some(4.0));
        let scale = shown.scale.unwrap();
        assert_eq!(scale.range, [0.0, 4.0]);
        let [r, g, b] = scale.colour(2.0);
        let [x, y, z, _] = at(&shown.canvas, 30, 20);
        for (a, b) in [(r, x), (g, y), (b, z)] {
            assert!((a - b).abs() < 1e-4);
        }
        shown.canvas
    });
    assert_eq!(canvas.size, [120, 60]);
}
