//! The audit can fail: false claims are planted in the engine before it looks, and it finds each.

use super::audit::{AuditConfig, audit};
use super::audit_report::{AuditReport, Flaw};
use super::continuous_surface::{SurfaceProof, prove_surface};
use crate::cluster::Hierarchy;
use crate::embree::DeviceConfig;
use crate::math::Aabb;
use crate::occluder::{Occluder, OccluderConfig, OccluderSet, SlabRectangle, Solid};
use crate::scene::generate::generate;
use crate::scene::{LoadConfig, SidesMode, load_text};
use crate::solve::{Guarantees, PreparedScene, Silent, SolveConfig, Stop, Stride, Technique};
use crate::visibility::{EmptyBoxes, Faults};
use glam::{Vec2, Vec3};
use std::fmt::Write;

const MTL: &str = "newmtl lamp\nKd 0.5 0.5 0.5\nKe 1 1 1\nnewmtl wall\nKd 0.5 0.5 0.5\n";

fn prepare(obj: &str, mtl: &str, library: &str) -> PreparedScene {
    let files = [(library, mtl.as_bytes())];
    let scene = load_text("planted", obj.as_bytes(), &files, &LoadConfig::default())
        .expect("the scene loads");
    PreparedScene::new(scene, SidesMode::Auto, 1, &DeviceConfig::default())
        .expect("Embree opens")
        .with_guarantees(Technique::Occlusion, &OccluderConfig::default())
}

fn builtin(name: &str) -> PreparedScene {
    let text = generate(name).expect("a built-in scene");
    prepare(&text.obj, &text.mtl, &format!("{name}.mtl"))
}

/// The room of side 1 around the origin, its ceiling emitting, and what stands in it.
fn room_with(quads: &[[Vec3; 4]]) -> PreparedScene {
    let mut obj = "mtllib m.mtl\n".to_owned();
    let mut add = |material: &str, corners: &[Vec3]| {
        let _ = writeln!(obj, "usemtl {material}");
        for c in corners {
            let _ = writeln!(obj, "v {} {} {}", c.x, c.y, c.z);
        }
        let last: Vec<String> = (1..=corners.len()).rev().map(|i| format!("-{i}")).collect();
        let _ = writeln!(obj, "f {}", last.join(" "));
    };
    for axis in 0..3 {
        for side in [-0.5f32, 0.5] {
            let mut quad = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(s, t)| {
                let mut p = Vec3::splat(side);
                p[(axis + 1) % 3] = s;
                p[(axis + 2) % 3] = t;
                p
            });
            if side > 0.0 {
                quad.reverse();
            }
            let material = if axis == 2 && side > 0.0 {
                "lamp"
            } else {
                "wall"
            };
            add(material, &quad);
        }
    }
    for quad in quads {
        add("wall", quad);
    }
    prepare(&obj, MTL, "m.mtl")
}

/// Asked often, whether it pays or not: many claims.
fn audit_of(prepared: &PreparedScene) -> AuditReport {
    audit_at(prepared, Stride::Every(SolveConfig::PAPER_STRIDE))
}

fn audit_at(prepared: &PreparedScene, stride: Stride) -> AuditReport {
    let solve = SolveConfig {
        epsilon: 1.0e-4,
        stop: Stop::Passes(1),
        stride,
        ..SolveConfig::default()
    };
    let config = AuditConfig {
        claims: 5_000,
        rays_per_claim: 32,
        brute_force: 100,
    };
    let report = audit(prepared, &solve, &config, &Silent).expect("audits");
    println!("{report:?}");
    report
}

fn assert_clean(prepared: &PreparedScene) -> AuditReport {
    let report = audit_of(prepared);
    assert!(!report.is_refuted(), "{:?}", report.flaws);
    assert!(report.rays_uniform > 1_000 && report.rays_aimed > 1_000);
    assert_eq!(report.occluders_claimed, report.occluders_proved);
    assert_eq!(report.occlusion_claims, report.occlusion_proofs);
    report
}

