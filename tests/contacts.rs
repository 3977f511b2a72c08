//! Where solids stand on surfaces, the surfaces are hidden; nowhere else.

use certilux::embree::DeviceConfig;
use certilux::math::PolygonId;
use certilux::scene::generate::generate;
use certilux::scene::{Facet, LoadConfig, Scene, Side, SidesMode, load_text};
use certilux::solve::{PreparedScene, Silent, SolveConfig, solve};
use glam::DVec3;
use std::fmt::Write;

fn builtin(name: &str) -> Scene {
    let text = generate(name).expect("a built-in scene");
    let library = format!("{name}.mtl");
    let files = [(library.as_str(), text.mtl.as_bytes())];
    load_text("case", text.obj.as_bytes(), &files, &LoadConfig::default()).expect("loads")
}

/// Points over the front of every polygon, in the file's units, with whether they are hidden.
fn front_points(scene: &Scene, per_edge: u32) -> Vec<(DVec3, PolygonId, bool)> {
    let mut points = Vec::new();
    for polygon in (0..scene.polygons.len()).map(PolygonId::new) {
        let [a, b, c] = scene.corners(polygon);
        let facet = Facet {
            polygon,
            side: Side::Front,
        };
        for i in 0..per_edge {
            for j in 0..per_edge - i {
                let (u, v) = (
                    (i as f32 + 0.3) / per_edge as f32,
                    (j as f32 + 0.3) / per_edge as f32,
                );
                let point = a + (b - a) * u + (c - a) * v;
                let hidden = scene.contacts.is_hidden(facet, point);
                points.push((
                    scene.normalisation.to_file(point.as_dvec3()),
                    polygon,
                    hidden,
                ));
            }
        }
    }
    points
}

#[test]
fn what_a_slab_stands_on_is_hidden() {
    let scene = builtin("sealed-slab");
    let mut counts = [0usize; 2];
    for (p, polygon, hidden) in front_points(&scene, 60) {
        // The slab's own faces to the two rooms are open; the rest between its planes is under it.
        let under = p.x > 5.0 + 1e-3 && p.x < 5.05 - 1e-3;
        let beside = p.x < 5.0 + 1e-4 || p.x > 5.05 - 1e-4;
        if under {
            counts[0] += 1;
            let slab = scene.polygons[polygon.index()].source_face >= 318;
            assert!(
                hidden || slab,
                "{p} of {:?}",
                scene.polygons[polygon.index()]
            );
        } else if beside {
            counts[1] += 1;
            assert!(!hidden, "{p}");
        }
    }
    assert!(counts.iter().all(|&n| n > 1000), "{counts:?}");
}

/// An OBJ of boxes `[min, max]`, seen from outside or (`inwards`) from inside, with a lamp far below.
fn boxes(list: &[([f64; 3], [f64; 3], bool)]) -> Scene {
    let mut obj = String::from(
        "mtllib m.mtl\nusemtl lamp\nv 0 0 -9\nv 1 0 -9\nv 0 1 -9\nf 1 2 3\nusemtl grey\n",
    );
    for (k, (min, max, inwards)) in list.iter().enumerate() {
        for i in 0..8 {
            let at = |axis: usize| {
                if i >> axis & 1 == 0 {
                    min[axis]
                } else {
                    max[axis]
                }
            };
            writeln!(obj, "v {} {} {}", at(0), at(1), at(2)).unwrap();
        }
        for face in [
            [0, 2, 3, 1],
            [4, 5, 7, 6],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 4, 6, 2],
            [1, 3, 7, 5],
        ] {
            obj += "f";
            for i in 0..4 {
                let corner: usize = face[if *inwards { 3 - i } else { i }];
                write!(obj, " {}", 4 + 8 * k + corner).unwrap();
            }
            obj += "\n";
        }
    }
    read(&obj)
}

fn read(obj: &str) -> Scene {
    let materials = b"newmtl grey\nKd .5 .5 .5\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n";
    load_text(
        "t.obj",
        obj.as_bytes(),
        &[("m.mtl", materials)],
        &LoadConfig::default(),
    )
    .expect("loads")
}

fn hidden_points(scene: &Scene) -> Vec<DVec3> {
    let points = front_points(scene, 20).into_iter();
    points.filter(|p| p.2).map(|p| p.0).collect()
}

