//! Elements as surfaces to sample: receivers uniformly by area, sources by the power that they have to shoot.
//!
//! Light and visibility go together (the lit part of a floor is the part that is not under the
//! furniture), so a visibility averaged over a source's area would be too low for its light.

use super::element::{Element, Shape};
use super::facet_frame::FacetFrame;
use super::patch_split::{BELOW_ONE, PatchSplit};
use super::radiosity::Shooter;
use crate::cluster::Hierarchy;
use crate::scene::{Facet, Scene};
use crate::visibility::{PointOctet, Surface, children_of_triangle};
use std::ops::Range;

/// A receiver.
pub struct ReceiverSurface<'a> {
    /// The element.
    pub element: &'a Element,
    /// Its scene.
    pub scene: &'a Scene,
    /// Its hierarchy.
    pub hierarchy: &'a Hierarchy,
    /// Where points on its facets lie.
    pub frames: &'a [FacetFrame],
    /// Sums of the areas before each facet.
    pub area_before: &'a [f64],
    /// First facets of all parts of a cluster but the first.
    pub parts: &'a [u32],
}

impl Surface for ReceiverSurface<'_> {
    #[inline(always)]
    fn points(&self, u: &[f32; 8], v: &[f32; 8], lanes: u32) -> PointOctet {
        let normal = self.element.normal;
        if let Shape::Triangle(corners) = self.element.shape {
            let mut points = PointOctet::of_triangle(corners, normal, u, v);
            let facet = self.hierarchy.facets[self.element.first_facet as usize];
            if self.scene.contacts.touches(facet, &self.element.bounds) {
                for l in 0..8 {
                    let hidden = self.scene.contacts.is_hidden(facet, points.position(l));
                    points.swallowed |= u8::from(hidden) << l;
                }
            }
            return points;
        }
        self.cluster_points(u, v, lanes)
    }

    #[inline(never)]
    fn parts(&self, u: &[f32; 8], v: &[f32; 8]) -> [u8; 8] {
        if self.element.is_triangle() {
            return children_of_triangle(u, v);
        }
        choose_parts(&self.element.facet_range(), self.area_before, self.parts, u)
    }
}

impl ReceiverSurface<'_> {
    #[inline(never)]
    fn cluster_points(&self, u: &[f32; 8], v: &[f32; 8], lanes: u32) -> PointOctet {
        let (centroid, normal) = (self.element.centroid, self.element.normal);
        let mut points = PointOctet::of_triangle([centroid; 3], normal, u, v);
        let range = self.element.facet_range();
        let (facets, rests) = choose_facets(&range, self.area_before, u, lanes);
        for l in 0..lanes as usize {
            let (frame, rest) = (&self.frames[facets[l]], rests[l]);
            points.set(l, frame.at(folded([rest, v[l]])), frame.normal);
            let hidden = frame.is_touched
                && self
                    .scene
                    .contacts
                    .is_hidden(frame.facet, points.position(l));
            points.swallowed |= u8::from(hidden) << l;
        }
        points
    }
}

/// A source.
pub struct SourceSurface<'a, const C: usize> {
    /// The element.
    pub element: &'a Element,
    /// Its scene.
    pub scene: &'a Scene,
    /// Its hierarchy.
    pub hierarchy: &'a Hierarchy,
    /// Where points on its facets lie.
    pub frames: &'a [FacetFrame],
    /// Sums of the unshot power before each facet.
    pub power_before: &'a [f64],
    /// What every owner's patches have to shoot.
    pub shooters: &'a [Shooter<C>],
    /// Whether each facet's light is even.
    pub is_even: &'a [bool],
    /// Owner of each facet.
    pub owner_of_facet: &'a [u32],
    /// First facet of each owner.
    pub first_facets: &'a [u32],
    /// Owner of a triangle.
    pub owner: u32,
    /// Frozen patch of a triangle.
    pub slot: u32,
}

impl<const C: usize> Surface for SourceSurface<'_, C> {
    #[inline(always)]
    fn points(&self, u: &[f32; 8], v: &[f32; 8], lanes: u32) -> PointOctet {
        let normal = self.element.normal;
        if let Shape::Triangle(corners) = self.element.shape {
            let shooter = &self.shooters[self.owner as usize];
            let mut points = match shooter.splits[self.slot as usize].is_even() {
                true => PointOctet::of_triangle(corners, normal, u, v),
                false => {
                    let [along, across] = lit_points(&shooter.splits, self.slot, u, v);
                    PointOctet::at(corners, normal, &along, &across)
                }
            };
            let facet = self.hierarchy.facets[self.element.first_facet as usize];
            if self.scene.contacts.touches(facet, &self.element.bounds) {
                (0..8).for_each(|l| self.hide(&mut points, l, facet));
            }
            return points;
        }
        self.cluster_points(u, v, lanes)
    }
}

