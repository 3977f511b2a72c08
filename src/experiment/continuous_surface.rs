//! Replay of an occluder's proof: its rectangle lies in continuous surface (design, section 8).
//!
//! What is to be shown is the exact meaning of [`Occluder`]: a segment that meets both faces of the
//! slab comes, between them, within w of a polygon of the cluster. Two proofs, either of which is
//! enough; both are written apart from the extraction and work on other objects than it does.
//!
//! **Cover.** Every such segment passes the plane half-way between the faces inside the convex hull of
//! the eight face corners. Each triangle, cut to the neighbourhood of that hull, comes within w of all
//! points of the plane that are within sqrt(w^2 - h^2) of its projection, h being its greatest height.
//! If the triangles so grown cover the hull, every segment comes within w of one, whatever hangs
//! together with what. Cut polygon from polygon in f64, with a thousandth of w to spare.
//!
//! **Chain.** Where the surface is not flat to w: see [`super::surface_chain`]. The faces may stick out
//! over the surface by an overhang; shrinking the plane about the centre, heights kept, by that much
//! moves no point of the rectangle by more than sqrt(2) overhangs, so what the shrunk prism proves
//! holds for the whole one up to that distance, which together with the welding's stays below w.

use super::flat_polygon::{
    box_of, boxes_meet, clip, contains, convex_hull, grown, is_thin, subtract,
};
use super::surface_chain::{FrameTriangle, boundary, degree, is_outside};
use crate::cluster::Hierarchy;
use crate::math::{Aabb, PolygonId};
use crate::occluder::{Occluder, SlabRectangle, Solid};
use crate::scene::Scene;
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::SQRT_2;

/// Share of w that is used; the rest is for rounding, a thousand times over.
const USABLE: f64 = 0.999;

/// Share of w that the overhang and the welding may take together in the second proof.
const SIDEWAYS: f64 = 0.97;

/// Triangles that are cut out of a cell one by one; with more, the cell is halved first.
const FEW: usize = 24;

/// Halvings of a cell; fans of many triangles about one vertex never become few.
const MOST_HALVINGS: u32 = 40;

/// How a rectangle was shown to lie in continuous surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SurfaceProof {
    Cover,
    Chain,
}

/// Shows that `occluder` lies in continuous surface; else where it may not, a point of its plane.
pub(super) fn prove_surface(
    scene: &Scene,
    hierarchy: &Hierarchy,
    occluder: &Occluder,
    weld: f64,
) -> Result<SurfaceProof, DVec3> {
    let prism = Prism::new(&occluder.slab);
    // One side of a polygon is enough, and both would cancel.
    let mut facets = hierarchy.facets[hierarchy.facet_range(occluder.node)].to_vec();
    facets.sort_by_key(|facet| (facet.polygon, facet.side));
    facets.dedup_by_key(|facet| facet.polygon);
    let triangles: Vec<FrameTriangle> = facets
        .into_iter()
        .map(|facet| {
            scene
                .facet_corners(facet)
                .map(|p| prism.project(p.as_dvec3()))
        })
        .collect();
    let Some(open) = prism.uncovered(&triangles, weld) else {
        return Ok(SurfaceProof::Cover);
    };
    if prism.is_cut_by_chain(&triangles, weld) {
        return Ok(SurfaceProof::Chain);
    }
    Err(prism.lift(open))
}

/// Shows that every point of the surface of `solid` is within w of a polygon (the first proof, face by face, over all
/// polygons of the scene); else a point that may not be.
pub(super) fn prove_closed(scene: &Scene, solid: &Solid, weld: f64) -> Result<SurfaceProof, DVec3> {
    let reach = 2.0 * weld as f32;
    let near = solid.bounds();
    let near = Aabb {
        min: near.min - reach,
        max: near.max + reach,
    };
    let polygons: Vec<[DVec3; 3]> = (0..scene.polygons.len())
        .map(|i| scene.corners(PolygonId::new(i)))
        .filter(|&corners| Aabb::from_points(corners).distance(near) <= 0.0)
        .map(|corners| corners.map(Vec3::as_dvec3))
        .collect();
    for axis in 0..3 {
        for (side, covered) in [-1.0, 1.0].into_iter().zip(solid.covered[axis]) {
            if !covered {
                continue;
            }
            let prism = Prism::of_face(solid.face(axis, side));
            let triangles: Vec<FrameTriangle> = polygons
                .iter()
                .map(|corners| corners.map(|p| prism.project(p)))
                .collect();
            if let Some(open) = prism.uncovered(&triangles, weld) {
                return Err(prism.lift(open));
            }
        }
    }
    Ok(SurfaceProof::Cover)
}

