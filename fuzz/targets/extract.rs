//! Every occluder of a bumpy, holed, cracked wall lies over surface: no segment through both its
//! faces is surely clear of the scene. Without `flush` nothing of it sticks out either.

#![no_main]

use certilux::cluster::{ClusterConfig, build_hierarchy};
use certilux::math::PolygonId;
use certilux::occluder::{OccluderConfig, extract_occluders};
use certilux::scene::{Facet, LoadConfig, Side, load_text};
use certilux::visibility::Tolerance;
use certilux::visibility::exact::surely_clear_of;
use certilux_fuzz::Bytes;
use glam::DVec3;
use libfuzzer_sys::fuzz_target;
use std::fmt::Write as _;

/// Segments tried for each occluder.
const SEGMENTS: usize = 24;

fuzz_target!(|data: &[u8]| {
    let bytes = &mut Bytes::new(data);
    let (columns, rows) = (1 + bytes.below(6), 1 + bytes.below(6));
    let bump = [0.0, 1.0e-7, 1.0e-6, 1.0e-4, 1.0e-2][bytes.below(5)];
    let lean = bytes.point().as_dvec3();
    let shared = bytes.below(2) == 0;
    let mut config = OccluderConfig::default();
    config.flush = bytes.below(2) == 0;
    config.cone_degrees = [45.0, 180.0][bytes.below(2)];
    config.min_area = 1.0e-5;
    // Two far triangles keep the wall off the border of the scene's box.
    let mut obj = "mtllib m\nusemtl l\nv -1 -1 -1\nv -1 -.9 -1\nv -.9 -1 -1\nv 1 1 1\nv 1 .9 1\nv .9 1 1\nf 1 2 3\nf 4 5 6\n".to_owned();
    let mut vertices = 6;
    let mut corner = |obj: &mut String, i: usize, j: usize, offset: u8| {
        let (x, y) = (
            i as f64 / columns as f64 - 0.5,
            j as f64 / rows as f64 - 0.5,
        );
        let z = f64::from(offset as i8) / 128.0 * bump + lean.x * x + lean.y * y;
        let _ = writeln!(obj, "v {x} {y} {z}");
        vertices += 1;
        vertices
    };
    let mut mesh: Vec<[usize; 4]> = Vec::new();
    if shared {
        let mut ids = Vec::new();
        for j in 0..=rows {
            for i in 0..=columns {
                ids.push(corner(&mut obj, i, j, bytes.byte()));
            }
        }
        for j in 0..rows {
            for i in 0..columns {
                let at = |i: usize, j: usize| ids[j * (columns + 1) + i];
                mesh.push([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    } else {
        for j in 0..rows {
            for i in 0..columns {
                let height = bytes.byte();
                mesh.push(
                    [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)]
                        .map(|(i, j)| corner(&mut obj, i, j, height)),
                );
            }
        }
    }
    for [a, b, c, d] in mesh {
        let _ = match bytes.below(6) {
            0 => writeln!(obj, "f {a} {b} {c}"),
            1 => writeln!(obj, "f {a} {d} {c} {b}"),
            2 => writeln!(obj, "f {a} {b} {d}\nf {b} {c} {d}"),
            3 if bytes.below(3) == 0 => Ok(()),
            _ => writeln!(obj, "f {a} {b} {c} {d}"),
        };
    }
    let files = [("m", b"newmtl l\nKe 1 1 1\n".as_slice())];
    let Ok(scene) = load_text("fuzz", obj.as_bytes(), &files, &LoadConfig::default()) else {
        return;
    };
    let facets: Vec<Facet> = (0..scene.polygons.len())
        .map(|i| Facet {
            polygon: PolygonId::new(i),
            side: Side::Front,
        })
        .collect();
    let hierarchy = build_hierarchy(&scene, &facets, &ClusterConfig::default());
    let set = extract_occluders(&scene, &hierarchy, &config);
    let tolerance = Tolerance::of_scene(scene.bounds());
    for occluder in &set.occluders {
        for i in 0..SEGMENTS {
            let mut at = |side: f64| -> DVec3 {
                let [a, b, _, d] = occluder.slab.face_corners(side);
                let mut share = [bytes.share(), bytes.share()];
                if i % 2 == 0 {
                    share[i / 2 % 2] = [0.0, 1.0][i / 4 % 2];
                }
                a + (b - a) * share[0] + (d - a) * share[1]
            };
            let (p, q) = (at(1.0), at(-1.0));
            // Ends are cut back by tau: from face to face that may leave nothing, so go on beyond.
            let beyond = (p - q).normalize_or_zero() * (2.0 * f64::from(tolerance.tau));
            let (p, q) = (p + beyond, q - beyond);
            // Exact arithmetic is slow: what is plainly apart need not be asked.
            let apart = DVec3::splat(2.0 * f64::from(tolerance.weld));
            let (low, high) = (p.min(q) - apart, p.max(q) + apart);
            let clear = (0..scene.polygons.len()).all(|k| {
                let triangle = scene.corners(PolygonId::new(k));
                let [a, b, c] = triangle.map(|v| v.as_dvec3());
                a.max(b).max(c).cmplt(low).any()
                    || a.min(b).min(c).cmpgt(high).any()
                    || surely_clear_of(p, q, triangle, &tolerance)
            });
            assert!(!clear, "{p} to {q} passes {occluder:?}");
        }
    }
});
