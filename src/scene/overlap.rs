//! Polygons that lie on each other: where two sides face the same way in one plane, both would receive
//! the same light. One of them owns the area; sides that others cover wholly receive nothing.
//!
//! Of two sides the emitting one comes first (a lamp set into a ceiling must shine), then a front
//! before a back, then the lower index.

use super::convex::{area, perimeter, split};
use super::model::{Facet, Scene, Side};
use super::polygon_tree::PolygonTree;
use super::side_graph::side_index;
use crate::math::{Aabb, PolygonId};
use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;

/// Polygons with a smaller altitude are left alone: in f32 their facing is noise, and their area does
/// not matter to a scene of size 1.
const LEAST_ALTITUDE: f64 = 1e-5;

/// Nodes that the search around one polygon may visit. Meshes need about a hundred; only crowds
/// in which every box meets every other need more, and must not cost quadratic time.
const MOST_VISITS: usize = 4096;

/// Pieces into which the uncovered rest of a polygon may fall before it counts as partly covered.
const MOST_PIECES: usize = 256;

/// What lies on what.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlaps {
    /// By polygon, front then back: whether others own the whole side.
    covered: Vec<bool>,
    /// Polygons whose front is wholly covered.
    pub covered_fronts: usize,
    /// Polygons whose front is covered in part: their power is counted twice there.
    pub partly_covered_fronts: usize,
    /// Area of those parts over the area of all polygons.
    pub partly_covered_share: f64,
    /// Polygons in such crowds that the search was given up.
    pub unchecked: usize,
}

impl Overlaps {
    /// Whether other sides own the whole of this one.
    pub fn is_covered(&self, facet: Facet) -> bool {
        self.covered[side_index(facet.polygon, facet.side) as usize]
    }
}

/// What is found about one polygon.
#[derive(Clone, Copy, Default)]
struct Cover {
    front: Covered,
    back: Covered,
    gave_up: bool,
}

#[derive(Clone, Copy, Default, PartialEq)]
enum Covered {
    #[default]
    No,
    /// With the covered area.
    Partly(f64),
    Wholly,
}

/// Finds the sides of `scene` that lie within tau of each other and face the same way.
pub fn find_overlaps(scene: &Scene) -> Overlaps {
    let tree = PolygonTree::new(scene);
    let tau = scene.tau();
    let covers: Vec<Cover> = (0..scene.polygons.len())
        .into_par_iter()
        .map(|i| cover_of(scene, &tree, tau, PolygonId::new(i)))
        .collect();
    let mut overlaps = Overlaps {
        covered: Vec::with_capacity(2 * covers.len()),
        ..Overlaps::default()
    };
    let mut double = 0.0;
    for cover in covers {
        overlaps.covered.push(cover.front == Covered::Wholly);
        overlaps.covered.push(cover.back == Covered::Wholly);
        overlaps.unchecked += usize::from(cover.gave_up);
        match cover.front {
            Covered::No => {}
            Covered::Wholly => overlaps.covered_fronts += 1,
            Covered::Partly(area) => {
                overlaps.partly_covered_fronts += 1;
                double += area;
            }
        }
    }
    let whole: f64 = (0..scene.polygons.len())
        .map(|i| scene.polygon_area(PolygonId::new(i)))
        .sum();
    overlaps.partly_covered_share = double / whole;
    overlaps
}

fn cover_of(scene: &Scene, tree: &PolygonTree, tau: f32, id: PolygonId) -> Cover {
    let mut cover = Cover::default();
    let Some(own) = Flat::new(scene, id) else {
        return cover;
    };
    let bounds = Aabb::from_points(scene.corners(id));
    let plane = (scene.corners(id)[0], own.normal.as_vec3());
    let mut nearby = Vec::new();
    cover.gave_up = !tree.near(bounds, plane, tau, MOST_VISITS, |other| {
        if other != id {
            nearby.push(other);
        }
    });
    nearby.sort_unstable();
    let mut front = Rest::new(&own, tau);
    let mut back = Rest::new(&own, tau);
    for other in nearby {
        let Some(lying) = own.coplanar(scene, other, tau) else {
            continue;
        };
        if are_apart(&own.corners, &lying.corners, tau) {
            continue;
        }
        let first =
            |side, other_side| precedence(scene, other, other_side) < precedence(scene, id, side);
        if lying.same_way {
            if first(Side::Front, Side::Front) {
                front.subtract(&lying.corners);
            }
            if first(Side::Back, Side::Back) {
                back.subtract(&lying.corners);
            }
        } else {
            if first(Side::Back, Side::Front) {
                back.subtract(&lying.corners);
            }
            if first(Side::Front, Side::Back) {
                front.subtract(&lying.corners);
            }
        }
    }
    cover.front = front.judge();
    cover.back = back.judge();
    cover
}

/// Which of two sides owns what they share: the lesser.
fn precedence(scene: &Scene, polygon: PolygonId, side: Side) -> (bool, Side, PolygonId) {
    let dark = side == Side::Back || scene.surface(polygon).emission == [0.0; 3];
    (dark, side, polygon)
}

