//! The light of a solve in progress: what each element has yet to shoot (frozen during a pass), and
//! what each owner's receivers have gathered.
//!
//! An owner holds a contiguous range of facets. Its patches stand in one array: the first entries
//! are the facets themselves, children of a patch are four in a row.

use super::cluster_light::ClusterLight;
use super::facet_frame::FacetFrame;
use super::ownership::owner_cut;
use super::patch_split::{PatchSplit, relative_variance};
use super::solution::PatchPath;
use crate::cluster::{Hierarchy, NodeKind};
use crate::math::{FacetId, NodeId};
use glam::Vec3;

/// An energy in `C` channels.
pub type Light<const C: usize> = [f64; C];

/// What a linear function has at the corners of a patch more than in its middle.
pub type Slope<const C: usize> = [[f32; C]; 3];

/// What an owner's facets and patches have yet to shoot: read by every task, written between passes.
#[derive(Clone, Debug, Default)]
pub struct Shooter<const C: usize> {
    /// Children of each patch, and how its light is spread over them.
    pub splits: Vec<PatchSplit>,
    /// Unshot radiosity, area-weighted mean over the patch.
    pub unshot: Vec<[f32; C]>,
}

/// What an owner's receivers gather: written by its own task alone.
#[derive(Clone, Debug, Default)]
pub struct Gatherer<const C: usize> {
    /// The node of the cut.
    pub root: NodeId,
    /// First facet owned.
    pub first_facet: u32,
    /// Facets owned.
    pub facet_count: u32,
    /// Index of the first of a patch's four children, 0 for a leaf, with the patches made in this pass.
    pub children: Vec<u32>,
    /// Irradiance gathered in this pass by facets and patches at their own level: a linear function by
    /// its values at the three corners.
    pub gathered: Vec<[Light<C>; 3]>,
    /// Irradiance of all passes so far; of use at the leaves.
    pub total: Vec<Light<C>>,
    /// How that varies over each patch: what patches made later start from. Nowhere below zero.
    pub slopes: Vec<Slope<C>>,
    /// What clusters gathered in this pass, by place in the owner's depth-first order of nodes; empty where the owner is
    /// one facet.
    pub clusters: Vec<[ClusterLight; C]>,
}

impl<const C: usize> Gatherer<C> {
    fn new(hierarchy: &Hierarchy, root: NodeId) -> Self {
        let node = hierarchy.node(root);
        let facets = node.facet_count as usize;
        Self {
            root,
            first_facet: node.first_facet,
            facet_count: node.facet_count,
            children: vec![0; facets],
            gathered: vec![[[0.0; C]; 3]; facets],
            total: vec![[0.0; C]; facets],
            slopes: vec![[[0.0; C]; 3]; facets],
            clusters: if facets > 1 {
                vec![[ClusterLight::ZERO; C]; 2 * facets - 1]
            } else {
                Vec::new()
            },
        }
    }

    /// The patch at `path` of a facet, made with all above it if it is not there yet. New patches
    /// start with what their parent's irradiance of earlier passes is on them.
    pub fn patch(&mut self, facet: FacetId, path: PatchPath) -> usize {
        let mut at = (facet.0 - self.first_facet) as usize;
        for step in path.steps() {
            if self.children[at] == 0 {
                self.children[at] = u32::try_from(self.children.len())
                    .expect("an owner has fewer than 2^32 patches");
                let (total, slope) = (self.total[at], self.slopes[at]);
                for which in 0..4 {
                    self.children.push(0);
                    self.gathered.push([[0.0; C]; 3]);
                    let (mean, slope) = inherited(&total, &slope, which);
                    self.total.push(mean);
                    self.slopes.push(slope);
                }
            }
            at = (self.children[at] + step) as usize;
        }
        at
    }
}

