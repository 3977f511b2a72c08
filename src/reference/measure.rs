//! The measurement: rounds of batches until every face is known as well as was asked, or time is up.

use super::config::{ReferenceConfig, ReferenceConfigError};
use super::observer::ReferenceObserver;
use super::path_tracer::{PATHS, Scratch, trace_batch};
use super::plan::{FaceProgress, Stream, Task, plan_round, radiosity};
use super::random::key_of;
use super::source_side::{SourceSide, source_sides};
use super::traced_scene::TracedScene;
use crate::scene::Side;
use rayon::prelude::*;
use std::time::Instant;

/// What was measured of one side of one source face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceRadiosity {
    /// 0-based index of the `f` statement, in file order.
    pub face: u32,
    /// Which side.
    pub side: Side,
    /// Area in the square of the file's units.
    pub area: f64,
    /// Mean radiosity, emission included, in W/m2.
    pub radiosity: [f64; 3],
    /// Standard error of `radiosity`.
    pub standard_error: [f64; 3],
    /// Independent batches that `radiosity` is the mean of: the standard error has one degree of freedom less.
    pub batches: u64,
    /// Diffuse reflectance.
    pub reflectance: [f64; 3],
    /// Emitted radiance in W/m2/sr.
    pub emission: [f64; 3],
}

/// A measured scene.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Ordered by face, front before back.
    pub faces: Vec<FaceRadiosity>,
    /// Rounds run.
    pub rounds: u32,
    /// Rays cast, those that only planned included.
    pub rays: u64,
    /// Paths that the answer is made of.
    pub paths: u64,
    /// Whether every face's plan was fulfilled; else time was up.
    pub reached: bool,
    /// Wall time of the measurement.
    pub seconds: f64,
}

/// Why there is no measurement.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ReferenceError {
    /// A setting is out of range.
    #[error(transparent)]
    Config(#[from] ReferenceConfigError),
    /// Asked to stop.
    #[error("interrupted before the measurement was complete")]
    Interrupted,
}

/// Measures the radiosity of the scene's source faces. The same scene, seed, faces and number of rounds
/// give the same bits at any number of threads; the clock has a say only through `max_seconds`.
///
/// # Errors
/// A setting out of range; an interruption by `observer`.
pub fn measure(
    traced: &TracedScene,
    config: &ReferenceConfig,
    observer: &impl ReferenceObserver,
) -> Result<Reference, ReferenceError> {
    config.validate()?;
    let start = Instant::now();
    let subjects = source_sides(traced, config.faces, config.seed);
    let mut faces: Vec<FaceProgress> = subjects.iter().map(FaceProgress::new).collect();
    let (mut rounds, mut rays, mut batches) = (0u32, 0u64, 0u64);
    loop {
        let tasks = plan_round(&subjects, &mut faces, config.error);
        let next: u64 = tasks.iter().map(|t| t.batches.end - t.batches.start).sum();
        let elapsed = start.elapsed().as_secs_f64();
        let expected = elapsed + elapsed / batches.max(1) as f64 * next as f64;
        let late = rounds > 0 && config.max_seconds.is_some_and(|limit| expected > limit);
        if tasks.is_empty() || late {
            break;
        }
        rounds += 1;
        let unfinished = faces.iter().filter(|f| !f.done).count();
        observer.round_started(rounds, tasks.len(), unfinished);
        let results: Vec<Traced> = tasks
            .par_iter()
            .map(|task| trace(traced, &subjects, task, config.seed, observer))
            .collect();
        if observer.interrupted() {
            return Err(ReferenceError::Interrupted);
        }
        batches += next;
        for (task, result) in tasks.iter().zip(results) {
            rays += result.rays;
            let face = &mut faces[task.subject];
            let estimate = match task.stream {
                Stream::Planning => &mut face.planning,
                Stream::Answer => &mut face.answer,
            };
            result.means.into_iter().for_each(|m| estimate.push(m));
        }
    }
    Ok(Reference {
        rounds,
        rays,
        paths: PATHS as u64 * faces.iter().map(|f| f.answer.count).sum::<u64>(),
        reached: faces.iter().all(|f| f.done),
        faces: (subjects.iter().zip(&faces))
            .map(|(subject, face)| FaceRadiosity {
                face: subject.face,
                side: subject.side,
                area: subject.area,
                radiosity: radiosity(subject, &face.answer),
                standard_error: face.answer.standard_error(),
                batches: face.answer.count,
                reflectance: subject.reflectance,
                emission: subject.emission,
            })
            .collect(),
        seconds: start.elapsed().as_secs_f64(),
    })
}

/// What a task brings: reflected radiosity, batch by batch.
struct Traced {
    means: Vec<[f64; 3]>,
    rays: u64,
}

fn trace(
    traced: &TracedScene,
    subjects: &[SourceSide],
    task: &Task,
    seed: u64,
    observer: &impl ReferenceObserver,
) -> Traced {
    let subject = &subjects[task.subject];
    let mut scratch = Scratch::default();
    let mut result = Traced {
        means: Vec::new(),
        rays: 0,
    };
    for batch in task.batches.clone() {
        let place = [u64::from(subject.face), subject.side as u64];
        let key = key_of(&[seed, place[0], place[1], task.stream as u64, batch]);
        let found = trace_batch(traced, subject, key, &mut scratch, &|| {
            observer.interrupted()
        });
        result.rays += found.rays;
        result.means.push(std::array::from_fn(|c| {
            subject.lit_share * subject.reflectance[c] * found.irradiance[c]
        }));
    }
    observer.task_done(result.rays);
    result
}