/// The audit of the same scene with these occluders instead of its own.
fn with_set(prepared: PreparedScene, occluders: Vec<Occluder>) -> PreparedScene {
    let set = OccluderSet {
        occluders,
        ..OccluderSet::default()
    };
    PreparedScene {
        guarantees: Some(Guarantees::with_set(&prepared.scene, set)),
        ..prepared
    }
}

fn with_faults(prepared: PreparedScene, faults: Faults) -> PreparedScene {
    PreparedScene {
        guarantees: prepared.guarantees.map(|g| g.with_faults(faults)),
        ..prepared
    }
}

fn finds(report: &AuditReport, kind: fn(&Flaw) -> bool) -> bool {
    // What is written holds no null.
    let text = serde_json::to_string(report).expect("plain data");
    assert!(!text.contains("null"), "{text}");
    report.is_refuted() && report.flaws.iter().any(kind)
}

fn is_open(flaw: &Flaw) -> bool {
    matches!(flaw, Flaw::OccluderOpen { .. })
}

fn is_segment(flaw: &Flaw) -> bool {
    matches!(flaw, Flaw::Segment { .. })
}

/// A wall across the room at x = 0 with a doorway.
fn wall_with_door() -> PreparedScene {
    let at = |y: f32, z: f32| Vec3::new(0.0, y, z);
    let part = |y: [f32; 2], z: [f32; 2]| {
        [
            at(y[0], z[0]),
            at(y[1], z[0]),
            at(y[1], z[1]),
            at(y[0], z[1]),
        ]
    };
    room_with(&[
        part([-0.5, 0.2], [-0.5, 0.5]),
        part([0.2, 0.4], [0.3, 0.5]),
        part([0.4, 0.5], [-0.5, 0.5]),
    ])
}

#[test]
fn an_occluder_grown_by_a_thousandth_is_found() {
    let prepared = wall_with_door();
    let clean = assert_clean(&prepared);
    assert!(clean.occlusion_claims > 100);
    let by = 1.0e-3 * prepared.scene.bounds().diagonal();
    let guarantees = prepared.guarantees.as_ref().expect("built");
    let grown: Vec<Occluder> = guarantees
        .occluder_set
        .occluders
        .iter()
        .map(|occluder| {
            let [a, b, _, d] = occluder.slab.corners;
            let centre = 0.5 * (b + d);
            let (u, v) = (0.5 * (b - a), 0.5 * (d - a));
            let longer = |h: Vec3| h + h.normalize() * by;
            Occluder {
                slab: SlabRectangle::new(
                    centre,
                    longer(u),
                    longer(v),
                    occluder.slab.normal,
                    occluder.slab.half_thickness,
                ),
                ..*occluder
            }
        })
        .collect();
    let report = audit_of(&with_set(prepared, grown));
    assert!(finds(&report, is_open));
}

/// A box of side 0.4 in the middle of the room without the face that looks along x.
fn open_box() -> PreparedScene {
    let at = |x: f32, y: f32, z: f32| Vec3::new(x, y, z) * 0.2;
    let mut quads = Vec::new();
    for (axis, side) in [(0, -1.0f32), (1, -1.0), (1, 1.0), (2, -1.0), (2, 1.0)] {
        let mut quad = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(s, t)| {
            let mut p = [side; 3];
            (p[(axis + 1) % 3], p[(axis + 2) % 3]) = (s, t);
            at(p[0], p[1], p[2])
        });
        if side < 0.0 {
            quad.reverse();
        }
        quads.push(quad);
    }
    room_with(&quads)
}

/// The audit of the same scene with its solids changed.
fn audit_with_solids(prepared: PreparedScene, change: impl Fn(&Solid) -> Solid) -> AuditReport {
    let own = &prepared.guarantees.as_ref().expect("built").occluder_set;
    assert!(!own.solids.is_empty());
    let set = OccluderSet {
        solids: own.solids.iter().map(change).collect(),
        ..own.clone()
    };
    audit_of(&PreparedScene {
        guarantees: Some(Guarantees::with_set(&prepared.scene, set)),
        ..prepared
    })
}

fn is_open_solid(flaw: &Flaw) -> bool {
    matches!(flaw, Flaw::OccluderOpen { node: None, .. })
}

