//! Solves again to see for whom rays were cast.

use super::error::CliError;
use super::progress::Progress;
use super::scene_source::prepare;
use super::session::Session;
use super::solved_scene::SolvedScene;
use crate::output::{RaysByReceiver, SolvedMesh, ray_density};
use crate::solve::{ElementName, Observer, PassStatistics, solve};
use std::sync::{Arc, Mutex, PoisonError};

/// Passes on what it hears, and counts rays by receiver.
struct RayCounter {
    progress: Progress,
    rays: Mutex<RaysByReceiver>,
}

impl Observer for RayCounter {
    fn pass_started(&self, pass: u32, tasks: usize) {
        self.progress.pass_started(pass, tasks);
    }
    fn task_done(&self, exchanges: u64) {
        self.progress.task_done(exchanges);
    }
    fn pass_done(&self, statistics: &PassStatistics, unshot_fraction: f64) {
        self.progress.pass_done(statistics, unshot_fraction);
    }
    fn counts_rays(&self) -> bool {
        true
    }
    fn rays_cast(&self, receiver: ElementName, rays: u32) {
        // Counts are whole after every call, so a panic elsewhere leaves nothing half done.
        let mut counts = self.rays.lock().unwrap_or_else(PoisonError::into_inner);
        counts.add(receiver, rays);
    }
    fn interrupted(&self) -> bool {
        self.progress.interrupted()
    }
}

/// A solution and the rays per area of each of its faces.
pub struct CountedRays {
    /// The solution, solved again.
    pub mesh: SolvedMesh,
    /// Parallel to its faces; `None` on sides without light.
    pub density: Vec<Option<f64>>,
    /// All rays through Embree.
    pub total: u64,
}

/// Solves `solved` again.
pub fn count_rays(session: &Session, solved: SolvedScene) -> Result<CountedRays, CliError> {
    let config = solved.command.solve.config()?;
    let prepared = session.stops_at_once(|| {
        prepare(solved.scene, &solved.command.scene.reading, config.seed)
            .map(|p| p.with_guarantees(config.technique, &solved.command.solve.occluders.config()))
    })?;
    let counter = RayCounter {
        progress: Progress::new(session.quiet, Arc::clone(&session.interrupted), &config),
        rays: Mutex::default(),
    };
    let outcome = solve(&prepared, &config, &counter);
    counter.progress.finish();
    let solution = outcome?.solution;
    let rays = counter
        .rays
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner);
    Ok(CountedRays {
        density: ray_density(&prepared.scene, &prepared.hierarchy, &solution, &rays),
        mesh: SolvedMesh::new(&prepared.scene, &solution),
        total: rays.total(),
    })
}
