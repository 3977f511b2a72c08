//! Proofs by test that a wall hides from each other the floors, ceilings and side walls on which it
//! ends, however the house is turned and whatever its size, and that no such claim is false.

use super::exact::{replay_occlusion, surely_clear_of};
use super::nasty_pairs::{Draw, moved};
use super::{ElementBounds, OccluderFaces, OccluderTree, OcclusionScratch, Tolerance};
use crate::cluster::{ClusterConfig, build_hierarchy};
use crate::math::{Aabb, PolygonId};
use crate::occluder::{OccluderConfig, SlabRectangle, extract_occluders};
use crate::scene::{Axes, Facet, LoadConfig, Scene, Side, load_text};
use glam::{DMat3, DVec3, Vec3};
use std::fmt::Write as _;

/// Two rooms, x from -1 to 1, and between them a wall from floor to ceiling and side to side.
struct House {
    /// Half the thickness of the wall; 0 for a single sheet.
    half_wall: f64,
    turn: DMat3,
    scale: f64,
    shift: DVec3,
}

/// Half of the house's width, and its height: far from round numbers in binary.
const HALF_WIDTH: f64 = 0.63;
const HEIGHT: f64 = 0.47;
/// Quadrilaterals along an edge of every surface.
const CELLS: usize = 5;

impl House {
    /// Corner and edge vectors of each surface, facing into the rooms.
    fn surfaces(&self) -> Vec<[DVec3; 3]> {
        let (w, h) = (HALF_WIDTH, HEIGHT);
        let (y, z) = (DVec3::Y * 2.0 * w, DVec3::Z * h);
        let mut surfaces = Vec::new();
        for (from, to) in [(-1.0, -self.half_wall), (self.half_wall, 1.0)] {
            let (corner, x) = (DVec3::new(from, -w, 0.0), DVec3::X * (to - from));
            surfaces.extend([
                [corner, x, y],
                [corner + z, y, x],
                [corner, z, x],
                [corner + y, x, z],
            ]);
        }
        let end = DVec3::new(1.0, -w, 0.0);
        surfaces.extend([[end * DVec3::new(-1.0, 1.0, 1.0), y, z], [end, z, y]]);
        let wall = DVec3::new(self.half_wall, -w, 0.0);
        surfaces.push([wall, y, z]);
        if self.half_wall > 0.0 {
            surfaces.push([wall * DVec3::new(-1.0, 1.0, 1.0), z, y]);
        }
        surfaces
    }

    fn scene(&self) -> Scene {
        let mut obj = "mtllib house.mtl\nusemtl light\n".to_owned();
        let mut vertices = 0;
        for [corner, u, v] in self.surfaces() {
            for i in 0..=CELLS {
                for j in 0..=CELLS {
                    let (s, t) = (i as f64 / CELLS as f64, j as f64 / CELLS as f64);
                    let p = self.turn * (corner + u * s + v * t) * self.scale + self.shift;
                    writeln!(obj, "v {:e} {:e} {:e}", p.x, p.y, p.z).expect("a string grows");
                }
            }
            for i in 0..CELLS {
                for j in 0..CELLS {
                    let at = |i: usize, j: usize| vertices + i * (CELLS + 1) + j + 1;
                    let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                    writeln!(obj, "f {a} {b} {c} {d}").expect("a string grows");
                }
            }
            vertices += (CELLS + 1) * (CELLS + 1);
        }
        let library = [("house.mtl", b"newmtl light\nKe 1 1 1\n".as_slice())];
        // Along the file's axes, so that what is turned stays askew.
        let load = LoadConfig {
            axes: Axes::File,
            ..LoadConfig::default()
        };
        load_text("house", obj.as_bytes(), &library, &load).expect("a valid scene")
    }
}

/// A house ready to be asked.
struct Stage {
    scene: Scene,
    slabs: Vec<SlabRectangle>,
    tree: OccluderTree,
    tolerance: Tolerance,
    /// Polygons of the rooms, away from the wall, by room.
    rooms: [Vec<PolygonId>; 2],
}