/// A slab in its own coordinates.
struct Prism {
    origin: DVec3,
    axes: [DVec3; 3],
    /// Hull of the projected corners of both faces, counter-clockwise.
    hull: Vec<DVec2>,
    /// Highest point of the lower face and lowest of the upper one.
    faces: [f64; 2],
}

/// A grown triangle and its box.
struct Cover {
    polygon: Vec<DVec2>,
    bounds: [DVec2; 2],
}

impl Prism {
    fn new(slab: &SlabRectangle) -> Self {
        let mut prism = Self::of_face(slab.corners.map(|c| c.as_dvec3()));
        let [below, above] =
            [-1.0, 1.0].map(|side| slab.face_corners(side).map(|corner| prism.project(corner)));
        let highest = |face: &[DVec3; 4]| face.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p.z));
        let lowest = |face: &[DVec3; 4]| face.iter().fold(f64::INFINITY, |m, p| m.min(p.z));
        prism.faces = if lowest(&above) > highest(&below) {
            [highest(&below), lowest(&above)]
        } else {
            [highest(&above), lowest(&below)]
        };
        prism.hull = convex_hull(below.iter().chain(&above).map(|p| p.truncate()).collect());
        prism
    }

    /// A rectangle without thickness.
    fn of_face(corners: [DVec3; 4]) -> Self {
        let origin = 0.25 * corners.iter().copied().sum::<DVec3>();
        let u = (corners[1] - corners[0]).normalize_or(DVec3::X);
        let across = corners[3] - corners[0];
        let v = (across - u * u.dot(across)).normalize_or(u.any_orthonormal_vector());
        let mut prism = Self {
            origin,
            axes: [u, v, u.cross(v)],
            hull: Vec::new(),
            faces: [0.0; 2],
        };
        prism.hull = convex_hull(corners.map(|p| prism.project(p).truncate()).to_vec());
        prism
    }

    fn project(&self, point: DVec3) -> DVec3 {
        let d = point - self.origin;
        DVec3::from_array(self.axes.map(|axis| axis.dot(d)))
    }

    fn lift(&self, point: DVec2) -> DVec3 {
        self.origin + self.axes[0] * point.x + self.axes[1] * point.y
    }

    /// First proof: a point of the plane that no triangle is near enough to, if there is one.
    fn uncovered(&self, triangles: &[FrameTriangle], weld: f64) -> Option<DVec2> {
        let [low, high] = box_of(&self.hull);
        let margin = DVec2::splat(2.0 * weld);
        let near = [low - margin, high + margin];
        // The plane half-way between the faces; every segment through both passes it.
        let middle = 0.5 * (self.faces[0] + self.faces[1]);
        let reach = USABLE * weld;
        let covers: Vec<Cover> = triangles
            .iter()
            .filter_map(|triangle| {
                let part = cut_to_box(triangle, near);
                let height = part.iter().fold(0.0f64, |m, p| m.max((p.z - middle).abs()));
                let radius = (reach * reach - height * height).sqrt();
                // NaN where the triangle is too far from the plane.
                let usable = !part.is_empty() && radius > 0.0;
                usable.then(|| {
                    let flat: Vec<DVec2> = part.iter().map(|p| p.truncate()).collect();
                    let polygon = grown(&flat, radius);
                    Cover {
                        bounds: box_of(&polygon),
                        polygon,
                    }
                })
            })
            .collect();
        first_open(&self.hull, &covers.iter().collect::<Vec<_>>(), 0)
    }

    /// Second proof: of the triangles that stay between the faces, no boundary enters the shrunk
    /// rectangle, and they pass it a number of times other than zero. Triangles that do not stay
    /// between the faces are left out, and leave their edges behind.
    fn is_cut_by_chain(&self, triangles: &[FrameTriangle], weld: f64) -> bool {
        let [low, high] = box_of(&self.hull);
        let margin = DVec2::splat(weld);
        let near = [low - margin, high + margin];
        let between = |reach: f64| -> Vec<FrameTriangle> {
            let stays = |p: &DVec3| p.z - reach > self.faces[0] && p.z + reach < self.faces[1];
            triangles
                .iter()
                .filter(|t| cut_to_box(t, near).iter().all(stays))
                .copied()
                .collect()
        };
        let first = boundary(&between(0.0), near, weld);
        // Where cracks are closed, the strips that close them stay between the faces too.
        let kept = between(first.reach);
        let boundary = boundary(&kept, near, weld);
        let overhang = ((SIDEWAYS * weld - boundary.reach) / SQRT_2).max(0.0);
        let Some(inner) = shrunk(&self.hull, overhang) else {
            return false;
        };
        let enters = boundary
            .edges
            .iter()
            .any(|edge| !is_outside(edge.map(DVec3::truncate), &inner));
        if enters || boundary.reach > first.reach {
            return false;
        }
        // Points at odd places: one of them is off every edge.
        let [low, size] = [box_of(&inner)[0], box_of(&inner)[1] - box_of(&inner)[0]];
        let point = |i: u32| {
            let t = f64::from(i) * 0.618_033_988_749_895;
            low + size * DVec2::new(0.3 + 0.4 * t.fract(), 0.31 + 0.37 * (t * t + 0.1).fract())
        };
        (0..32)
            .find_map(|i| degree(&kept, point(i)))
            .is_some_and(|degree| degree != 0)
    }
}

