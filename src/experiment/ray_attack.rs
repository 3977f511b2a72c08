//! Rays against a claim: half of them uniform over the two real surfaces, half aimed at what a wrong
//! claim would get wrong.
//!
//! For an occlusion claim those are segments by the border of the claimed rectangle, or by an edge of
//! the surface that it stands on; for a visibility claim, by a border of a polygon near the shaft. Embree answers, in robust
//! mode, trimmed as in the solver; what contradicts the claim is settled in exact arithmetic.

use super::claimed_occluder::ClaimedOccluder;
use super::dice::Dice;
use super::element_points::{ElementPoint, ElementPoints, Place, point_of};
use super::parts_cover::ROUNDING;
use super::polygon_boxes::{PolygonBoxes, nearest_on_segment};
use crate::cluster::Hierarchy;
use crate::embree::{CommittedScene, RayPacket8};
use crate::math::PolygonId;
use crate::scene::Scene;
use crate::solve::{Element, PreparedScene};
use crate::visibility::SceneTree;
use crate::visibility::exact::{SegmentStanding, judge_segment};
use glam::Vec3;

/// Polygons near a shaft that rays are aimed at: the nearest of those found.
const TARGETS: usize = 16;

/// Polygons looked at to find them.
const SEARCHED: usize = 512;

/// Tries to go from one element through a place to the other; then points drawn of each, of which the
/// best pair is cast.
const TRIES: usize = 3;

/// Least and greatest decade of how far beside a border rays are aimed, normalised: from far below the
/// weld distance up to a hundredth.
const NEAREST: f32 = -8.0;
const FARTHEST: f32 = -2.0;

/// How far the box of a pair is widened to look for polygons beside its shaft, as a share of its size.
const BESIDE: f32 = 0.05;

/// What rays are cast against.
pub(super) struct RayAttack<'a> {
    scene: &'a Scene,
    hierarchy: &'a Hierarchy,
    embree: &'a CommittedScene,
    polygons: &'a SceneTree,
    points: ElementPoints<'a>,
    boxes: PolygonBoxes,
    rays: u32,
}

/// A segment that refutes a claim, and what is sure of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Refutation {
    pub segment: [Vec3; 2],
    pub standing: SegmentStanding,
}

/// What the rays of one claim said.
#[derive(Clone, Debug, Default)]
pub(super) struct AttackOutcome {
    pub uniform: u64,
    pub aimed: u64,
    pub contradicted: u64,
    pub refutation: Option<Refutation>,
    pub standing: u64,
}

/// What the aimed rays aim at.
enum Target<'a> {
    Occluders(&'a [ClaimedOccluder<'a>]),
    Polygons(Vec<PolygonId>),
}

impl<'a> RayAttack<'a> {
    /// Ready to cast `rays` rays a claim.
    pub fn new(prepared: &'a PreparedScene, polygons: &'a SceneTree, rays: u32) -> Self {
        let (scene, hierarchy) = (&prepared.scene, &prepared.hierarchy);
        Self {
            scene,
            hierarchy,
            embree: &prepared.embree,
            polygons,
            points: ElementPoints::new(scene, hierarchy),
            boxes: PolygonBoxes::new(scene),
            rays,
        }
    }

