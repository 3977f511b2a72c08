//! Finds the solids that stand on surfaces (see [`Contacts`]).
//!
//! A front that lies within tau of another side and faces against it is either the foot of a solid that
//! stands there, or the other face of one thin sheet. The two look alike in the plane itself, but from
//! the rim of a foot the solid rises: just behind the front, the step outwards over its rim leaves
//! through a back. Sheets have nothing there, and two shells laid into each other are left and entered at once.

use super::contacts::Contacts;
use super::flat::{Flat, are_apart};
use super::model::Scene;
use super::overlap::Overlaps;
use super::polygon_tree::{MOST_VISITS, PolygonTree};
use super::side_graph::SideIndex;
use crate::math::{Aabb, PolygonId};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

/// How far behind a front the step over its rim is taken, in tau: beyond what counts as one plane.
const DEPTH: f64 = 8.0;
/// How far the step reaches to either side of the rim, in tau: solids that lean in by up to 83 degrees.
const REACH: f64 = 64.0;
/// Where along an edge steps are taken: two places that are no likely fractions of it, where
/// triangles of the rising wall would meet.
const PLACES: [f64; 2] = [0.371, 0.613];

/// The parts of sides of `scene` that solids hide by standing on them, and those that others own.
pub(super) fn find_contacts(tree: &PolygonTree, scene: &Scene, overlaps: &Overlaps) -> Contacts {
    let tau = scene.tau();
    let mut fronts: Vec<PolygonId> = overlaps.against.iter().map(|p| p.1).collect();
    fronts.sort_unstable();
    fronts.dedup();
    let feet = feet(scene, tree, tau, &fronts);
    let standing = (overlaps.against.iter()).filter(|(_, front)| feet.binary_search(front).is_ok());
    let mut hiding: Vec<_> = standing.chain(&overlaps.partly).copied().collect();
    hiding.sort_unstable();
    hiding.dedup();
    let mut covers: Vec<(SideIndex, [Vec3; 3])> = hiding
        .into_iter()
        .map(|(side, front)| (side, scene.corners(front)))
        .chain(overlaps.partly_by_pieces.iter().copied())
        .collect();
    covers.sort_by_key(|cover| cover.0);
    Contacts::new(2 * scene.polygons.len(), &covers, tau)
}

/// Polygons near the plane patch of `id`, without itself.
fn nearby(scene: &Scene, tree: &PolygonTree, tau: f32, id: PolygonId) -> Vec<PolygonId> {
    let corners = scene.corners(id);
    let [a, b, c] = corners.map(Vec3::as_dvec3);
    let normal = (b - a).cross(c - a).normalize_or_zero().as_vec3();
    let mut found = Vec::new();
    // Crowds in which the search is given up count as not touching.
    let bounds = Aabb::from_points(corners);
    let complete = tree.near(bounds, (corners[0], normal), tau, MOST_VISITS, |other| {
        if other != id {
            found.push(other);
        }
    });
    if !complete {
        found.clear();
    }
    found
}

/// Those of `fronts` (sorted) from whose rim a solid rises, and those that continue them in their plane.
fn feet(scene: &Scene, tree: &PolygonTree, tau: f32, fronts: &[PolygonId]) -> Vec<PolygonId> {
    let mut is_foot: Vec<bool> = fronts
        .par_iter()
        .map(|&front| rises_from(scene, tree, f64::from(tau), front))
        .collect();
    let mut open: Vec<usize> = (0..fronts.len()).filter(|&i| is_foot[i]).collect();
    while let Some(at) = open.pop() {
        let Some(own) = Flat::new(scene, fronts[at]) else {
            continue;
        };
        for other in nearby(scene, tree, tau, fronts[at]) {
            let Ok(next) = fronts.binary_search(&other) else {
                continue;
            };
            // Neighbours that touch: apart, but not by more than the strip.
            let touches = || {
                let lying = own.coplanar(scene, other, tau)?;
                Some(lying.same_way && !are_apart(&own.corners, &lying.corners, -tau))
            };
            if !is_foot[next] && touches() == Some(true) {
                is_foot[next] = true;
                open.push(next);
            }
        }
    }
    let feet = fronts.iter().zip(is_foot);
    feet.filter_map(|(&f, is_foot)| is_foot.then_some(f))
        .collect()
}

/// True when a step outwards over the rim of `front`, just behind it, leaves a solid.
fn rises_from(scene: &Scene, tree: &PolygonTree, tau: f64, front: PolygonId) -> bool {
    let corners = scene.corners(front).map(Vec3::as_dvec3);
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a).normalize_or_zero();
    (0..3).any(|i| {
        let (from, to) = (corners[i], corners[(i + 1) % 3]);
        let outwards = (to - from).cross(normal).normalize_or_zero() * (REACH * tau);
        PLACES.iter().any(|&place| {
            let over = from.lerp(to, place) - normal * (DEPTH * tau);
            leaves(scene, tree, tau, [over - outwards, over + outwards], normal) > 0
        })
    })
}

/// How many times the segment goes from a back to a front, less the times it goes the other way.
/// `normal` is perpendicular to it.
fn leaves(scene: &Scene, tree: &PolygonTree, tau: f64, [p, q]: [DVec3; 2], normal: DVec3) -> i32 {
    let bounds = Aabb::from_points([p.as_vec3(), q.as_vec3()]);
    let mut count = 0;
    let plane = (p.as_vec3(), normal.as_vec3());
    let complete = tree.near(bounds, plane, tau as f32, MOST_VISITS, |polygon| {
        let [a, b, c] = scene.corners(polygon).map(Vec3::as_dvec3);
        let facing = (b - a).cross(c - a);
        let (at_p, at_q) = (facing.dot(p - a), facing.dot(q - a));
        if (at_p < 0.0) == (at_q < 0.0) {
            return;
        }
        let along = q - p;
        let turns = [(a, b), (b, c), (c, a)].map(|(s, t)| along.dot((s - p).cross(t - p)));
        if turns.iter().all(|&t| t >= 0.0) || turns.iter().all(|&t| t <= 0.0) {
            count += if at_p < 0.0 { 1 } else { -1 };
        }
    });
    if complete { count } else { 0 }
}