#[test]
fn an_open_face_of_a_solid_taken_for_covered_is_found() {
    let prepared = open_box();
    assert!(assert_clean(&prepared).occlusion_claims > 100);
    let report = audit_with_solids(prepared, |solid| Solid {
        covered: [[true; 2]; 3],
        ..*solid
    });
    assert!(finds(&report, is_open_solid));
}

#[test]
fn a_solid_grown_by_a_thousandth_is_found() {
    let prepared = open_box();
    let by = 1.0e-3 * prepared.scene.bounds().diagonal();
    let report = audit_with_solids(prepared, |solid| Solid {
        halves: solid.halves.map(|h| h + h.normalize() * by),
        ..*solid
    });
    assert!(finds(&report, is_open_solid));
}

/// A sheet along z through the points of a profile in the plane of x and y.
fn swept(profile: &[Vec2]) -> Vec<[Vec3; 4]> {
    profile
        .windows(2)
        .map(|w| {
            [
                w[0].extend(-0.5),
                w[1].extend(-0.5),
                w[1].extend(0.5),
                w[0].extend(0.5),
            ]
        })
        .collect()
}

/// A slab at x = 0 that claims the whole width of the room.
fn whole_width(half_thickness: f32) -> Occluder {
    Occluder {
        slab: SlabRectangle::new(
            Vec3::ZERO,
            Vec3::Y * 0.49,
            Vec3::Z * 0.49,
            Vec3::X,
            half_thickness,
        ),
        node: Hierarchy::ROOT,
    }
}

#[test]
fn abutting_sheets_taken_for_one_surface_are_found() {
    let p = Vec2::new;
    let left = swept(&[p(-0.01, -0.5), p(-0.01, 0.0)]);
    let right = swept(&[p(0.01, 0.0), p(0.01, 0.5)]);
    let prepared = room_with(&[left, right].concat());
    assert_clean(&prepared);
    let report = audit_of(&with_set(prepared, vec![whole_width(0.0101)]));
    assert!(report.occlusion_claims > 100);
    assert!(finds(&report, is_open) && finds(&report, is_segment));
}

#[test]
fn folded_hems_taken_for_one_surface_are_found() {
    // Both hems fold back over themselves, interlocked but nowhere joined: every projected point is
    // covered, and a flat segment slips through between them.
    let p = Vec2::new;
    let left = swept(&[p(-0.01, -0.5), p(-0.01, 0.02), p(-0.004, -0.02)]);
    let right = swept(&[p(0.004, 0.02), p(0.01, -0.02), p(0.01, 0.5)]);
    let prepared = room_with(&[left, right].concat());
    assert_clean(&prepared);
    let report = audit_of(&with_set(prepared, vec![whole_width(0.0101)]));
    assert!(report.occlusion_claims > 100);
    assert!(finds(&report, is_open));
}

#[test]
fn a_sheet_folded_in_a_z_is_continuous_surface() {
    let p = Vec2::new;
    let profile = [p(-0.01, -0.5), p(-0.01, 0.02), p(0.01, -0.02), p(0.01, 0.5)];
    let prepared = room_with(&swept(&profile));
    // The room's own walls belong to the root too, but stay outside the slab.
    let weld = 1.0e-6 * prepared.scene.bounds().diagonal();
    let proof = prove_surface(
        &prepared.scene,
        &prepared.hierarchy,
        &whole_width(0.0101),
        f64::from(weld),
    );
    assert_eq!(proof, Ok(SurfaceProof::Chain));
}

#[test]
fn a_shaft_wholly_beside_the_rectangle_is_found() {
    let prepared = wall_with_door();
    let faults = Faults {
        beside_is_inside: true,
        ..Faults::NONE
    };
    let report = audit_of(&with_faults(prepared, faults));
    assert!(finds(&report, |f| matches!(f, Flaw::OcclusionProof { .. })));
    assert!(finds(&report, is_segment));
}

