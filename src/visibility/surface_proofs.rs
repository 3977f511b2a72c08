//! Proofs by test that a surface never hides what it does not hide, and that it hides what no flat occluder does.

use super::cutting_surface::{SurfaceQuery, SurfaceScratch};
use super::exact::{OcclusionFlaw, SegmentStanding, judge_segment, replay_surface_occlusion};
use super::nasty_pairs::{Draw, moved};
use super::nasty_scenes::{
    Triangles, bowl, grid, room, sheet, sphere, spiral_stair, torus, turned,
};
use super::surface_pair::SurfacePair;
use super::{CuttingSurface, ElementBounds, Faults, SceneTree, SurfaceEdges, Tolerance};
use crate::math::Aabb;
use glam::{Quat, Vec3};

/// Triangles, and how they hang together.
struct Surfaces {
    triangles: Triangles,
    tree: SceneTree,
    edges: SurfaceEdges,
    faults: Faults,
}

impl Surfaces {
    /// With the unit cube for bounds, whatever is in it.
    fn new(triangles: Triangles) -> Self {
        let bounds = Aabb {
            min: Vec3::splat(-0.5),
            max: Vec3::splat(0.5),
        };
        Self {
            tree: SceneTree::over_triangles(&triangles, Tolerance::of_scene(bounds)),
            edges: SurfaceEdges::new(triangles.clone()),
            triangles,
            faults: Faults::NONE,
        }
    }

    fn query(&self) -> SurfaceQuery<'_> {
        SurfaceQuery::new(&self.tree, &self.edges).with_faults(self.faults)
    }

    /// The surface that is claimed to cut all segments, if one is.
    fn claim(&self, a: &ElementBounds, b: &ElementBounds) -> Option<CuttingSurface> {
        let query = self.query();
        let seed = query.run(a, b, &mut SurfaceScratch::default()).surface?;
        Some(query.surface(a, b, seed).expect("found again"))
    }

    fn replay(
        &self,
        surface: &CuttingSurface,
        a: &ElementBounds,
        b: &ElementBounds,
    ) -> Result<(), OcclusionFlaw> {
        replay_surface_occlusion(surface, a, b, self.tree.tolerance())
    }

    /// Asks about a pair. A claim has to hold in exact arithmetic, also for elements moved by the nesting margin, and no
    /// segment may be surely clear.
    fn judged_claim(&self, a: &ElementBounds, b: &ElementBounds, draw: &mut Draw) -> bool {
        let Some(surface) = self.claim(a, b) else {
            return false;
        };
        assert_eq!(self.replay(&surface, a, b), Ok(()), "{a:?} {b:?}");
        let step = |draw: &mut Draw| {
            draw.point().normalize_or_zero() * self.tree.tolerance().nesting * 0.99
        };
        let (c, d) = (moved(a, step(draw)), moved(b, step(draw)));
        assert_eq!(self.replay(&surface, &c, &d), Ok(()), "{c:?} {d:?}");
        for _ in 0..16 {
            let (p, q) = (inside(a, draw), inside(b, draw));
            let standing = judge_segment(&self.tree, p.as_dvec3(), q.as_dvec3());
            assert_ne!(standing, SegmentStanding::Clear, "{p} {q}");
        }
        true
    }

    /// An element somewhere, or a triangle of the scene or of one split.
    fn element(&self, draw: &mut Draw) -> ElementBounds {
        if draw.below(3) != 0 {
            let (at, size) = (draw.point(), draw.scale(1.0e-4, 0.3));
            return draw.element(at, size);
        }
        let mut corners = self.triangles[draw.below(self.triangles.len() as u32) as usize];
        for _ in 0..draw.below(3) {
            let [a, b, c] = corners;
            let (ab, bc, ca) = ((a + b) * 0.5, (b + c) * 0.5, (c + a) * 0.5);
            corners = [[a, ab, ca], [ab, b, bc], [ca, bc, c], [bc, ca, ab]][draw.below(4) as usize];
        }
        ElementBounds::from_polygon(&corners)
    }

    fn claims_of(&self, pairs: u32, seed: u64) -> u32 {
        let mut draw = Draw::new(seed);
        (0..pairs)
            .map(|_| {
                let (a, b) = (self.element(&mut draw), self.element(&mut draw));
                u32::from(self.judged_claim(&a, &b, &mut draw))
            })
            .sum()
    }
}

/// A point of the hull of the corners.
fn inside(bounds: &ElementBounds, draw: &mut Draw) -> Vec3 {
    let weights: Vec<f32> = bounds.corners().map(|_| draw.scale(1.0e-6, 1.0)).collect();
    let sum: f32 = weights.iter().sum();
    bounds
        .corners()
        .zip(&weights)
        .map(|(c, w)| c * (w / sum))
        .sum()
}

fn ball(centre: Vec3, half: f32) -> ElementBounds {
    ElementBounds::from_box(Aabb {
        min: centre - half,
        max: centre + half,
    })
}

