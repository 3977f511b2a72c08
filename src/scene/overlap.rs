//! Polygons that lie on each other: where two sides face the same way in one plane, both would receive
//! the same light. One of them owns the area; sides that others cover wholly receive nothing.
//!
//! Of two sides the emitting one comes first (a lamp set into a ceiling must shine), then a front
//! before a back, then the lower index.

use super::convex::{area, perimeter, split};
use super::facet::{Facet, Side};
use super::flat::{Flat, are_apart};
use super::model::Scene;
use super::polygon_tree::{MOST_VISITS, PolygonTree};
use super::side_graph::{SideIndex, side_index};
use crate::math::{Aabb, PolygonId};
use glam::DVec2;
use rayon::prelude::*;

/// Pieces into which the uncovered rest of a polygon may fall before it counts as partly covered.
const MOST_PIECES: usize = 256;

/// What lies on what.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlaps {
    /// By polygon, front then back: whether others own the whole side.
    covered: Vec<bool>,
    /// Polygons whose front is wholly covered.
    pub covered_fronts: usize,
    /// Polygons whose front is covered in part.
    pub partly_covered_fronts: usize,
    /// Area of those parts over the area of all polygons.
    pub partly_covered_share: f64,
    /// Polygons in such crowds that the search was given up.
    pub unchecked: usize,
    /// Sides covered in part, each with a polygon that covers some of it, sorted.
    pub(super) partly: Vec<(SideIndex, PolygonId)>,
    /// Sides against which the fronts of others lie within tau, each with one of those, sorted. None of polygons whose
    /// search was given up.
    pub(super) against: Vec<(SideIndex, PolygonId)>,
}

impl Overlaps {
    /// Whether other sides own the whole of this one.
    pub fn is_covered(&self, facet: Facet) -> bool {
        self.covered[side_index(facet.polygon, facet.side) as usize]
    }
}

/// What is found about one polygon.
#[derive(Default)]
struct Cover {
    front: Covered,
    back: Covered,
    /// Sides, and the polygons that own parts of them.
    owners: Vec<(Side, PolygonId)>,
    /// Sides, and the polygons whose fronts lie against them.
    against: Vec<(Side, PolygonId)>,
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
    find_overlaps_by(&PolygonTree::new(scene), scene)
}

/// The same by the tree of the scene's polygons.
pub(super) fn find_overlaps_by(tree: &PolygonTree, scene: &Scene) -> Overlaps {
    let tau = scene.tau();
    let covers: Vec<Cover> = (0..scene.polygons.len())
        .into_par_iter()
        .map(|i| cover_of(scene, tree, tau, PolygonId::new(i)))
        .collect();
    let mut overlaps = Overlaps {
        covered: Vec::with_capacity(2 * covers.len()),
        ..Overlaps::default()
    };
    let mut double = 0.0;
    for (i, cover) in covers.into_iter().enumerate() {
        let id = PolygonId::new(i);
        for (side, owner) in cover.owners {
            let whole = match side {
                Side::Front => cover.front,
                Side::Back => cover.back,
            };
            if whole != Covered::Wholly {
                overlaps.partly.push((side_index(id, side), owner));
            }
        }
        let against = cover.against.into_iter().filter(|_| !cover.gave_up);
        overlaps
            .against
            .extend(against.map(|(side, front)| (side_index(id, side), front)));
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
    overlaps.partly.sort_unstable();
    overlaps.against.sort_unstable();
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
        let [on_front, on_back] = if lying.same_way {
            [Side::Front, Side::Back]
        } else {
            [Side::Back, Side::Front]
        };
        let facing_it = if lying.same_way {
            Side::Back
        } else {
            Side::Front
        };
        cover.against.push((facing_it, other));
        if first(Side::Front, on_front) && front.subtract(&lying.corners) {
            cover.owners.push((Side::Front, other));
        }
        if first(Side::Back, on_back) && back.subtract(&lying.corners) {
            cover.owners.push((Side::Back, other));
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

    /// Takes `cutter` away; false where it takes nothing more.
    fn subtract(&mut self, cutter: &[DVec2; 3]) -> bool {
        if self.too_many
            || !self
                .pieces
                .iter()
                .any(|p| self.matters(&split(p, cutter).0))
        {
            return false;
        }
        let mut left = Vec::new();
        for piece in &self.pieces {
            let (_, outside) = split(piece, cutter);
            left.extend(outside.into_iter().filter(|p| self.matters(p)));
        }
        self.pieces = left;
        self.too_many = self.pieces.len() > MOST_PIECES;
        true
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
