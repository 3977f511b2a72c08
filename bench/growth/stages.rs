//! One size: every stage with its wall time and its greatest resident memory.

use crate::memory;
use crate::rooms;
use certilux::cluster::{ClusterConfig, build_hierarchy};
use certilux::embree::{CommittedScene, Device, DeviceConfig};
use certilux::occluder::OccluderConfig;
use certilux::output::{SolvedMesh, write_ply};
use certilux::scene::{LoadConfig, SidesMode, load_text, resolve_sides};
use certilux::solve::{
    PassStatistics, PreparedScene, Silent, SolveConfig, StageSeconds, Stop, Technique, solve,
};
use serde::{Deserialize, Serialize};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Settings of a single room.
#[derive(Clone, Copy, Debug)]
pub struct RoomSettings {
    pub technique: Technique,
    /// Threshold: the array's is this over the number of rooms.
    pub epsilon: f64,
    /// Smallest patch over the room's area: the array's is this over the number of rooms.
    pub min_area: f64,
    /// Irradiance that may stay unresolved, relative to the mean, which does not change with the number of rooms.
    pub gradient: f64,
}

impl Default for RoomSettings {
    /// Coarse enough that a million polygons, cut into a few patches each, stay within 3 GiB.
    fn default() -> Self {
        Self {
            technique: Technique::Blockers,
            epsilon: 1.0e-2,
            min_area: 1.0e-3,
            gradient: 0.2,
        }
    }
}

/// A stage.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Stage {
    pub name: String,
    pub seconds: f64,
    /// Greatest resident memory while it ran, with what stages before it left.
    pub peak_bytes: u64,
}

/// One size.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Measurement {
    pub polygons: usize,
    pub rooms: usize,
    pub epsilon: f64,
    pub exchanges: u64,
    pub rays: u64,
    pub native_rays: u64,
    pub shafts: u64,
    pub occluders: usize,
    pub leaves: usize,
    pub imbalance: f64,
    pub stages: Vec<Stage>,
}

impl Measurement {
    pub fn seconds(&self) -> f64 {
        self.stages.iter().map(|s| s.seconds).sum()
    }

    pub fn peak(&self) -> u64 {
        self.stages.iter().map(|s| s.peak_bytes).max().unwrap_or(0)
    }
}

#[derive(Default)]
struct Stages(Vec<Stage>);

impl Stages {
    fn run<R>(
        &mut self,
        name: &str,
        work: impl FnOnce() -> Result<R, String>,
    ) -> Result<R, String> {
        memory::reset_peak()?;
        let start = Instant::now();
        let result = work()?;
        self.0.push(Stage {
            name: name.to_owned(),
            seconds: start.elapsed().as_secs_f64(),
            peak_bytes: memory::peak()?,
        });
        Ok(result)
    }
}

/// Loads, prepares, solves for one pass and writes an array of about `polygons`.
pub fn measure(polygons: usize, settings: &RoomSettings) -> Result<Measurement, String> {
    let along = rooms::rooms_along(polygons);
    let rooms = along * along;
    let mut stages = Stages::default();
    let text = rooms::obj(along);
    let scene = stages.run("load", || {
        let files = [("m.mtl", rooms::MTL.as_bytes())];
        load_text("rooms", text.as_bytes(), &files, &LoadConfig::default())
            .map_err(|e| e.to_string())
    })?;
    drop(text);
    let device = Device::new(&DeviceConfig::default()).map_err(|e| e.to_string())?;
    let embree = stages.run("embree", || {
        let triangles: Vec<[u32; 3]> = scene.polygons.iter().map(|p| p.vertices).collect();
        CommittedScene::build(&device, &scene.positions, &triangles).map_err(|e| e.to_string())
    })?;
    let mut config = SolveConfig::default();
    config.technique = settings.technique;
    config.epsilon = settings.epsilon / rooms as f64;
    config.min_area = settings.min_area / rooms as f64;
    config.gradient = settings.gradient;
    config.stop = Stop::Passes(1);
    let facets = stages.run("sides", || {
        Ok(resolve_sides(&scene, &embree, SidesMode::Auto, config.seed))
    })?;
    let hierarchy = stages.run("cluster", || {
        Ok(build_hierarchy(&scene, &facets, &ClusterConfig::default()))
    })?;
    drop(facets);
    let polygons = scene.polygons.len();
    let prepared = PreparedScene {
        embree_version: device.version(),
        scene,
        embree,
        hierarchy,
        guarantees: None,
        seconds: StageSeconds::default(),
    };
    // A wall is as large as ever, and an ever smaller part of the array.
    let mut occluders = OccluderConfig::default();
    occluders.min_area /= rooms as f64;
    let prepared = stages.run("guarantees", || {
        Ok(prepared.with_guarantees(settings.technique, &occluders))
    })?;
    let solved = stages.run("pass 1", || {
        solve(&prepared, &config, &Silent).map_err(|e| e.to_string())
    })?;
    let file = std::env::temp_dir().join(format!("certilux-growth-{}.ply", std::process::id()));
    let written = stages.run("output", || {
        let mesh = SolvedMesh::new(&prepared.scene, &solved.solution);
        write_ply(&file, &mesh, &AtomicBool::new(false)).map_err(|e| e.to_string())
    });
    let _ = std::fs::remove_file(&file);
    written?;
    let pass: PassStatistics = solved.passes[0];
    Ok(Measurement {
        polygons,
        rooms,
        epsilon: config.epsilon,
        exchanges: pass.exchanges,
        rays: pass.rays,
        native_rays: pass.native_rays,
        shafts: pass.shafts,
        occluders: prepared
            .guarantees
            .as_ref()
            .map_or(0, |g| g.occluders.len()),
        leaves: solved.leaves,
        imbalance: solved.power.imbalance,
        stages: stages.0,
    })
}
