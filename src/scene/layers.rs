//! Sides that lie on sides that others own: sheets in more than two layers, each within tau of the next but not of all.
//!
//! To own an area is to own it for those within tau. So what lies on a side takes only what that side owns itself, and a
//! third sheet that lies within tau of a second, but not of the first that owns the second, keeps its light. Where all that
//! overlap lie within tau of each other it comes to the same, and nothing is done here.

use super::convex::area;
use super::cover::{Cover, Cut, precedence};
use super::facet::{Facet, Side};
use super::flat::{Flat, are_apart};
use super::model::Scene;
use super::uncovered::{Covered, Rest};
use crate::math::PolygonId;
use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;
use std::collections::HashMap;

/// Judges sides anew that are covered by what others own that do not lie on them.
pub(super) fn own_layers(scene: &Scene, tau: f32, covers: &mut [Cover]) {
    let mut layered: Vec<Facet> = (0..covers.len())
        .into_par_iter()
        .filter(|&i| !covers[i].cuts.is_empty())
        .flat_map_iter(|i| {
            let polygon = PolygonId::new(i);
            let sides = [Side::Front, Side::Back].into_iter();
            let facets = sides.map(move |side| Facet { polygon, side });
            facets.filter(|&facet| lies_on_layers(scene, tau, covers, facet))
        })
        .collect();
    // Whoever comes before a side is judged before it.
    layered.sort_by_key(|&facet| precedence(scene, facet));
    let mut owned = HashMap::new();
    for facet in layered {
        judge_anew(scene, tau, covers, &mut owned, facet);
    }
}

fn cuts_on(covers: &[Cover], facet: Facet) -> impl Iterator<Item = &Cut> {
    let cuts = covers[facet.polygon.index()].cuts.iter();
    cuts.filter(move |cut| cut.on == facet.side)
}

/// True where something that has a part of what lies on `facet` overlaps it without lying on it.
fn lies_on_layers(scene: &Scene, tau: f32, covers: &[Cover], facet: Facet) -> bool {
    let mut own = None;
    cuts_on(covers, facet).any(|upper| {
        cuts_on(covers, upper.by).any(|lower| {
            let at = covers[facet.polygon.index()]
                .cuts
                .binary_search_by_key(&lower.by.polygon, |cut| cut.by.polygon);
            if !lower.takes || at.is_ok() {
                return false;
            }
            let own = own.get_or_insert_with(|| Flat::new(scene, facet.polygon));
            own.as_ref().is_some_and(|own| {
                let corners = scene.corners(lower.by.polygon).map(Vec3::as_dvec3);
                let seen = counter_clockwise(corners.map(|p| own.project(p)));
                !are_apart(&own.corners, &seen, tau)
            })
        })
    })
}

fn counter_clockwise([a, b, c]: [DVec2; 3]) -> [DVec2; 3] {
    if (b - a).perp_dot(c - a) >= 0.0 {
        [a, b, c]
    } else {
        [a, c, b]
    }
}

/// Convex polygons in space.
type Pieces = Vec<Vec<DVec3>>;

/// Covers `facet` only by what those that lie on it own, of whom all that `owned` does not hold are judged already.
fn judge_anew(
    scene: &Scene,
    tau: f32,
    covers: &mut [Cover],
    owned: &mut HashMap<Facet, Pieces>,
    facet: Facet,
) {
    let Some(own) = Flat::new(scene, facet.polygon) else {
        return;
    };
    let mut rest = Rest::new(&own, tau);
    let mut taken = Vec::new();
    let cutters: Vec<Facet> = cuts_on(covers, facet).map(|cut| cut.by).collect();
    for by in cutters {
        let pieces = owned
            .entry(by)
            .or_insert_with(|| owned_by(scene, tau, covers, by));
        for piece in pieces {
            let mut flat: Vec<DVec2> = piece.iter().map(|&p| own.project(p)).collect();
            if signed_area(&flat) < 0.0 {
                flat.reverse();
            }
            if area(&flat) > 0.0 && rest.subtract(&flat) {
                taken.extend((1..piece.len() - 1).map(|i| {
                    let triangle = [piece[0], piece[i], piece[i + 1]];
                    (facet.side, triangle.map(|p| p.as_vec3()))
                }));
            }
        }
    }
    let covered = rest.judge();
    let lift = |piece: &Vec<DVec2>| piece.iter().map(|&p| own.lift(p)).collect();
    owned.insert(facet, rest.pieces.iter().map(lift).collect());
    let cover = &mut covers[facet.polygon.index()];
    cover.sides[usize::from(facet.side == Side::Back)] = covered;
    for cut in cover.cuts.iter_mut().filter(|cut| cut.on == facet.side) {
        cut.takes = false;
    }
    if covered != Covered::Wholly {
        cover.pieces.extend(taken);
    }
}

/// What of itself a side owns that lies on no layers.
fn owned_by(scene: &Scene, tau: f32, covers: &[Cover], facet: Facet) -> Pieces {
    let corners = |polygon| scene.corners(polygon).map(Vec3::as_dvec3);
    match covers[facet.polygon.index()].of(facet.side) {
        Covered::No => vec![corners(facet.polygon).to_vec()],
        Covered::Wholly => Vec::new(),
        Covered::Partly(_) => {
            let Some(own) = Flat::new(scene, facet.polygon) else {
                return Vec::new();
            };
            let mut rest = Rest::new(&own, tau);
            for cut in cuts_on(covers, facet).filter(|cut| cut.takes) {
                let flat = corners(cut.by.polygon).map(|p| own.project(p));
                rest.subtract(&counter_clockwise(flat));
            }
            let lift = |piece: &Vec<DVec2>| piece.iter().map(|&p| own.lift(p)).collect();
            rest.pieces.iter().map(lift).collect()
        }
    }
}

fn signed_area(polygon: &[DVec2]) -> f64 {
    let origin = polygon[0];
    let edges = polygon.windows(2);
    edges
        .map(|e| (e[0] - origin).perp_dot(e[1] - origin))
        .sum::<f64>()
        / 2.0
}
