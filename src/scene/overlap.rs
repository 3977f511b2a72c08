//! Polygons that lie on each other: where two sides face the same way in one plane, both would receive
//! the same light. One of them owns the area; sides that others cover wholly receive nothing.
//!
//! Of two sides the emitting one comes first (a lamp set into a ceiling must shine), then a front
//! before a back, then the lower index.

use super::cover::{Cover, Cut, emits, precedence};
use super::facet::{Facet, Side};
use super::flat::{Flat, are_apart};
use super::layers::own_layers;
use super::model::Scene;
use super::polygon_tree::{MOST_VISITS, PolygonTree};
use super::side_graph::{SideIndex, side_index};
use super::uncovered::{Covered, Rest};
use crate::math::{Aabb, PolygonId};
use glam::Vec3;
use rayon::prelude::*;

/// What lies on what.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Overlaps {
    /// By polygon, front then back: whether others own the whole side.
    covered: Vec<bool>,
    /// Polygons whose front is wholly covered.
    pub covered_fronts: usize,
    /// Those of them that emit: another that emits lies there, and shines for both.
    pub covered_lamps: usize,
    /// Polygons whose front is covered in part.
    pub partly_covered_fronts: usize,
    /// Area of those parts over the area of all polygons.
    pub partly_covered_share: f64,
    /// Polygons in such crowds that the search was given up.
    pub unchecked: usize,
    /// Sides covered in part, each with a polygon that covers some of it, sorted.
    pub(super) partly: Vec<(SideIndex, PolygonId)>,
    /// Likewise with triangles, of sides that are covered by parts of polygons; sorted by side.
    pub(super) partly_by_pieces: Vec<(SideIndex, [Vec3; 3])>,
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

/// Finds the sides of `scene` that lie within tau of each other and face the same way.
pub fn find_overlaps(scene: &Scene) -> Overlaps {
    find_overlaps_by(&PolygonTree::new(scene), scene)
}

/// The same by the tree of the scene's polygons.
pub(super) fn find_overlaps_by(tree: &PolygonTree, scene: &Scene) -> Overlaps {
    let tau = scene.tau();
    let mut covers: Vec<Cover> = (0..scene.polygons.len())
        .into_par_iter()
        .map(|i| cover_of(scene, tree, tau, PolygonId::new(i)))
        .collect();
    own_layers(scene, tau, &mut covers);
    let mut overlaps = Overlaps {
        covered: Vec::with_capacity(2 * covers.len()),
        ..Overlaps::default()
    };
    let mut double = 0.0;
    for (i, cover) in covers.into_iter().enumerate() {
        let id = PolygonId::new(i);
        for cut in cover.cuts.iter().filter(|cut| cut.takes) {
            if cover.of(cut.on) != Covered::Wholly {
                let side = side_index(id, cut.on);
                overlaps.partly.push((side, cut.by.polygon));
            }
        }
        let pieces = cover.pieces.into_iter();
        overlaps
            .partly_by_pieces
            .extend(pieces.map(|(side, piece)| (side_index(id, side), piece)));
        let against = cover.against.into_iter().filter(|_| !cover.gave_up);
        overlaps
            .against
            .extend(against.map(|(side, front)| (side_index(id, side), front)));
        let [front, back] = cover.sides;
        overlaps.covered.push(front == Covered::Wholly);
        overlaps.covered.push(back == Covered::Wholly);
        overlaps.unchecked += usize::from(cover.gave_up);
        match front {
            Covered::No => {}
            Covered::Wholly => {
                overlaps.covered_fronts += 1;
                overlaps.covered_lamps += usize::from(emits(scene, id));
            }
            Covered::Partly(area) => {
                overlaps.partly_covered_fronts += 1;
                double += area;
            }
        }
    }
    overlaps.partly.sort_unstable();
    overlaps.partly_by_pieces.sort_by_key(|piece| piece.0);
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
    let mut rests = [Rest::new(&own, tau), Rest::new(&own, tau)];
    for other in nearby {
        let Some(lying) = own.coplanar(scene, other, tau) else {
            continue;
        };
        if are_apart(&own.corners, &lying.corners, tau) {
            continue;
        }
        let facing_it = if lying.same_way {
            Side::Back
        } else {
            Side::Front
        };
        cover.against.push((facing_it, other));
        for (on, rest) in [Side::Front, Side::Back].into_iter().zip(&mut rests) {
            let by = Facet {
                polygon: other,
                side: if lying.same_way { on } else { on.other() },
            };
            if precedence(scene, by)
                < precedence(
                    scene,
                    Facet {
                        polygon: id,
                        side: on,
                    },
                )
            {
                let takes = rest.subtract(&lying.corners);
                cover.cuts.push(Cut { on, by, takes });
            }
        }
    }
    cover.sides = rests.map(|rest| rest.judge());
    cover
}