#[test]
fn a_part_that_is_never_looked_at_is_found() {
    let prepared = builtin("two-rooms");
    assert!(assert_clean(&prepared).claims_by_parts > 10);
    let faults = Faults {
        part_forgotten: true,
        ..Faults::NONE
    };
    let report = audit_of(&with_faults(prepared, faults));
    assert!(finds(&report, |f| matches!(f, Flaw::PartNotHidden { .. })));
    assert!(finds(&report, is_segment));
}

#[test]
fn a_surface_with_a_hole_is_found() {
    // A folded screen across the room: no rectangle hides more than one wing does.
    let at = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    let wings = |low: f32, high: f32| {
        (0..4).map(move |i| {
            let (y, next) = (0.25 * i as f32 - 0.5, 0.25 * (i + 1) as f32 - 0.5);
            let (x, past) = (0.1 * (i % 2) as f32, 0.1 * ((i + 1) % 2) as f32);
            [
                at(x, y, low),
                at(past, next, low),
                at(past, next, high),
                at(x, y, high),
            ]
        })
    };
    let mut screen: Vec<[Vec3; 4]> = [-0.5, 0.0]
        .map(|z| wings(z, z + 0.5))
        .into_iter()
        .flatten()
        .collect();
    assert!(assert_clean(&room_with(&screen)).claims_by_surfaces > 10);
    screen.remove(1);
    let with_hole = room_with(&screen);
    assert_clean(&with_hole);
    let faults = Faults {
        borders_forgotten: true,
        ..Faults::NONE
    };
    let report = audit_of(&with_faults(with_hole, faults));
    assert!(finds(&report, |f| matches!(f, Flaw::OcclusionProof { .. })));
    assert!(finds(&report, is_segment));
}

#[test]
fn a_survivor_list_cut_short_is_found() {
    let prepared = builtin("cornell");
    assert_clean(&prepared);
    let faults = Faults {
        survivors_cut: true,
        ..Faults::NONE
    };
    let report = audit_of(&with_faults(prepared, faults));
    assert!(finds(&report, |f| matches!(f, Flaw::PolygonInShaft { .. })));
    assert!(finds(&report, is_segment));
}

#[test]
fn a_shaft_test_that_forgets_slivers_is_found() {
    // Three laths, a hundred times as long as wide.
    let laths: Vec<[Vec3; 4]> = (0..3)
        .map(|i| {
            let x = -0.2 + 0.2 * i as f32;
            let at = |dx: f32, y: f32| Vec3::new(x + dx, y, 0.0);
            [at(0.0, -0.4), at(0.008, -0.4), at(0.008, 0.4), at(0.0, 0.4)]
        })
        .collect();
    let prepared = room_with(&laths);
    assert_clean(&prepared);
    let faults = Faults {
        slivers_forgotten: true,
        ..Faults::NONE
    };
    let report = audit_of(&with_faults(prepared, faults));
    assert!(finds(&report, |f| matches!(f, Flaw::PolygonInShaft { .. })));
    assert!(finds(&report, is_segment));
}

#[test]
fn a_box_of_air_that_furniture_reaches_into_is_found() {
    let prepared = builtin("cornell");
    let clean = audit_at(&prepared, Stride::Auto);
    assert!(!clean.is_refuted() && clean.visibility_claims > 100);
    // By a hundredth of the scene on each side: into the blocks, and out through the walls.
    let by = 1.0e-2 * prepared.scene.bounds().diagonal();
    let mut guarantees = prepared.guarantees.clone().expect("built");
    let grown = guarantees.empty_boxes.boxes().into_iter().map(|b| Aabb {
        min: b.min - by,
        max: b.max + by,
    });
    guarantees.empty_boxes = EmptyBoxes::planted(grown.collect());
    let planted = PreparedScene {
        guarantees: Some(guarantees),
        ..prepared
    };
    let report = audit_at(&planted, Stride::Auto);
    assert!(finds(&report, |f| matches!(f, Flaw::PolygonInShaft { .. })));
    assert!(finds(&report, is_segment));
}

#[test]
fn the_report_does_not_depend_on_threads() {
    let prepared = wall_with_door();
    let with = |threads: usize| {
        rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .expect("threads start")
            .install(|| audit_of(&prepared))
    };
    assert_eq!(with(1), with(3));
}