impl Stage {
    fn new(house: &House) -> Self {
        let scene = house.scene();
        let polygons: Vec<PolygonId> = (0..scene.polygons.len()).map(PolygonId::new).collect();
        let facets: Vec<Facet> = polygons
            .iter()
            .map(|&polygon| Facet {
                polygon,
                side: Side::Front,
            })
            .collect();
        let hierarchy = build_hierarchy(&scene, &facets, &ClusterConfig::default());
        let set = extract_occluders(&scene, &hierarchy, &OccluderConfig::default());
        let slabs: Vec<SlabRectangle> = set.occluders.iter().map(|o| o.slab).collect();
        let tolerance = Tolerance::of_scene(scene.bounds());
        let rooms = [-1.0, 1.0].map(|side| {
            let beyond = |id: &PolygonId| {
                scene.polygons[id.index()].vertices.iter().all(|&v| {
                    let p = scene.source_positions[v as usize] - house.shift;
                    side * (house.turn.transpose() * p / house.scale).x > house.half_wall + 1.0e-3
                })
            };
            polygons.iter().copied().filter(|id| beyond(id)).collect()
        });
        Self {
            tree: OccluderTree::build(&slabs, &[], tolerance),
            scene,
            slabs,
            tolerance,
            rooms,
        }
    }

    /// A polygon of a room, split a few times as the solver splits.
    fn patch(&self, room: usize, draw: &mut Draw) -> ElementBounds {
        let ids = &self.rooms[room];
        let mut corners = self
            .scene
            .corners(ids[draw.below(ids.len() as u32) as usize]);
        for _ in 0..draw.below(7) {
            let [a, b, c] = corners;
            let (ab, bc, ca) = ((a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5);
            corners = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]][draw.below(4) as usize];
        }
        ElementBounds::from_polygon(&corners)
    }

    /// Is the segment surely clear of the whole scene?
    fn clear(&self, p: Vec3, q: Vec3) -> bool {
        (0..self.scene.polygons.len()).all(|i| {
            let triangle = self.scene.corners(PolygonId::new(i));
            surely_clear_of(p.as_dvec3(), q.as_dvec3(), triangle, &self.tolerance)
        })
    }

    /// Asks for `pairs` pairs of patches in different rooms; returns how many are proved occluded.
    fn proved(&self, pairs: u32, seed: u64) -> u32 {
        let mut draw = Draw::new(seed);
        let (mut scratch, mut proved) = (OcclusionScratch::default(), 0);
        for pair in 0..pairs {
            let (a, b) = (self.patch(0, &mut draw), self.patch(1, &mut draw));
            let answer = self.tree.query(&a, &b, &mut None, &mut scratch);
            let Some(id) = answer.occluder else { continue };
            proved += 1;
            assert_eq!(
                replay_occlusion(&self.slabs[id as usize], &a, &b, &self.tolerance),
                Ok(()),
                "pair {pair} of seed {seed}"
            );
            if pair % 24 == 0 {
                for (p, q) in a.corners().flat_map(|p| b.corners().map(move |q| (p, q))) {
                    assert!(!self.clear(p, q), "pair {pair} of seed {seed}: {p} to {q}");
                }
            }
        }
        proved
    }
}

/// A turn about a slanting axis, or none.
fn turn(seed: u64) -> DMat3 {
    if seed == 0 {
        return DMat3::IDENTITY;
    }
    let mut draw = Draw::new(seed);
    DMat3::from_quat(draw.rotation().as_dquat().normalize())
}

#[test]
fn a_wall_hides_every_surface_it_ends_on_at_any_size_and_turn() {
    const PAIRS: u32 = 120;
    let mut least = PAIRS;
    for seed in 0..10 {
        for half_wall in [0.0, 0.05] {
            let mut draw = Draw::new(seed);
            let scale = f64::from(draw.scale(1.0e-4, 1.0e6));
            let house = House {
                half_wall,
                turn: turn(seed),
                scale,
                shift: draw.point().as_dvec3() * 10.0 * scale,
            };
            let stage = Stage::new(&house);
            assert!(stage.rooms.iter().all(|r| r.len() > 100));
            let proved = stage.proved(PAIRS, seed);
            println!(
                "turn {seed}, wall {half_wall}, scale {scale:.1e}: {proved} of {PAIRS}, occluders {}",
                stage.slabs.len()
            );
            least = least.min(proved);
        }
    }
    assert_eq!(least, PAIRS);
}