impl<const C: usize> SourceSurface<'_, C> {
    #[inline(never)]
    fn cluster_points(&self, u: &[f32; 8], v: &[f32; 8], lanes: u32) -> PointOctet {
        let (centroid, normal) = (self.element.centroid, self.element.normal);
        let mut points = PointOctet::of_triangle([centroid; 3], normal, u, v);
        let range = self.element.facet_range();
        let (facets, rests) = choose_facets(&range, self.power_before, u, lanes);
        for l in 0..lanes as usize {
            let (facet, frame) = (facets[l], &self.frames[facets[l]]);
            let at = match self.is_even[facet] {
                true => folded([rests[l], v[l]]),
                false => {
                    let owner = self.owner_of_facet[facet];
                    let slot = facet as u32 - self.first_facets[owner as usize];
                    let splits = &self.shooters[owner as usize].splits;
                    lit_point(splits, slot, [rests[l], v[l]])
                }
            };
            points.set(l, frame.at(at), frame.normal);
            if frame.is_touched {
                self.hide(&mut points, l, frame.facet);
            }
        }
        points
    }

    /// Marks point `l` of `facet` where it is hidden. What a surface receives is what its open part receives, so
    /// that is where its light comes from; what it emits it emits everywhere.
    fn hide(&self, points: &mut PointOctet, l: usize, facet: Facet) {
        if !self.scene.contacts.is_hidden(facet, points.position(l)) {
            return;
        }
        if self.scene.emission(facet) == [0.0; 3] {
            points.absent |= 1 << l;
        } else {
            points.swallowed |= 1 << l;
        }
    }
}

/// Eight points of a frozen patch that is lit unevenly: down its split with `u`, by the children's light. In coordinates
/// along the first two edges from the patch's first corner.
#[inline(always)]
fn lit_points(splits: &[PatchSplit], slot: u32, u: &[f32; 8], v: &[f32; 8]) -> [[f32; 8]; 2] {
    let mut places = u.map(Place::of_patch);
    let mut patches = [slot; 8];
    // The first step is from the same patch for all.
    for l in 0..8 {
        patches[l] = places[l].descend(&splits[slot as usize]);
    }
    for l in 0..8 {
        while !splits[patches[l] as usize].is_even() {
            patches[l] = places[l].descend(&splits[patches[l] as usize]);
        }
    }
    let mut points = [[0.0; 8]; 2];
    for l in 0..8 {
        [points[0][l], points[1][l]] = places[l].point(v[l]);
    }
    points
}

/// One such point of a patch of any light.
#[inline(always)]
fn lit_point(splits: &[PatchSplit], mut patch: u32, [u, v]: [f32; 2]) -> [f32; 2] {
    let mut place = Place::of_patch(u);
    while !splits[patch as usize].is_even() {
        patch = place.descend(&splits[patch as usize]);
    }
    place.point(v)
}

/// Where on the way down a patch's split a point is. Every child has the patch's edges, halved, the middle one turned
/// about.
#[derive(Clone, Copy)]
struct Place {
    along: f32,
    across: f32,
    scale: f32,
    /// What is left of the choice.
    u: f32,
}

impl Place {
    #[inline(always)]
    fn of_patch(u: f32) -> Self {
        Self {
            along: 0.0,
            across: 0.0,
            scale: 1.0,
            u,
        }
    }

    /// One step down: the child of `split` that holds the share `u` of its light.
    #[inline(always)]
    fn descend(&mut self, split: &PatchSplit) -> u32 {
        let (which, rest) = split.choose(self.u);
        self.u = rest;
        let half = 0.5 * self.scale;
        self.along += if which & 1 == 1 { half } else { 0.0 };
        self.across += if which & 2 == 2 { half } else { 0.0 };
        self.scale = if which == 3 { -half } else { half };
        split.first + which
    }

    #[inline(always)]
    fn point(&self, v: f32) -> [f32; 2] {
        let [u, v] = folded([self.u, v]);
        [self.along + self.scale * u, self.across + self.scale * v]
    }
}

/// A point of the unit square, folded along its diagonal.
#[inline(always)]
fn folded([u, v]: [f32; 2]) -> [f32; 2] {
    match u + v > 1.0 {
        true => [1.0 - u, 1.0 - v],
        false => [u, v],
    }
}

/// Where in the sums of `before` over a cluster's facets each `u` in [0,1) falls.
#[inline(always)]
fn targets(facets: &Range<usize>, before: &[f64], u: &[f32; 8]) -> [f64; 8] {
    let (start, end) = (before[facets.start], before[facets.end]);
    u.map(|u| start + f64::from(u) * (end - start))
}