#[test]
fn a_box_in_a_room_hides_the_floor_under_it() {
    let scene = boxes(&[
        ([0.0; 3], [4.0, 3.0, 2.0], true),
        ([1.0, 1.0, 0.0], [2.0, 2.5, 1.0], false),
    ]);
    let hidden = hidden_points(&scene);
    assert!(hidden.len() > 20);
    for p in hidden {
        assert!(
            p.z == 0.0 && p.x > 0.99 && p.x < 2.01 && p.y > 0.99 && p.y < 2.51,
            "{p}"
        );
    }
}

#[test]
fn two_boxes_on_each_other_hide_both_faces() {
    let scene = boxes(&[
        ([0.0; 3], [1.0, 1.0, 1.0], false),
        ([0.2, 0.3, 1.0], [0.7, 1.4, 2.0], false),
    ]);
    let points = front_points(&scene, 40);
    for (p, polygon, hidden) in points {
        let face = scene.polygons[polygon.index()].source_face;
        // Face 2 is the top of the lower box, face 7 the foot of the upper one.
        let within = p.x > 0.2 && p.x < 0.7 && p.y > 0.3 && p.y < 1.0;
        assert_eq!(hidden, (face == 2 || face == 7) && within, "{p} of {face}");
    }
}

#[test]
fn a_shell_in_a_shell_hides_nothing() {
    // The room's inside and the building's outside in one place.
    let (min, max) = ([0.0; 3], [4.0, 3.0, 2.0]);
    assert!(hidden_points(&boxes(&[(min, max, true), (min, max, false)])).is_empty());
}

#[test]
fn the_two_faces_of_a_bent_sheet_hide_nothing() {
    let scene = read(
        "mtllib m.mtl\nusemtl lamp\nv 0 0 -9\nv 1 0 -9\nv 0 1 -9\nf 1 2 3\nusemtl grey\n\
         v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 1\nv 1 1 1\n\
         f 4 5 6 7\nf 7 6 5 4\nf 5 8 9 6\nf 6 9 8 5\n",
    );
    assert!(hidden_points(&scene).is_empty());
}

#[test]
fn rooms_back_to_back_hide_nothing() {
    // Two rooms that share a wall without thickness, over one floor each.
    let scene = boxes(&[
        ([0.0; 3], [2.0, 3.0, 2.0], true),
        ([2.0, 0.0, 0.0], [4.0, 3.0, 2.0], true),
    ]);
    assert!(hidden_points(&scene).is_empty());
}

#[test]
fn what_another_side_owns_is_hidden() {
    // A rug drawn into the floor's plane, later in the file: the floor owns the area.
    let scene = read(
        "mtllib m.mtl\nusemtl lamp\nv 0 0 -9\nv 1 0 -9\nv 0 1 -9\nf 1 2 3\nusemtl grey\n\
         v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv .5 .5 0\nv 2 .5 0\nv 2 .9 0\nv .5 .9 0\n\
         f 4 5 6 7\nf 8 9 10 11\n",
    );
    let mut counts = [0usize; 2];
    for (p, polygon, hidden) in front_points(&scene, 40) {
        let rug = scene.polygons[polygon.index()].source_face == 2;
        assert_eq!(hidden, rug && p.x < 1.0, "{p}");
        counts[usize::from(hidden)] += 1;
    }
    assert!(counts.iter().all(|&n| n > 100), "{counts:?}");
}

#[test]
fn what_a_covered_lamp_sends_is_reported_as_swallowed() {
    // A box stands on half of a lamp that faces up; nothing else is there.
    let mut obj = String::from("mtllib m.mtl\n");
    for [x, y, z] in [
        [0, 0, 0],
        [2, 0, 0],
        [2, 1, 0],
        [0, 1, 0],
        [1, 0, 0],
        [1, 1, 0],
        [1, 0, 1],
        [2, 0, 1],
        [2, 1, 1],
        [1, 1, 1],
    ] {
        writeln!(obj, "v {x} {y} {z}").unwrap();
    }
    obj.push_str("usemtl lamp\nf 1 2 3 4\nusemtl grey\nf 7 8 9 10\nf 5 2 8 7\n");
    obj.push_str("f 3 6 10 9\nf 2 3 9 8\nf 6 5 7 10\nf 5 6 3 2\n");
    let prepared = PreparedScene::new(read(&obj), SidesMode::Auto, 1, &DeviceConfig::default())
        .expect("Embree builds");
    let solved = solve(&prepared, &SolveConfig::default(), &Silent).expect("solves");
    let share = solved.power.swallowed / solved.power.emitted;
    assert!((share - 0.5).abs() < 0.01, "{share}");
    assert!(solved.power.absorbed >= solved.power.swallowed);
    let warned = |w: &&String| w.contains("is a lamp covered");
    assert_eq!(solved.warnings.iter().filter(warned).count(), 1);
}
