//! Replay of a claim that rests on parts: that the parts that were proved hidden, and those that face away from each
//! other, make up the whole pair (design, section 7, point 6).
//!
//! The tree of parts is built anew from the pair, patches by halving their edges and clusters from the hierarchy, and
//! is followed down to the parts that the claim names. That these are hidden is replayed for each of them elsewhere.

use crate::cluster::Hierarchy;
use crate::scene::Scene;
use crate::solve::{Element, ElementName, ProvedPair, Shape};
use glam::{DVec3, Vec3};
use std::collections::HashSet;

/// Splits from a pair down to its parts that are followed: more than any search makes.
const MOST_SPLITS: u32 = 16;

/// Rounding of a height that the solver takes of a point over a plane in f32, normalised: six operations on numbers
/// below 2, and a normal whose components are wrong by half a unit in the last place, stay below 2^-21; twice that.
pub(super) const ROUNDING: f64 = 1.0 / (1 << 20) as f64;

/// A pair of names.
type Ends = (ElementName, ElementName);

/// What parts of a pair are checked against.
pub(super) struct PartsCover<'a> {
    scene: &'a Scene,
    hierarchy: &'a Hierarchy,
    tau: f64,
}

impl<'a> PartsCover<'a> {
    pub fn new(scene: &'a Scene, hierarchy: &'a Hierarchy) -> Self {
        Self {
            scene,
            hierarchy,
            tau: f64::from(scene.tau()),
        }
    }

    /// A part of the pair that is neither named by the claim nor faces away.
    pub fn find_gap(&self, pair: &ProvedPair) -> Option<[Element; 2]> {
        let named: HashSet<Ends> = pair.parts.iter().map(|p| (p.source, p.receiver)).collect();
        let ends = pair.claim.elements(self.scene, self.hierarchy);
        self.gap_in(&ends[0], &ends[1], &named, MOST_SPLITS)
    }

    fn gap_in(
        &self,
        source: &Element,
        receiver: &Element,
        named: &HashSet<Ends>,
        splits: u32,
    ) -> Option<[Element; 2]> {
        let gap = || Some([*source, *receiver]);
        if named.contains(&(source.name(), receiver.name()))
            || self.faces_away(source, receiver)
            || self.faces_away(receiver, source)
        {
            return None;
        }
        if splits == 0 {
            return gap();
        }
        // The larger end is split, as in the search; by any other order of splits a claim would be refused, not believed.
        let by_source = source.area >= receiver.area;
        let parts = self.parts_of(if by_source { source } else { receiver });
        if parts.is_empty() {
            return gap();
        }
        parts.iter().find_map(|part| match by_source {
            true => self.gap_in(part, receiver, named, splits - 1),
            false => self.gap_in(source, part, named, splits - 1),
        })
    }

    fn parts_of(&self, element: &Element) -> Vec<Element> {
        match element.shape {
            Shape::Triangle(corners) => (0..4)
                .map(|which| element.triangle_child(corners, which))
                .collect(),
            _ => (self.hierarchy.children(element.node).into_iter().flatten())
                .map(|id| Element::of_node(self.scene, self.hierarchy, id))
                .collect(),
        }
    }

    /// True where no point of `to` lies farther than tau before the plane of any polygon of `from`.
    fn faces_away(&self, from: &Element, to: &Element) -> bool {
        let bounds = to.shaft_bounds();
        let corners: Vec<DVec3> = bounds.corners().map(Vec3::as_dvec3).collect();
        from.facet_range().all(|facet| {
            let facet = self.hierarchy.facets[facet];
            let [a, b, c] = self.scene.facet_corners(facet).map(Vec3::as_dvec3);
            let normal = (b - a).cross(c - a).normalize_or_zero();
            (corners.iter()).all(|&p| normal.dot(p - a) <= self.tau + ROUNDING)
        })
    }
}