/// A cube of side 0.4 about the origin, seen from outside, each face of `n x n` quadrilaterals.
fn cube(n: u32) -> Triangles {
    let mut inside_out = room(Vec3::splat(0.2), n, Quat::IDENTITY);
    inside_out.iter_mut().for_each(|t| t.swap(1, 2));
    inside_out
}

#[test]
fn no_claim_is_refuted() {
    let turn = Quat::from_rotation_z(0.4) * Quat::from_rotation_x(0.3);
    let mut wavy = grid(12, 12, |s, t| {
        Vec3::new(s - 0.5, t - 0.5, 0.05 * (9.0 * s).sin() * (7.0 * t).cos())
    });
    let whole_wave = wavy.len();
    for (name, triangles, least) in [
        ("bowl", bowl(5), 20),
        ("sphere", sphere(6), 20),
        ("torus", torus(7), 20),
        ("spiral stair", spiral_stair(24), 5),
        ("cube", cube(2), 20),
        ("turned cube", turned(cube(3), turn), 20),
        ("wave", wavy.clone(), 20),
        (
            "two sheets back to back",
            {
                let front = sheet(
                    Vec3::new(-0.4, -0.4, 0.0),
                    Vec3::X * 0.8,
                    Vec3::Y * 0.8,
                    3,
                    3,
                );
                let back = front.iter().map(|&[a, b, c]| [a, c, b]).collect();
                [front, back].concat()
            },
            20,
        ),
    ] {
        let claims = Surfaces::new(triangles).claims_of(1_500, 7);
        println!("{name}: {claims} claims of 1500");
        assert!(claims > least, "{name}: {claims}");
    }
    // With holes.
    wavy.retain(|t| (t[0].x + 0.3 * t[0].y).sin().abs() > 0.04);
    assert!(wavy.len() < whole_wave);
    println!("holes: {} claims", Surfaces::new(wavy).claims_of(1_500, 8));
}

#[test]
fn loose_and_touching_triangles_make_no_false_claim() {
    for seed in 0..10 {
        let mut draw = Draw::new(seed);
        // Corners on a coarse lattice, so that many triangles share edges, three and four at one.
        let mut corner = || (draw.point() * 3.0).round() / 6.0;
        let mut triangles: Triangles = (0..60).map(|_| [corner(), corner(), corner()]).collect();
        triangles.retain(|[a, b, c]| (*b - *a).cross(*c - *a).length() > 1.0e-3);
        Surfaces::new(triangles).claims_of(400, seed);
    }
}

#[test]
fn a_bent_screen_hides_what_neither_of_its_wings_hides() {
    // Wings at right angles that meet at the y axis, open towards +x.
    let wing = |z: f32| {
        sheet(
            Vec3::new(0.0, -0.4, 0.0),
            Vec3::new(0.3, 0.0, z),
            Vec3::Y * 0.8,
            2,
            3,
        )
    };
    let screen = Surfaces::new([wing(0.3), wing(-0.3)].concat());
    let (a, b) = (ball(Vec3::X * 0.3, 0.05), ball(Vec3::X * -0.3, 0.05));
    let surface = screen.claim(&a, &b).expect("hidden");
    assert_eq!(screen.replay(&surface, &a, &b), Ok(()));
    assert!(surface.overhangs.is_empty());
    // Without one wing, and past the screen's ends, there is a way.
    assert_eq!(Surfaces::new(wing(0.3)).claim(&a, &b), None);
    let high = ball(Vec3::new(-0.3, 0.45, 0.0), 0.02);
    assert_eq!(
        screen.claim(&ball(Vec3::new(0.3, 0.45, 0.0), 0.02), &high),
        None
    );
}

#[test]
fn a_body_hides_what_is_behind_it_and_a_hollow_one_what_is_inside() {
    let surfaces = Surfaces::new(sphere(8));
    // Not along x, where the sphere has a seam.
    let far = ball(Vec3::Y * 0.48, 0.01);
    assert!(surfaces.claim(&far, &ball(Vec3::Y * -0.48, 0.01)).is_some());
    assert!(surfaces.claim(&far, &ball(Vec3::ZERO, 0.1)).is_some());
    // Past its side, and from one place inside to another.
    let beside = ball(Vec3::new(0.48, 0.48, 0.0), 0.01);
    assert_eq!(surfaces.claim(&far, &beside), None);
    assert_eq!(
        surfaces.claim(&ball(Vec3::X * 0.2, 0.05), &ball(Vec3::X * -0.2, 0.05)),
        None
    );
}

/// A wall across x = 0 that stands on the floor z = -0.4, with triangles left out.
fn wall(without: &[usize]) -> Triangles {
    let corner = Vec3::new(0.0, -0.4, -0.4);
    let whole = sheet(corner, Vec3::Y * 0.8, Vec3::Z * 0.8, 4, 4);
    let kept = whole.into_iter().enumerate();
    kept.filter(|(i, _)| !without.contains(i))
        .map(|(_, t)| t)
        .collect()
}

