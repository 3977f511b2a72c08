//! What all tasks of a pass share and only read, and how a pair is sampled from it.

use super::config::SolveConfig;
use super::element::Element;
use super::facet_frame::FacetFrame;
use super::flux_tree::FluxTree;
use super::guarantees::Guarantees;
use super::observer::Observer;
use super::oracle::Oracle;
use super::pair::{Source, Target, exchange_key};
use super::radiosity::Shooter;
use super::sampled_element::{ReceiverSurface, SourceSurface};
use crate::cluster::Hierarchy;
use crate::embree::CommittedScene;
use crate::math::hash_u64;
use crate::scene::Scene;
use crate::visibility::{
    SampledLight, SampledVisibility, SegmentTest, look_for_light, sample_visibility,
};
use glam::Vec3;
use pulp::Arch;

/// Beside the rounds of samples (0, 1) and the choice of those that are measured again (2).
const LOTS: u64 = 3;

/// What stays the same during a solve.
#[derive(Clone, Copy)]
pub struct SolveContext<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its hierarchy.
    pub hierarchy: &'a Hierarchy,
    /// Its polygons, in Embree.
    pub embree: &'a CommittedScene,
    /// What the guaranteed tests stand on, where the technique asks for them.
    pub guarantees: Option<&'a Guarantees>,
    /// The element of each node.
    pub elements: &'a [Element],
    /// The hierarchy, for sums over a cluster.
    pub flux_tree: &'a FluxTree,
    /// Where points on each facet lie.
    pub frames: &'a [FacetFrame],
    /// How many facets before each are touched by solids, and all at the end.
    pub touched_before: &'a [u32],
    /// Sum of the areas of the facets before each facet, and of all at the end.
    pub area_before: &'a [f64],
    /// Area of the scene, one side of each polygon, normalised.
    pub polygon_area: f64,
    /// Depth below a surface within which nothing blocks, normalised.
    pub tau: f32,
    /// Who watches.
    pub observer: &'a dyn Observer,
}

impl SolveContext<'_> {
    /// True when no solid that stands on a triangle or cluster hides any of it.
    pub(super) fn is_open(&self, element: &Element) -> bool {
        if element.is_triangle() {
            let facet = self.hierarchy.facets[element.first_facet as usize];
            return !self.scene.contacts.touches(facet, &element.bounds);
        }
        let range = element.facet_range();
        self.touched_before[range.start] == self.touched_before[range.end]
    }
}

/// What stays the same during a pass.
#[derive(Clone, Copy)]
pub(super) struct Pass<'a, const C: usize> {
    pub(super) context: SolveContext<'a>,
    pub(super) shooters: &'a [Shooter<C>],
    pub(super) node_unshot: &'a [[f32; C]],
    pub(super) node_variance: &'a [f32],
    pub(super) node_moment: &'a [[Vec3; C]],
    pub(super) power_before: &'a [f64],
    pub(super) is_even: &'a [bool],
    pub(super) owner_of_facet: &'a [u32],
    pub(super) first_facets: &'a [u32],
    pub(super) oracle: Oracle,
    pub(super) config: &'a SolveConfig,
    pub(super) pass: u32,
    /// Hash of the seed and the pass.
    pub(super) key: u64,
    pub(super) arch: Arch,
}

impl<const C: usize> Pass<'_, C> {
    /// Draws the lot of a pair: true with this chance, by its name alone, so that every technique draws the same.
    pub(super) fn wins(&self, source: &Element, receiver: &Element, chance: f64) -> bool {
        let key = exchange_key(self.key.wrapping_add(LOTS), source, receiver);
        // The upper 53 bits, as a fraction of one.
        ((hash_u64(key) >> 11) as f64) < chance * (1u64 << 53) as f64
    }

    /// The two ends of a pair as surfaces to sample.
    fn surfaces<'p>(
        &'p self,
        source: &Source<'p>,
        receiver: Target<'p>,
    ) -> (SourceSurface<'p, C>, ReceiverSurface<'p>) {
        let context = self.context;
        let source = SourceSurface {
            element: source.element,
            scene: context.scene,
            hierarchy: context.hierarchy,
            frames: context.frames,
            power_before: self.power_before,
            shooters: self.shooters,
            is_even: self.is_even,
            owner_of_facet: self.owner_of_facet,
            first_facets: self.first_facets,
            owner: source.owner,
            slot: source.slot,
        };
        let receiver = ReceiverSurface {
            element: receiver.element,
            scene: context.scene,
            hierarchy: context.hierarchy,
            frames: context.frames,
            area_before: context.area_before,
            parts: receiver.parts,
        };
        (source, receiver)
    }

    /// Names the samples of a pair.
    fn sample_key(&self, source: &Source, receiver: Target, round: u64) -> u64 {
        let pass_key = self.key.wrapping_add(round);
        exchange_key(pass_key, source.element, receiver.element)
    }

    /// Casts the samples of a pair.
    pub(super) fn sample(
        &self,
        test: impl SegmentTest,
        source: &Source,
        receiver: Target,
        rays: u32,
        round: u64,
    ) -> SampledVisibility {
        let (from, to) = self.surfaces(source, receiver);
        let key = self.sample_key(source, receiver, round);
        sample_visibility(self.arch, test, &from, &to, rays, key, self.oracle.tau)
    }

    /// Whether the samples of a pair of which nothing is hidden carry light and have something to test.
    pub(super) fn look_for_light(
        &self,
        source: &Source,
        receiver: Target,
        rays: u32,
        round: u64,
    ) -> SampledLight {
        let (from, to) = self.surfaces(source, receiver);
        let key = self.sample_key(source, receiver, round);
        look_for_light(self.arch, &from, &to, rays, key, self.oracle.tau)
    }
}
