//! Solids of a scene: boxes some of whose faces the scene's polygons cover.
//!
//! Each large occluder is tried as one face of a box. How deep the box is, on either side, is taken from the polygons that meet
//! the rectangle's border at a right angle; then every face is looked at, whether polygons cover it.
//!
//! A solid has its faces a little outside of the surface, [`OVERLAP`], for the reason that rectangles stick out
//! ([`super::OccluderConfig::flush`]): what stands on a floor hides from each other what lies on the floor around it.

use super::footprint::{CONTOUR_ERROR, Footprint};
use super::rectangle::Rectangle;
use super::set::Occluder;
use super::sheet::Sheet;
use super::solid::Solid;
use crate::math::{Aabb, PolygonId};
use crate::scene::{Facet, PolygonTree, Scene, Side};
use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;

/// How far a solid's faces are aimed to lie outside of the surface, in w. A flush rectangle sticks out by
/// 0.95 / sqrt(2) = 0.67 w, less what rounding takes.
const OVERLAP: f64 = 0.32;
const RECTANGLE_OVERLAP: f64 = 0.67;

/// How far from the border of a face the polygons that cover it may end, in w: above [`OVERLAP`] with its rounding.
const INSET: f64 = 0.5;

/// How far from a face its polygons may lie, in w.
const NEAR_FACE: f64 = 0.6;

/// How far any point of a face may be from a polygon, in w; the rest is for rounding.
const REACH: f64 = 0.95;

/// Least thickness, in w: a thousandth of the scene's diagonal. What is thinner hides little more than its rectangles.
const LEAST_THICKNESS: f64 = 1000.0;

/// Rectangles that are tried, the largest ones.
const MOST_RECTANGLES: usize = 512;

/// Depths tried on one side of a rectangle, the greatest.
const MOST_DEPTHS: usize = 6;

/// Polygons of a face, and nodes visited to find them, beyond which a box is given up.
const MOST_POLYGONS: usize = 1024;
const MOST_VISITS: usize = 8192;

/// Cosine from which two planes are parallel; what it leaves, the distances of corners decide.
const PARALLEL: f64 = 1.0 - 1.0e-5;

/// No face is covered.
const NOTHING: [[bool; 2]; 3] = [[false; 2]; 3];

/// The solids that have one of the largest of `occluders` as a face: the same ones, in the same order, at any number of
/// threads.
pub(super) fn find_solids(scene: &Scene, occluders: &[Occluder], weld: f64) -> Vec<Solid> {
    let mut largest: Vec<&Occluder> = occluders.iter().collect();
    largest.sort_by(|a, b| b.slab.area().total_cmp(&a.slab.area()));
    largest.truncate(MOST_RECTANGLES);
    if largest.is_empty() {
        return Vec::new();
    }
    let search = SolidSearch {
        scene,
        tree: PolygonTree::new(scene),
        weld,
    };
    let found: Vec<Vec<Solid>> = largest
        .par_iter()
        .map(|occluder| {
            let mut solids = search.behind(occluder, 1.0);
            solids.extend(search.behind(occluder, -1.0));
            solids
        })
        .collect();
    // One and the same box is found from each of its faces.
    let mut all: Vec<Solid> = found.into_iter().flatten().collect();
    all.sort_by(|a, b| b.volume().total_cmp(&a.volume()));
    let mut kept: Vec<Solid> = Vec::new();
    for solid in all {
        if !kept
            .iter()
            .any(|larger| larger.replaces(&solid, 16.0 * weld))
        {
            kept.push(solid);
        }
    }
    kept
}

struct SolidSearch<'a> {
    scene: &'a Scene,
    tree: PolygonTree,
    weld: f64,
}