/// Two triangles on either side of a rectangle, each with one corner within a few weld distances of
/// the plane that stands on one of its edges, inside or outside, and everything else well inside.
struct FlushCase {
    slab: SlabRectangle,
    elements: [ElementBounds; 2],
    /// How far inside the nearer corner lies.
    inside: f32,
    /// The elements are far enough from the rectangle's plane for a claim.
    apart: bool,
    tolerance: Tolerance,
}

impl FlushCase {
    fn draw(draw: &mut Draw) -> Self {
        let turn = draw.rotation();
        let (u, v, n) = (turn * Vec3::X, turn * Vec3::Y, turn * Vec3::Z);
        let centre = draw.point() * 0.3;
        let (hu, hv) = (draw.scale(0.01, 0.4), draw.scale(0.01, 0.4));
        let half_thickness = [1.0e-7, 1.0e-6, 1.0e-3][draw.below(3) as usize];
        let slab = SlabRectangle::new(centre, u * hu, v * hv, n, half_thickness);
        let mut inside = f32::INFINITY;
        // tau and the rounding of heights: too near to the plane for a claim, and far enough.
        let gap = [1.5e-6, 4.5e-6][draw.below(2) as usize];
        let elements = [-1.0, 1.0].map(|side| {
            let mut corner = |draw: &mut Draw, near: bool| {
                let step = if near {
                    draw.between(-1.0e-6, 3.0e-6)
                } else {
                    hv * draw.between(0.05, 1.8)
                };
                inside = inside.min(step);
                let height = half_thickness + gap + draw.scale(1.0e-7, 0.4);
                centre + u * (hu * draw.between(-0.8, 0.8)) + v * (step - hv) + n * (side * height)
            };
            let near = draw.below(4) != 0;
            let corners = [near, false, false].map(|near| corner(draw, near));
            ElementBounds::from_polygon(&corners)
        });
        let everything = Aabb::from_points(slab.corners)
            .union(elements[0].aabb())
            .union(elements[1].aabb())
            .union(Aabb {
                min: Vec3::splat(-0.5),
                max: Vec3::splat(0.5),
            });
        Self {
            slab,
            elements,
            inside,
            apart: gap > 4.0e-6,
            tolerance: Tolerance::of_scene(everything),
        }
    }
}

#[test]
fn flush_claims_replay_and_hold_for_descendants() {
    let (mut claimed, mut inside, mut outside) = (0, 0, 0);
    for seed in 0..40_000 {
        let mut draw = Draw::new(seed);
        let case = FlushCase::draw(&mut draw);
        let ([a, b], tolerance) = (&case.elements, &case.tolerance);
        let claim = OccluderFaces::new(&case.slab).occludes(a, b, tolerance);
        outside += u32::from(case.inside < -1.0e-7);
        if claim {
            claimed += 1;
            assert_eq!(
                replay_occlusion(&case.slab, a, b, tolerance),
                Ok(()),
                "case {seed}"
            );
            for _ in 0..4 {
                let [a, b] = [a, b].map(|bounds| {
                    let way = draw.point().normalize_or_zero();
                    moved(bounds, way * (tolerance.nesting * 0.8))
                });
                assert_eq!(
                    replay_occlusion(&case.slab, &a, &b, tolerance),
                    Ok(()),
                    "case {seed}, moved"
                );
            }
        }
        // Nesting is 0.24 of the weld distance; corners are rounded to a tenth of it. The rounded
        // edges of small rectangles lean too much for elements close to their plane.
        let [p, q, _, s] = case.slab.corners;
        let large = p.distance(q).min(p.distance(s)) > 0.1;
        if large && case.apart && case.inside > 0.4 * tolerance.weld {
            inside += 1;
            assert!(claim, "case {seed}: {} inside", case.inside);
        }
    }
    println!("{claimed} claims, {inside} plainly inside, {outside} plainly outside, of 40000");
    assert!(inside > 1_000 && outside > 5_000 && claimed > inside);
}