/// The part of a triangle over a box of the plane.
fn cut_to_box(triangle: &FrameTriangle, [low, high]: [DVec2; 2]) -> Vec<DVec3> {
    if !boxes_meet(box_of(&triangle.map(DVec3::truncate)), [low, high]) {
        return Vec::new();
    }
    let mut part = triangle.to_vec();
    for axis in 0..2 {
        for (limit, sign) in [(low[axis], 1.0), (high[axis], -1.0)] {
            let side = |p: DVec3| sign * (p[axis] - limit);
            let mut kept = Vec::with_capacity(part.len() + 1);
            for (i, &p) in part.iter().enumerate() {
                let q = part[(i + 1) % part.len()];
                let (hp, hq) = (side(p), side(q));
                if hp >= 0.0 {
                    kept.push(p);
                }
                if (hp > 0.0 && hq < 0.0) || (hp < 0.0 && hq > 0.0) {
                    kept.push(p + (q - p) * (hp / (hp - hq)));
                }
            }
            part = kept;
        }
    }
    part
}

/// A point of the cell that no cover holds.
fn first_open(cell: &[DVec2], covers: &[&Cover], halvings: u32) -> Option<DVec2> {
    if is_thin(cell) {
        return None;
    }
    let bounds = box_of(cell);
    let near: Vec<&Cover> = covers
        .iter()
        .copied()
        .filter(|cover| boxes_meet(cover.bounds, bounds))
        .collect();
    if near.iter().any(|cover| contains(&cover.polygon, cell)) {
        return None;
    }
    if near.len() > FEW && halvings < MOST_HALVINGS {
        let middle = 0.5 * (bounds[0] + bounds[1]);
        let size = bounds[1] - bounds[0];
        let along = if size.x > size.y { DVec2::Y } else { DVec2::X };
        return [along, -along].into_iter().find_map(|d| {
            let half = clip(cell, middle, middle + d);
            first_open(&half, &near, halvings + 1)
        });
    }
    let mut pieces = vec![cell.to_vec()];
    for cover in near {
        pieces = pieces
            .iter()
            .flat_map(|piece| subtract(piece, &cover.polygon))
            .collect();
        if pieces.is_empty() {
            return None;
        }
    }
    let first = &pieces[0];
    Some(first.iter().copied().sum::<DVec2>() / first.len() as f64)
}

/// The polygon with the plane shrunk about its centre so that its box loses `by` on every side.
fn shrunk(polygon: &[DVec2], by: f64) -> Option<Vec<DVec2>> {
    let [low, high] = box_of(polygon);
    let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
    let scale = DVec2::ONE - DVec2::splat(by) / half;
    scale.cmpgt(DVec2::ZERO).all().then(|| {
        polygon
            .iter()
            .map(|&p| centre + (p - centre) * scale)
            .collect()
    })
}