impl SolidSearch<'_> {
    /// The solids that have `occluder` as a face and lie on its `side`, deepest first; of two of which one has all that
    /// the other has only that one.
    fn behind(&self, occluder: &Occluder, side: f64) -> Vec<Solid> {
        let [a, b, c, d] = occluder.slab.corners.map(Vec3::as_dvec3);
        let middle = 0.25 * (a + b + c + d);
        let into = occluder.slab.normal.as_dvec3().normalize() * side;
        let inset = (RECTANGLE_OVERLAP - OVERLAP) * self.weld;
        let half = |edge: DVec3| {
            let length = 0.5 * edge.length();
            (length > LEAST_THICKNESS * self.weld).then(|| edge.normalize() * (length - inset))
        };
        let (Some(u), Some(v)) = (half(b - a), half(d - a)) else {
            return Vec::new();
        };
        let overlap = OVERLAP * self.weld;
        let mut solids: Vec<Solid> = Vec::new();
        for depth in self.depths(middle, [u, v], into) {
            let mut solid = Solid {
                centre: (middle + into * (0.5 * depth)).as_vec3(),
                halves: [
                    (into * (0.5 * depth + overlap)).as_vec3(),
                    u.as_vec3(),
                    v.as_vec3(),
                ],
                covered: NOTHING,
            };
            // What the deepest one lacks comes first: without any of that, this one has no more.
            if let Some(deepest) = solids.first() {
                let lacking = deepest.covered.map(|ends| ends.map(|covered| !covered));
                self.look_at(&mut solid, lacking);
                if solid.covered == NOTHING {
                    continue;
                }
                self.look_at(&mut solid, deepest.covered);
            } else {
                // The sides first: without any, the rectangle and what is across from it hide nothing together.
                self.look_at(&mut solid, [[false; 2], [true; 2], [true; 2]]);
                if solid.covered == NOTHING {
                    continue;
                }
                self.look_at(&mut solid, [[true; 2], [false; 2], [false; 2]]);
            }
            let adjacent = (0..3)
                .filter(|&axis| solid.covered[axis].contains(&true))
                .count();
            let has_more = |other: &Solid| {
                let pairs = solid
                    .covered
                    .as_flattened()
                    .iter()
                    .zip(other.covered.as_flattened());
                pairs.clone().any(|(mine, theirs)| *mine && !theirs)
            };
            if adjacent > 1 && solids.iter().all(has_more) {
                solids.push(solid);
            }
        }
        solids
    }

    /// Notes which of the wanted faces are covered.
    fn look_at(&self, solid: &mut Solid, wanted: [[bool; 2]; 3]) {
        for (axis, ends) in wanted.into_iter().enumerate() {
            for (i, side) in [-1.0, 1.0].into_iter().enumerate() {
                if ends[i] {
                    solid.covered[axis][i] = self.covers(solid, axis, side);
                }
            }
        }
    }

    /// How deep polygons at right angles to a rectangle reach that meet its border, deepest first.
    fn depths(&self, middle: DVec3, halves: [DVec3; 2], into: DVec3) -> Vec<f64> {
        let mut depths = Vec::new();
        for (i, out) in [halves[0], -halves[0], halves[1], -halves[1]]
            .into_iter()
            .enumerate()
        {
            let along = halves[1 - i / 2];
            let normal = out.normalize();
            let ends = [middle + out - along, middle + out + along];
            let border = Aabb::from_points(ends.map(DVec3::as_vec3));
            let plane = (ends[0].as_vec3(), normal.as_vec3());
            let reach = 2.0 * self.weld;
            self.tree
                .near(border, plane, reach as f32, MOST_VISITS, |polygon| {
                    let corners = self.scene.corners(polygon).map(Vec3::as_dvec3);
                    if corners
                        .iter()
                        .all(|&p| normal.dot(p - ends[0]).abs() <= reach)
                    {
                        let heights = corners.map(|p| into.dot(p - middle));
                        depths.push(heights.into_iter().fold(0.0, f64::max));
                    }
                });
        }
        depths.retain(|&depth| depth > LEAST_THICKNESS * self.weld);
        depths.sort_unstable_by(|a, b| b.total_cmp(a));
        depths.dedup_by(|next, kept| *kept - *next < self.weld);
        depths.truncate(MOST_DEPTHS);
        depths
    }

    /// Whether all points of a face are within [`REACH`] of polygons along it.
    fn covers(&self, solid: &Solid, axis: usize, side: f64) -> bool {
        let face = solid.face(axis, side);
        let [a, b, c, d] = face;
        let normal = (b - a).cross(d - a).normalize_or_zero();
        let bounds = Aabb::from_points(face.map(DVec3::as_vec3));
        let band = NEAR_FACE * self.weld;
        let mut facets = Vec::new();
        let complete = self.tree.near(
            bounds,
            (a.as_vec3(), normal.as_vec3()),
            2.0 * self.weld as f32,
            MOST_VISITS,
            |polygon| {
                let corners = self.scene.corners(polygon).map(Vec3::as_dvec3);
                let along = corners.iter().all(|&p| normal.dot(p - a).abs() <= band);
                let across = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
                if along && across.dot(normal).abs() > PARALLEL * across.length() {
                    let side = if across.dot(normal) > 0.0 {
                        Side::Front
                    } else {
                        Side::Back
                    };
                    facets.push(Facet { polygon, side });
                }
            },
        );
        if !complete || facets.is_empty() || facets.len() > MOST_POLYGONS {
            return false;
        }
        let reaches = |p: DVec3| facets.iter().any(|f| self.is_over(f.polygon, p, normal));
        if ![(a + c) * 0.5, a * 0.98 + c * 0.02, b * 0.98 + d * 0.02]
            .into_iter()
            .all(reaches)
        {
            return false;
        }
        facets.sort_unstable_by_key(|f| f.polygon);
        let Some(sheet) = Sheet::new(self.scene, &facets) else {
            return false;
        };
        let footprint = Footprint::new(&sheet, self.weld);
        if !footprint.planar {
            return false;
        }
        let along = sheet
            .frame
            .project(sheet.frame.origin + (b - a))
            .truncate()
            .normalize();
        let turned = footprint.turned(along);
        let flat = face.map(|p| sheet.frame.project(p));
        let height = flat.iter().fold(0.0f64, |h, p| h.max(p.z.abs())) + sheet.deviation;
        let turn = |p: DVec3| {
            let p = p.truncate();
            DVec2::new(along.dot(p), along.perp_dot(p))
        };
        let corners = flat.map(turn);
        let around = Rectangle {
            min: corners.iter().fold(corners[0], |m, &p| m.min(p)),
            max: corners.iter().fold(corners[0], |m, &p| m.max(p)),
        };
        let inset = INSET * self.weld;
        let sideways = std::f64::consts::SQRT_2 * (inset + CONTOUR_ERROR) + footprint.strip_reach;
        sideways.hypot(height) <= REACH * self.weld
            && turned.covers_rectangle(&around.inset(DVec2::splat(inset)))
    }

    /// Whether a point of a face projects into a polygon along it: a quick look before the union is built.
    fn is_over(&self, polygon: PolygonId, point: DVec3, normal: DVec3) -> bool {
        let [a, b, c] = self.scene.corners(polygon).map(Vec3::as_dvec3);
        let sides = [(a, b), (b, c), (c, a)]
            .map(|(p, q)| normal.dot((q - p).cross(point - p)) / (q - p).length());
        let slack = self.weld;
        sides.iter().all(|&s| s >= -slack) || sides.iter().all(|&s| s <= slack)
    }
}
