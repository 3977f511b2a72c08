//! How many batches each face needs, and which of them the next round traces.
//!
//! Where the samples themselves decided when to stop, those that happen to look sure too early would
//! stand, and the mean would lean (by a tenth of an error bar at 16 batches; more than a mean over a
//! thousand faces may). So each face has two streams of batches: one only *plans*, and its
//! spread decides how many the other has; the other alone is the answer. Planning costs a quarter.

use super::config::ReferenceConfig;
use super::estimate::Estimate;
use super::source_side::SourceSide;
use std::f64::consts::PI;
use std::ops::Range;

/// Batches of each stream in the first round.
const FIRST: u64 = 4;
/// Planning batches without which no face is finished: their spread is then known to a fifth or so.
const LEAST_PLANNING: u64 = 16;
/// Answering batches a planning batch, from there on.
const ANSWERS_PER_PLANNING: u64 = 4;
/// Batches of a round, unless some unfinished face would get none: a few seconds of two cores, so that
/// a time limit and an interruption are met.
const BATCHES_PER_ROUND: u64 = 1 << 15;
/// Most batches of one task: some ten thousand rays, enough to hide scheduling.
const BATCHES_PER_TASK: usize = 16;

/// The two streams of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stream {
    Planning,
    Answer,
}

/// Batches of one stream of one face.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Task {
    pub subject: usize,
    pub stream: Stream,
    pub batches: Range<u64>,
}

/// A face under measurement: what its batches say of reflected radiosity.
#[derive(Clone, Debug)]
pub(super) struct FaceProgress {
    pub planning: Estimate,
    pub answer: Estimate,
    /// Whether the plan is fulfilled.
    pub done: bool,
}

impl FaceProgress {
    pub fn new(subject: &SourceSide) -> Self {
        Self {
            planning: Estimate::default(),
            answer: Estimate::default(),
            // Where nothing is reflected the emission is all, and known.
            done: subject.reflectance == [0.0; 3],
        }
    }
}

/// Emitted and reflected.
pub(super) fn radiosity(subject: &SourceSide, reflected: &Estimate) -> [f64; 3] {
    std::array::from_fn(|c| PI * subject.emission[c] * subject.lit_share + reflected.mean[c])
}

/// Marks the faces that are done, and says what the next round has to do: nothing when all are.
pub(super) fn plan_round(
    subjects: &[SourceSide],
    faces: &mut [FaceProgress],
    error: f64,
) -> Vec<Task> {
    let dark = dark_level(subjects, faces);
    let mut more = Vec::with_capacity(faces.len());
    for face in faces.iter_mut() {
        let needed = batches_needed(&face.planning, dark, error);
        let answered = face.answer.count;
        let planned_well = face.planning.count >= LEAST_PLANNING;
        face.done |= planned_well && answered as f64 >= needed;
        more.push(if face.done {
            0
        } else if answered == 0 {
            FIRST
        } else if planned_well {
            // Twice as many in all at most: the plan's own spread is not known better.
            (needed.ceil() as u64 - answered).clamp(1, answered)
        } else {
            answered
        });
    }
    let size: u64 = more.iter().sum();
    let scale = (BATCHES_PER_ROUND as f64 / size.max(1) as f64).min(1.0);
    let mut tasks = Vec::new();
    for (index, (face, more)) in faces.iter().zip(more).enumerate() {
        if more == 0 {
            continue;
        }
        let answered = face.answer.count;
        let answers = answered + ((more as f64 * scale) as u64).max(1);
        let planning = answers.min(LEAST_PLANNING.max(answers / ANSWERS_PER_PLANNING));
        for (stream, batches) in [
            (Stream::Planning, face.planning.count..planning),
            (Stream::Answer, answered..answers),
        ] {
            let end = batches.end;
            tasks.extend(batches.step_by(BATCHES_PER_TASK).map(|first| Task {
                subject: index,
                stream,
                batches: first..end.min(first + BATCHES_PER_TASK as u64),
            }));
        }
    }
    tasks
}

/// Radiosity below which a face counts as dark, by the planning batches.
fn dark_level(subjects: &[SourceSide], faces: &[FaceProgress]) -> [f64; 3] {
    let mut area = 0.0;
    let mut light = [0.0; 3];
    for (subject, face) in subjects.iter().zip(faces) {
        area += subject.area;
        let b = radiosity(subject, &face.planning);
        for (sum, b) in light.iter_mut().zip(b) {
            *sum += subject.area * b;
        }
    }
    light.map(|l| ReferenceConfig::DARK * l / area)
}

/// Batches after which every channel's standard error is as asked, by the spread of the planning ones.
/// Asked of the reflected part: beside an emitter's own light, which is known, any noise would pass.
fn batches_needed(planning: &Estimate, dark: [f64; 3], error: f64) -> f64 {
    let mut needed = 0.0f64;
    for (c, variance) in planning.variance().into_iter().enumerate() {
        let asked = error * planning.mean[c].max(dark[c]);
        if variance > 0.0 {
            needed = needed.max(variance / (asked * asked));
        }
    }
    needed
}