    /// Attacks the claim that `occluders` hide `a` and `b` from each other (with `by_parts` each a part of the pair,
    /// where those that face away need none), or without any that the two see each other fully. `key` names the claim.
    pub fn attack(
        &self,
        [a, b]: [&Element; 2],
        occluders: &[ClaimedOccluder<'a>],
        by_parts: bool,
        key: u64,
    ) -> AttackOutcome {
        let mut outcome = AttackOutcome::default();
        let mut dice = Dice::new(key);
        let target = match occluders {
            [] => Target::Polygons(self.polygons_near(a, b)),
            _ => Target::Occluders(occluders),
        };
        let claimed_blocked = !occluders.is_empty();
        let uniform = self.rays.div_ceil(2);
        let mut index = 0;
        while index < self.rays {
            let mut packet = RayPacket8::EMPTY;
            let mut segments = [[Vec3::ZERO; 2]; 8];
            let mut active = 0u8;
            let lanes = (self.rays - index).min(8);
            for (lane, segment) in segments.iter_mut().enumerate().take(lanes as usize) {
                let is_uniform = index + (lane as u32) < uniform;
                let (from, to) = if is_uniform {
                    (
                        self.points.draw(a, Place::Inside, &mut dice),
                        self.points.draw(b, Place::Inside, &mut dice),
                    )
                } else {
                    self.aim([a, b], &target, &mut dice)
                };
                if by_parts && !carries_light(from, to, self.polygons.tolerance().tau) {
                    continue;
                }
                let Some([near, far]) = trimmed(from, to, self.polygons.tolerance().tau) else {
                    continue;
                };
                *segment = [from.position, to.position];
                packet.set(lane, from.position, to.position - from.position, near, far);
                active |= 1 << lane;
                match is_uniform {
                    true => outcome.uniform += 1,
                    false => outcome.aimed += 1,
                }
            }
            index += lanes;
            if active == 0 {
                continue;
            }
            let blocked = self.embree.occluded8(&mut packet, active);
            let wrong = match claimed_blocked {
                true => active & !blocked,
                false => active & blocked,
            };
            for lane in (0..8).filter(|lane| wrong & (1 << lane) != 0) {
                outcome.contradicted += 1;
                self.settle(segments[lane], claimed_blocked, &mut outcome);
            }
        }
        outcome
    }

    fn settle(&self, segment: [Vec3; 2], claimed_blocked: bool, outcome: &mut AttackOutcome) {
        let [p, q] = segment.map(Vec3::as_dvec3);
        let standing = judge_segment(self.polygons, p, q);
        let stands = match standing {
            SegmentStanding::Blocked(_) => !claimed_blocked,
            SegmentStanding::Clear => claimed_blocked,
            SegmentStanding::Between => false,
        };
        if stands {
            outcome.standing += 1;
            outcome
                .refutation
                .get_or_insert(Refutation { segment, standing });
        }
    }

    /// A segment that passes a place where a wrong claim would show: exactly, where a line from one
    /// element through that place meets the other, else as near as a few tries come.
    fn aim(
        &self,
        [a, b]: [&Element; 2],
        target: &Target,
        dice: &mut Dice,
    ) -> (ElementPoint, ElementPoint) {
        let any = |element: &Element, dice: &mut Dice| {
            let place = [Place::Corner, Place::Corner, Place::Edge, Place::Inside][dice.below(4)];
            self.points.draw(element, place, dice)
        };
        // A few rays go from border to border, whatever lies near.
        let place = (dice.below(8) != 0)
            .then(|| self.place(target, dice))
            .flatten();
        let Some(place) = place else {
            return (any(a, dice), any(b, dice));
        };
        for _ in 0..TRIES {
            let from = any(a, dice);
            let x = place.as_dvec3();
            if let Some(to) = self.points.draw_behind(b, from.position, x, dice) {
                return (from, to);
            }
        }
        let (from, to) = (
            [0; TRIES].map(|_| any(a, dice)),
            [0; TRIES].map(|_| any(b, dice)),
        );
        let mut best = (f32::INFINITY, from[0], to[0]);
        for p in from {
            for q in to {
                let nearest = nearest_on_segment(place, p.position, q.position);
                let miss = (place - nearest).length_squared();
                if miss < best.0 {
                    best = (miss, p, q);
                }
            }
        }
        (best.1, best.2)
    }

    /// A place to aim at, on or a little beside a border.
    fn place(&self, target: &Target, dice: &mut Dice) -> Option<Vec3> {
        let on =
            match target {
                Target::Occluders(occluders) => occluders[dice.below(occluders.len())]
                    .border_point(self.scene, self.hierarchy, dice),
                Target::Polygons(polygons) => {
                    let chosen = *polygons.get(dice.below(polygons.len().max(1)))?;
                    let place = [Place::Corner, Place::Edge, Place::Inside][dice.below(3)];
                    point_of(self.scene.corners(chosen), place, dice)
                }
            };
        let direction = Vec3::new(dice.unit(), dice.unit(), dice.unit()) - 0.5;
        let decades = NEAREST + (FARTHEST - NEAREST) * dice.unit();
        Some(on + direction * 10.0f32.powf(decades))
    }

    fn polygons_near(&self, a: &Element, b: &Element) -> Vec<PolygonId> {
        let mut bounds = a.bounds.union(b.bounds);
        let margin = (bounds.max - bounds.min) * BESIDE;
        bounds.min -= margin;
        bounds.max += margin;
        let mut found = Vec::new();
        self.boxes.meeting(bounds, SEARCHED, &mut found);
        let middle = [a.centroid, b.centroid];
        let mut found: Vec<(f32, PolygonId)> = found
            .into_iter()
            .map(|id| (self.boxes.distance(id, middle), id))
            .collect();
        found.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
        found.truncate(TARGETS);
        found.into_iter().map(|(_, id)| id).collect()
    }
}

/// True where each end lies so far before the other's plane that the two do not face away from each other.
fn carries_light(from: ElementPoint, to: ElementPoint, tau: f32) -> bool {
    let direction = (to.position - from.position).as_dvec3();
    let leaving = from.normal.as_dvec3().dot(direction);
    let arriving = -to.normal.as_dvec3().dot(direction);
    leaving.min(arriving) > f64::from(tau) + ROUNDING
}

/// Where a segment is deeper than `tau` below the planes of both its ends, as fractions; `None` where
/// it nowhere is.
fn trimmed(from: ElementPoint, to: ElementPoint, tau: f32) -> Option<[f32; 2]> {
    let direction = to.position - from.position;
    let near = tau / from.normal.dot(direction).abs();
    let far = 1.0 - tau / to.normal.dot(direction).abs();
    (near < far).then_some([near, far])
}