/// A polygon laid flat into its own plane.
struct Flat {
    origin: DVec3,
    normal: DVec3,
    u: DVec3,
    v: DVec3,
    corners: [DVec2; 3],
}

/// Another polygon in that plane.
struct Lying {
    /// Counter-clockwise seen from the front of the first.
    corners: [DVec2; 3],
    same_way: bool,
}

impl Flat {
    /// `None` for polygons whose normal is noise.
    fn new(scene: &Scene, id: PolygonId) -> Option<Self> {
        let [a, b, c] = scene.corners(id).map(Vec3::as_dvec3);
        let doubled = (b - a).cross(c - a);
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        if doubled.length() < LEAST_ALTITUDE * longest {
            return None;
        }
        let normal = doubled.normalize();
        let (u, v) = normal.any_orthonormal_pair();
        let mut flat = Self {
            origin: a,
            normal,
            u,
            v,
            corners: [DVec2::ZERO; 3],
        };
        flat.corners = [a, b, c].map(|p| flat.project(p));
        // Whichever way the pair turns.
        if flat.turn(&flat.corners) < 0.0 {
            std::mem::swap(&mut flat.u, &mut flat.v);
            flat.corners = [a, b, c].map(|p| flat.project(p));
        }
        Some(flat)
    }

    fn project(&self, p: DVec3) -> DVec2 {
        DVec2::new(self.u.dot(p - self.origin), self.v.dot(p - self.origin))
    }

    fn turn(&self, [a, b, c]: &[DVec2; 3]) -> f64 {
        (b - a).perp_dot(c - a)
    }

    fn height(&self, p: DVec3) -> f64 {
        self.normal.dot(p - self.origin).abs()
    }

    /// The other polygon, if it lies within `tau` of this one's plane, or this one of its: a small
    /// polygon's plane says little about where a large one lies.
    fn coplanar(&self, scene: &Scene, other: PolygonId, tau: f32) -> Option<Lying> {
        let tau = f64::from(tau);
        let corners = scene.corners(other).map(Vec3::as_dvec3);
        let [a, b, c] = corners;
        let larger = (b - a).cross(c - a).length_squared()
            > (self.corners[1] - self.corners[0])
                .perp_dot(self.corners[2] - self.corners[0])
                .powi(2);
        let within = corners.iter().all(|&p| self.height(p) <= tau)
            || larger && {
                let its = Self::new(scene, other)?;
                its.normal.dot(self.normal).abs() > 0.999
                    && self
                        .corners
                        .iter()
                        .all(|p| its.height(self.origin + self.u * p.x + self.v * p.y) <= tau)
            };
        if !within {
            return None;
        }
        let [a, b, c] = corners.map(|p| self.project(p));
        let turn = self.turn(&[a, b, c]);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        if turn.abs() < LEAST_ALTITUDE * longest {
            return None;
        }
        let same_way = turn > 0.0;
        Some(Lying {
            corners: if same_way { [a, b, c] } else { [a, c, b] },
            same_way,
        })
    }
}

/// Whether an edge of one of two triangles has all of the other beyond it, but for a strip of `tau`: so
/// it is with the neighbours in a mesh, which need no clipping.
fn are_apart(a: &[DVec2; 3], b: &[DVec2; 3], tau: f32) -> bool {
    let parts = |a: &[DVec2; 3], b: &[DVec2; 3]| {
        (0..3).any(|i| {
            let (from, along) = (a[i], a[(i + 1) % 3] - a[i]);
            let strip = f64::from(tau) * along.length();
            b.iter().all(|&p| along.perp_dot(p - from) < strip)
        })
    };
    parts(a, b) || parts(b, a)
}

/// What is left of a side after others have taken their parts.
struct Rest {
    pieces: Vec<Vec<DVec2>>,
    whole: f64,
    /// Strips narrower than twice this are the rounding of shared edges.
    width: f64,
    too_many: bool,
}

impl Rest {
    fn new(own: &Flat, tau: f32) -> Self {
        Self {
            pieces: vec![own.corners.to_vec()],
            whole: area(&own.corners),
            width: f64::from(tau),
            too_many: false,
        }
    }

    fn subtract(&mut self, cutter: &[DVec2; 3]) {
        if self.too_many
            || !self
                .pieces
                .iter()
                .any(|p| self.matters(&split(p, cutter).0))
        {
            return;
        }
        let mut left = Vec::new();
        for piece in &self.pieces {
            let (_, outside) = split(piece, cutter);
            left.extend(outside.into_iter().filter(|p| self.matters(p)));
        }
        self.pieces = left;
        self.too_many = self.pieces.len() > MOST_PIECES;
    }

    /// Whether a part is more than a strip along an edge.
    fn matters(&self, piece: &[DVec2]) -> bool {
        area(piece) > self.width * perimeter(piece)
    }

    fn judge(&self) -> Covered {
        let left: f64 = self.pieces.iter().map(|p| area(p)).sum();
        if self.pieces.is_empty() {
            Covered::Wholly
        } else if left < self.whole * (1.0 - 1e-9) {
            Covered::Partly(self.whole - left)
        } else {
            Covered::No
        }
    }
}
