//! What the guaranteed tests of a solve stand on, built once a scene (paper, sections 3.2 and 5).

use super::config::Technique;
use crate::cluster::Hierarchy;
use crate::math::PolygonId;
use crate::occluder::{
    ExtractionSeconds, OccluderConfig, OccluderSet, SlabRectangle, extract_occluders,
};
use crate::scene::Scene;
#[cfg(any(test, feature = "plant-faults"))]
use crate::visibility::Faults;
use crate::visibility::{
    EmptyBoxes, OccluderTree, SceneTree, SurfaceEdges, SurfaceQuery, SurvivorList, Tolerance,
    VisibilityQuery,
};
use glam::Vec3;
use std::sync::OnceLock;
use std::time::Instant;

/// The occluders and the scene as shafts meet them. Techniques that prove nothing have none of it.
#[derive(Clone, Debug)]
pub struct Guarantees {
    /// The occluders; empty where the technique does not ask for them.
    pub occluder_set: OccluderSet,
    /// Their hierarchy.
    pub occluders: OccluderTree,
    /// The polygons.
    pub scene: SceneTree,
    /// Boxes of air; none where nobody has looked for them.
    pub empty_boxes: EmptyBoxes,
    /// How polygons hang together; worked out when somebody first asks.
    surface_edges: OnceLock<SurfaceEdges>,
    /// The list with which the topmost pair starts.
    pub whole_scene: SurvivorList,
    /// Wall time of its stages.
    pub seconds: GuaranteeSeconds,
    /// What tests plant in visibility queries; nothing can be planted in a product.
    #[cfg(any(test, feature = "plant-faults"))]
    faults: Faults,
}

/// Wall time of the stages; the polygons are sorted beside the extraction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GuaranteeSeconds {
    /// Rectangles and solids.
    pub extraction: ExtractionSeconds,
    /// Boxes of air.
    pub empty_boxes: f64,
    /// All of it.
    pub total: f64,
}

impl Guarantees {
    /// Builds what `technique` needs: nothing, the polygons, or occluders as well.
    pub(super) fn for_technique(
        scene: &Scene,
        hierarchy: &Hierarchy,
        technique: Technique,
        occluders: &OccluderConfig,
    ) -> Option<Self> {
        technique
            .proves_visibility()
            .then(|| match technique.proves_occlusion() {
                true => Self::with_occluders(scene, hierarchy, occluders),
                false => Self::new(scene, OccluderSet::default(), Instant::now()),
            })
    }

    /// Everything, whatever the technique.
    fn with_occluders(scene: &Scene, hierarchy: &Hierarchy, config: &OccluderConfig) -> Self {
        let start = Instant::now();
        let extract = || extract_occluders(scene, hierarchy, config);
        let (set, tree) = rayon::join(extract, || SceneTree::build(scene));
        Self::over(tree, scene, set, start)
    }

    /// The same with these occluders, whatever the extraction would find: for tests that plant one.
    pub fn with_set(scene: &Scene, occluder_set: OccluderSet) -> Self {
        Self::new(scene, occluder_set, Instant::now())
    }

    fn new(scene: &Scene, occluder_set: OccluderSet, start: Instant) -> Self {
        Self::over(SceneTree::build(scene), scene, occluder_set, start)
    }

    fn over(tree: SceneTree, scene: &Scene, occluder_set: OccluderSet, start: Instant) -> Self {
        let slabs: Vec<SlabRectangle> = occluder_set.occluders.iter().map(|o| o.slab).collect();
        Self {
            occluders: OccluderTree::build(
                &slabs,
                &occluder_set.solids,
                Tolerance::of_scene(scene.bounds()),
            ),
            whole_scene: SurvivorList::whole_scene(&tree),
            scene: tree,
            empty_boxes: EmptyBoxes::default(),
            surface_edges: OnceLock::new(),
            seconds: GuaranteeSeconds {
                extraction: occluder_set.seconds,
                empty_boxes: 0.0,
                total: start.elapsed().as_secs_f64(),
            },
            occluder_set,
            #[cfg(any(test, feature = "plant-faults"))]
            faults: Faults::NONE,
        }
    }

    /// The same with the boxes of air that hold many of the sights that are drawn: pairs of points that see each other.
    #[must_use]
    pub(super) fn with_empty_boxes(mut self, draw: impl FnOnce() -> Vec<[Vec3; 2]>) -> Self {
        let start = Instant::now();
        self.empty_boxes = EmptyBoxes::build(&self.scene, &draw());
        self.seconds.empty_boxes = start.elapsed().as_secs_f64();
        self.seconds.total += self.seconds.empty_boxes;
        self
    }

    /// The same with faults planted in the engine, before any claim is made.
    #[cfg(any(test, feature = "plant-faults"))]
    #[must_use]
    pub fn with_faults(mut self, faults: Faults) -> Self {
        self.occluders = self.occluders.with_faults(faults);
        self.faults = faults;
        self
    }

    /// Queries for full visibility.
    pub fn visibility_query(&self) -> VisibilityQuery<'_> {
        let query = VisibilityQuery::new(&self.scene);
        #[cfg(any(test, feature = "plant-faults"))]
        let query = query.with_faults(self.faults);
        query
    }

    /// Queries for surfaces that cut every segment of a pair.
    pub fn surface_query(&self) -> SurfaceQuery<'_> {
        let edges = self.surface_edges.get_or_init(|| {
            let mut polygons: Vec<(PolygonId, [Vec3; 3])> = self.scene.polygons().collect();
            polygons.sort_unstable_by_key(|(id, _)| *id);
            SurfaceEdges::new(polygons.into_iter().map(|(_, corners)| corners).collect())
        });
        let query = SurfaceQuery::new(&self.scene, edges);
        #[cfg(any(test, feature = "plant-faults"))]
        let query = query.with_faults(self.faults);
        query
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.occluders.bytes() + self.scene.bytes() + self.empty_boxes.bytes()
    }
}