/// Mean and slope on child `which`, numbered as `split_triangle` does, of what has these on its parent: the middle of a corner's
/// child lies half as far out as the corner, the child in the middle is turned about.
pub(super) fn inherited<const C: usize>(
    mean: &Light<C>,
    slope: &Slope<C>,
    which: usize,
) -> (Light<C>, Slope<C>) {
    match slope.get(which) {
        Some(corner) => (
            std::array::from_fn(|c| (mean[c] + 0.5 * f64::from(corner[c])).max(0.0)),
            slope.map(|corner| corner.map(|x| 0.5 * x)),
        ),
        None => (*mean, slope.map(|corner| corner.map(|x| -0.5 * x))),
    }
}

/// All the light of a solve.
#[derive(Clone, Debug, Default)]
pub struct Radiosity<const C: usize> {
    /// One a node of the cut, in facet order.
    pub shooters: Vec<Shooter<C>>,
    /// Parallel to `shooters`.
    pub gatherers: Vec<Gatherer<C>>,
    /// Unshot radiosity of every node, area-weighted mean.
    pub node_unshot: Vec<[f32; C]>,
    /// Relative variance of the unshot radiosity over every node, all channels together.
    pub node_variance: Vec<f32>,
    /// Mean over every node of what its unshot radiosity is beyond its mean, times the way from its centroid: towards
    /// where it is brighter.
    pub node_moment: Vec<[Vec3; C]>,
    /// Sums of the unshot power, over all channels, of the facets before each facet; one longer.
    pub power_before: Vec<f64>,
    /// Whether each facet's light is even.
    pub is_even: Vec<bool>,
    /// The owner of each facet.
    pub owner_of_facet: Vec<u32>,
    /// The first facet of each owner.
    pub first_facets: Vec<u32>,
}

impl<const C: usize> Radiosity<C> {
    /// Nothing shot yet: `emitted` gives each facet's emitted radiosity.
    pub fn new(hierarchy: &Hierarchy, emitted: impl Fn(FacetId) -> Light<C>) -> Self {
        let cut = owner_cut(hierarchy);
        let mut owner_of_facet = vec![0u32; hierarchy.facets.len()];
        let mut shooters = Vec::with_capacity(cut.len());
        let mut gatherers = Vec::with_capacity(cut.len());
        for (owner, &root) in cut.iter().enumerate() {
            let range = hierarchy.facet_range(root);
            owner_of_facet[range.clone()].fill(owner as u32);
            shooters.push(Shooter {
                splits: vec![PatchSplit::default(); range.len()],
                unshot: range
                    .map(|f| emitted(FacetId::new(f)).map(|x| x as f32))
                    .collect(),
            });
            gatherers.push(Gatherer::new(hierarchy, root));
        }
        let mut light = Self {
            shooters,
            gatherers,
            node_unshot: vec![[0.0; C]; hierarchy.nodes.len()],
            node_variance: vec![0.0; hierarchy.nodes.len()],
            node_moment: vec![[Vec3::ZERO; C]; hierarchy.nodes.len()],
            power_before: vec![0.0; hierarchy.facets.len() + 1],
            is_even: vec![true; hierarchy.facets.len()],
            owner_of_facet,
            first_facets: cut
                .iter()
                .map(|&root| hierarchy.node(root).first_facet)
                .collect(),
        };
        light.pull_nodes(hierarchy, &[]);
        light
    }

    /// Unshot radiosity of a facet.
    pub fn facet_unshot(&self, facet: FacetId) -> [f32; C] {
        let owner = self.owner_of_facet[facet.index()] as usize;
        let local = facet.0 - self.first_facets[owner];
        self.shooters[owner].unshot[local as usize]
    }

    fn facet_split(&self, facet: FacetId) -> &PatchSplit {
        let owner = self.owner_of_facet[facet.index()] as usize;
        let local = facet.0 - self.first_facets[owner];
        &self.shooters[owner].splits[local as usize]
    }

