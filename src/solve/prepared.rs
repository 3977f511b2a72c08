//! Everything that a solve needs, built once from a scene: one line a stage.

use super::config::Technique;
use super::guarantees::Guarantees;
use super::sights::draw_sights;
use crate::cluster::{ClusterConfig, Hierarchy, build_hierarchy};
use crate::embree::{CommittedScene, Device, DeviceConfig, EmbreeError, EmbreeVersion};
use crate::occluder::OccluderConfig;
use crate::scene::{Scene, SidesMode, resolve_sides};
use std::time::Instant;

/// A scene made ready to be solved.
pub struct PreparedScene {
    /// The scene.
    pub scene: Scene,
    /// Its polygons in Embree.
    pub embree: CommittedScene,
    /// Version of the Embree that answers.
    pub embree_version: EmbreeVersion,
    /// Its facets as a hierarchy.
    pub hierarchy: Hierarchy,
    /// What the guaranteed tests stand on; see [`Self::with_guarantees`].
    pub guarantees: Option<Guarantees>,
    /// Wall time of the stages.
    pub seconds: StageSeconds,
}

/// Wall time of the stages before the solve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageSeconds {
    /// Embree's build.
    pub embree: f64,
    /// Which sides exist.
    pub sides: f64,
    /// Sides and hierarchy.
    pub cluster: f64,
}

impl PreparedScene {
    /// Builds the structures of `scene`.
    ///
    /// # Errors
    /// Embree's, such as no memory or too old a version.
    pub fn new(
        scene: Scene,
        sides: SidesMode,
        seed: u64,
        device: &DeviceConfig,
    ) -> Result<Self, EmbreeError> {
        let start = Instant::now();
        let device = Device::new(device)?;
        let triangles: Vec<[u32; 3]> = scene.polygons.iter().map(|p| p.vertices).collect();
        let embree = CommittedScene::build(&device, &scene.positions, &triangles)?;
        let built = Instant::now();
        let facets = resolve_sides(&scene, &embree, sides, seed);
        let sided = Instant::now();
        let hierarchy = build_hierarchy(&scene, &facets, &ClusterConfig::default());
        Ok(Self {
            embree_version: device.version(),
            seconds: StageSeconds {
                embree: (built - start).as_secs_f64(),
                sides: (sided - built).as_secs_f64(),
                cluster: built.elapsed().as_secs_f64(),
            },
            scene,
            embree,
            hierarchy,
            guarantees: None,
        })
    }

    /// The same with what `technique` needs for its guaranteed tests.
    #[must_use]
    pub fn with_guarantees(mut self, technique: Technique, occluders: &OccluderConfig) -> Self {
        self.make_guarantees(technique, occluders);
        self
    }

    /// Makes what `technique` needs for its guaranteed tests, in place of what there was.
    pub fn make_guarantees(&mut self, technique: Technique, occluders: &OccluderConfig) {
        let made = Guarantees::for_technique(&self.scene, &self.hierarchy, technique, occluders);
        self.guarantees = made.map(|made| {
            made.with_empty_boxes(|| draw_sights(&self.scene, &self.hierarchy, &self.embree))
        });
    }
}