/// The parts that hold the facets which `choose_facets` would choose, by the first facets of all parts but the first.
#[inline(always)]
fn choose_parts(
    facets: &Range<usize>,
    before: &[f64],
    first_facets: &[u32],
    u: &[f32; 8],
) -> [u8; 8] {
    let target = targets(facets, before, u);
    let mut parts = [0; 8];
    for &first in first_facets {
        let before = before[first as usize];
        for l in 0..8 {
            parts[l] += u8::from(before <= target[l]);
        }
    }
    parts
}

/// Chooses facets of a cluster for the first `lanes` of eight `u` in proportion to what `before` sums, and what is left
/// of each `u` inside its facet; the other lanes mean nothing.
#[inline(always)]
fn choose_facets(
    facets: &Range<usize>,
    before: &[f64],
    u: &[f32; 8],
    lanes: u32,
) -> ([usize; 8], [f32; 8]) {
    let sums = &before[facets.start..=facets.end];
    let target = targets(facets, before, u);
    let mut chosen = [0; 8];
    match lanes {
        1..=2 => search::<2>(sums, &target, &mut chosen),
        3..=4 => search::<4>(sums, &target, &mut chosen),
        _ => search::<8>(sums, &target, &mut chosen),
    }
    let rests = std::array::from_fn(|l| {
        let share = sums[chosen[l] + 1] - sums[chosen[l]];
        let rest = if share > 0.0 {
            ((target[l] - sums[chosen[l]]) / share) as f32
        } else {
            0.5
        };
        rest.clamp(0.0, BELOW_ONE)
    });
    (chosen.map(|place| facets.start + place), rests)
}

/// The last place in front of which no more than the target lies, by halving. The `N` searches go in step, so that they
/// wait for the memory together.
#[inline(always)]
fn search<const N: usize>(sums: &[f64], target: &[f64; 8], chosen: &mut [usize; 8]) {
    let mut candidates = sums.len() - 1;
    while candidates > 1 {
        let half = candidates / 2;
        for l in 0..N {
            let middle = chosen[l] + half;
            chosen[l] = if sums[middle] <= target[l] {
                middle
            } else {
                chosen[l]
            };
        }
        candidates -= half;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::SampleSequence;
    use crate::solve::split_triangle;
    use glam::Vec3;

    #[test]
    fn points_of_a_triangle_lie_in_the_children_that_they_are_said_to() {
        let corners = [
            Vec3::new(0.1, 0.2, 0.0),
            Vec3::new(1.3, 0.1, 0.0),
            Vec3::new(0.4, 0.9, 0.0),
        ];
        let mut met = [0; 4];
        for index in (0..512).step_by(8) {
            let [u, v, ..] = SampleSequence::new(7).points(index);
            let points = PointOctet::of_triangle(corners, Vec3::Z, &u, &v);
            for (l, &which) in children_of_triangle(&u, &v).iter().enumerate() {
                let [a, b, c] = split_triangle(corners, u32::from(which));
                let p = points.position(l);
                for (from, to) in [(a, b), (b, c), (c, a)] {
                    assert!(
                        (to - from).cross(p - from).z > -1.0e-6,
                        "{p} is not in child {which}"
                    );
                }
                met[usize::from(which)] += 1;
            }
        }
        // A quarter each, within three standard deviations of random ones.
        assert!(met.iter().all(|&n| (98..=158).contains(&n)), "{met:?}");
    }

    #[test]
    fn parts_of_a_cluster_hold_the_facets_that_are_chosen() {
        // Some facets without area, as after rounding.
        let areas = [0.5, 0.0, 1.0, 3.0, 0.25, 0.0, 0.0, 2.0, 1.0, 0.125];
        let mut before = vec![0.0_f64; 5];
        for area in areas {
            before.push(before[before.len() - 1] + area);
        }
        let range = 4..4 + areas.len();
        let first_facets = [6, 8, 9, 12];
        for index in (0..512).step_by(8) {
            let [u, ..] = SampleSequence::new(3).points(index);
            let parts = choose_parts(&range, &before, &first_facets, &u);
            for lanes in [1, 2, 3, 4, 5, 8] {
                let (facets, rests) = choose_facets(&range, &before, &u, lanes);
                for l in 0..lanes as usize {
                    let (facet, area) = (facets[l], before[facets[l] + 1] - before[facets[l]]);
                    let place = before[facet] + f64::from(rests[l]) * area;
                    let target = f64::from(u[l]) * before[before.len() - 1];
                    assert!((place - target).abs() < 1.0e-6 && area > 0.0);
                    let met = first_facets.iter().filter(|&&f| f as usize <= facet);
                    assert_eq!(usize::from(parts[l]), met.count());
                }
            }
        }
    }
}