    /// Averages the facets' unshot radiosity up the hierarchy (paper: pull). Children stand behind
    /// their parents, so one walk from the back serves. `frames` are those of all facets, or of none where no facet is split.
    pub fn pull_nodes(&mut self, hierarchy: &Hierarchy, frames: &[FacetFrame]) {
        for index in (0..hierarchy.nodes.len()).rev() {
            let node = &hierarchy.nodes[index];
            self.node_unshot[index] = if node.kind == NodeKind::Facet {
                self.facet_unshot(FacetId(node.first_facet))
            } else {
                let (a, b) = (node.first_child as usize, node.first_child as usize + 1);
                let (area_a, area_b) = (
                    f64::from(hierarchy.shapes[a].area),
                    f64::from(hierarchy.shapes[b].area),
                );
                let sum = |light: [f32; C]| light.iter().sum::<f32>();
                self.node_variance[index] = relative_variance(
                    [area_a, area_b].map(|x| (x / (area_a + area_b)) as f32),
                    [a, b].map(|k| sum(self.node_unshot[k])),
                    [a, b].map(|k| self.node_variance[k]),
                );
                std::array::from_fn(|c| {
                    ((f64::from(self.node_unshot[a][c]) * area_a
                        + f64::from(self.node_unshot[b][c]) * area_b)
                        / (area_a + area_b)) as f32
                })
            };
            self.node_moment[index] = match node.kind {
                NodeKind::Facet => self.facet_moment(FacetId(node.first_facet), frames),
                NodeKind::FaceCluster => self.moment_of_children(hierarchy, index),
                NodeKind::Volume => [Vec3::ZERO; C],
            };
            if node.kind == NodeKind::Facet {
                let split = *self.facet_split(FacetId(node.first_facet));
                self.node_variance[index] = split.variance;
                self.is_even[node.first_facet as usize] = split.is_even();
                let radiosity: f32 = self.node_unshot[index].iter().sum();
                self.power_before[node.first_facet as usize + 1] =
                    f64::from(radiosity) * f64::from(hierarchy.shapes[index].area);
            }
        }
        for facet in 1..self.power_before.len() {
            self.power_before[facet] += self.power_before[facet - 1];
        }
    }

    /// What the children of a facet hold beyond its mean, each at its middle: half as far out as the corner, and that in
    /// the middle nowhere.
    fn facet_moment(&self, facet: FacetId, frames: &[FacetFrame]) -> [Vec3; C] {
        let first = self.facet_split(facet).first as usize;
        if first == 0 {
            return [Vec3::ZERO; C];
        }
        let corners = frames[facet.index()].corners();
        let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        let mean = self.facet_unshot(facet);
        let unshot = &self.shooters[self.owner_of_facet[facet.index()] as usize].unshot;
        std::array::from_fn(|c| {
            let moments = (0..3).map(|k| (corners[k] - middle) * (unshot[first + k][c] - mean[c]));
            moments.sum::<Vec3>() * (0.25 * 0.5)
        })
    }

    /// The same of a cluster: its children's own, and their means at their centroids.
    fn moment_of_children(&self, hierarchy: &Hierarchy, index: usize) -> [Vec3; C] {
        let whole = &hierarchy.shapes[index];
        let first = hierarchy.nodes[index].first_child as usize;
        let mut moment = [Vec3::ZERO; C];
        for child in [first, first + 1] {
            let shape = &hierarchy.shapes[child];
            let (share, way) = (shape.area / whole.area, shape.centroid - whole.centroid);
            for (c, moment) in moment.iter_mut().enumerate() {
                let more = self.node_unshot[child][c] - self.node_unshot[index][c];
                *moment += (self.node_moment[child][c] + way * more) * share;
            }
        }
        moment
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let per_patch = size_of::<u32>()
            + size_of::<PatchSplit>()
            + size_of::<[f32; C]>()
            + 4 * size_of::<Light<C>>()
            + size_of::<Slope<C>>();
        self.gatherers
            .iter()
            .map(|g| {
                g.children.len() * per_patch + g.clusters.len() * size_of::<[ClusterLight; C]>()
            })
            .sum::<usize>()
            + self.node_unshot.len() * (size_of::<[f32; C]>() + size_of::<[Vec3; C]>())
            + self.power_before.len() * size_of::<f64>()
            + self.is_even.len()
    }
}