#[test]
fn a_wall_hides_what_stands_on_the_floor_on_both_sides() {
    let surfaces = Surfaces::new(wall(&[]));
    // A square of floor and one that stands on it, on the other side.
    let at = |x: f32, y: f32, z: f32| Vec3::new(x, y - 0.05, z - 0.4);
    let lying = [(-0.3, 0.0), (-0.2, 0.0), (-0.2, 0.1), (-0.3, 0.1)];
    let standing = [(0.0, 0.0), (0.1, 0.0), (0.1, 0.1), (0.0, 0.1)];
    let lying = ElementBounds::from_polygon(&lying.map(|(x, y)| at(x, y, 0.0)));
    let standing = ElementBounds::from_polygon(&standing.map(|(y, z)| at(0.25, y, z)));
    let surface = surfaces.claim(&lying, &standing).expect("hidden");
    assert!(!surface.overhangs.is_empty(), "its foot is flush");
    assert_eq!(surfaces.replay(&surface, &lying, &standing), Ok(()));
    let hole = Surfaces::new(wall(&[16]));
    assert_eq!(hole.claim(&lying, &standing), None);
    // Nor does a wall that ends above the floor.
    let raised = wall(&[])
        .into_iter()
        .map(|t| t.map(|p| p + Vec3::Z * 1.0e-5));
    assert_eq!(
        Surfaces::new(raised.collect()).claim(&lying, &standing),
        None
    );
}

#[test]
fn the_replay_refuses_what_does_not_hold() {
    let surfaces = Surfaces::new(wall(&[]));
    let (a, b) = (ball(Vec3::X * 0.3, 0.05), ball(Vec3::X * -0.3, 0.05));
    let surface = surfaces.claim(&a, &b).expect("hidden");
    assert_eq!(surfaces.replay(&surface, &a, &b), Ok(()));
    let mut open = surface.clone();
    open.polygons.remove(0);
    assert!(matches!(
        surfaces.replay(&open, &a, &b),
        Err(OcclusionFlaw::OpenBorder { .. })
    ));
    assert_eq!(
        surfaces.replay(&surface, &a, &ball(Vec3::X * 0.3, 0.04)),
        Err(OcclusionFlaw::NotCrossed)
    );
    assert_eq!(
        surfaces.replay(&surface, &a, &ball(Vec3::X * 0.03, 0.05)),
        Err(OcclusionFlaw::TouchesSurface)
    );
    let mut long = surface.clone();
    long.overhangs
        .push([Vec3::Y, Vec3::Z, Vec3::Y * 0.3].map(|p| p.as_dvec3()));
    assert_eq!(
        surfaces.replay(&long, &a, &b),
        Err(OcclusionFlaw::LongOverhang)
    );
    assert_eq!(
        surfaces.replay(&CuttingSurface::default(), &a, &b),
        Err(OcclusionFlaw::NotCrossed)
    );
}

#[test]
fn the_replay_finds_a_border_that_the_engine_forgot() {
    // The two triangles left out lie in the middle of the wall.
    let mut surfaces = Surfaces::new(wall(&[20, 21]));
    let (a, b) = (ball(Vec3::X * 0.3, 0.2), ball(Vec3::X * -0.3, 0.2));
    assert_eq!(surfaces.claim(&a, &b), None);
    surfaces.faults.borders_forgotten = true;
    let surface = surfaces.claim(&a, &b).expect("claimed falsely");
    assert!(matches!(
        surfaces.replay(&surface, &a, &b),
        Err(OcclusionFlaw::OpenBorder { .. })
    ));
}

#[test]
fn a_pair_lies_in_the_plane_of_what_is_coplanar_with_both_ends() {
    let tolerance = *Surfaces::new(wall(&[])).tree.tolerance();
    let mut draw = Draw::new(17);
    for _ in 0..100 {
        let turn = draw.rotation();
        let mut tri = |x: f32, height: f32| {
            [(); 3].map(|()| {
                let (u, v) = (draw.between(-0.1, 0.1), draw.between(-0.1, 0.1));
                turn * Vec3::new(x + u, v, height)
            })
        };
        let (a, b) = (tri(-0.3, 0.0), tri(0.3, 0.0));
        // Large, so that its plane is one.
        let between = [(-0.4, -0.4), (0.4, -0.4), (0.0, 0.4)];
        let between = between.map(|(u, v)| turn * Vec3::new(u, v, 0.0));
        let raised = tri(0.3, 4.0 * tolerance.nesting);
        let lies = |b: &[Vec3; 3]| {
            let (a, b) = (
                ElementBounds::from_polygon(&a),
                ElementBounds::from_polygon(b),
            );
            let pair = SurfacePair::new(&a, &b, &tolerance);
            pair.lies_in_plane_of(between.map(|c| c.as_dvec3()))
        };
        assert!(lies(&b) && !lies(&raised), "{a:?} {b:?} {between:?}");
    }
}
