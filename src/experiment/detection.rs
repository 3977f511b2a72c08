//! How much of full occlusion and full visibility is detected (paper, Table 1).
//!
//! Every pass is run with the technique under test from the state that `normal` left after the pass
//! before, so that the counts compare the same work.
//!
//! The paper calls an exchange fully occluded when all of its rays are blocked, which is an overcount.
//! So the same is given against a second denominator: of a uniform sample of those exchanges, those
//! that stay blocked under many more rays.

use super::dice::Dice;
use super::element_points::{ElementPoints, Place};
use crate::embree::{CommittedScene, RayPacket8};
use crate::math::hash_u64;
use crate::solve::{
    Claim, Element, PassStatistics, PreparedScene, Silent, SolveConfig, SolveError, Solver,
    Technique,
};
use crate::visibility::LEAST_COSINE;
use rayon::prelude::*;
use serde::Serialize;

/// What to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DetectionConfig {
    /// Passes.
    pub passes: u32,
    /// Blocked exchanges of each pass that are put to the second test.
    pub sample: usize,
    /// Rays of the second test.
    pub rays: u32,
}

impl Default for DetectionConfig {
    fn default() -> Self {
        Self {
            passes: 3,
            // A share of one half is then known to 1 %.
            sample: 2_000,
            rays: 1024,
        }
    }
}

/// One pass of one technique.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Detection {
    /// The pass.
    pub pass: u32,
    /// The technique.
    pub technique: Technique,
    /// Exchanges of `normal`.
    pub exchanges: u64,
    /// Those of them whose rays were all blocked.
    pub blocked: u64,
    /// Those that are still evaluated, and blocked, in the technique.
    pub blocked_left: u64,
    /// Blocked exchanges put to the second test.
    pub sampled: u64,
    /// Those that stayed blocked.
    pub sampled_blocked: u64,
    /// Exchanges proved visible.
    pub visible: u64,
}

impl Detection {
    /// The paper's greatest possible detection: blocked exchanges over all, in percent.
    pub fn max_occlusion_percent(&self) -> f64 {
        percent(self.blocked as f64, self.exchanges as f64)
    }

    /// The paper's detection: the share of the blocked exchanges that disappeared, in percent.
    pub fn detected_percent(&self) -> f64 {
        let gone = self.blocked as f64 - self.blocked_left as f64;
        percent(gone, self.blocked as f64)
    }

    /// The same over those that many more rays find blocked; may exceed 100 by the sample's noise.
    pub fn detected_percent_of_surely_blocked(&self) -> f64 {
        let gone = self.blocked as f64 - self.blocked_left as f64;
        let share = self.sampled_blocked as f64 / self.sampled.max(1) as f64;
        percent(gone, self.blocked as f64 * share)
    }

    /// Exchanges proved visible over all, in percent.
    pub fn visible_percent(&self) -> f64 {
        percent(self.visible as f64, self.exchanges as f64)
    }
}

fn percent(part: f64, whole: f64) -> f64 {
    if whole > 0.0 {
        100.0 * part / whole
    } else {
        0.0
    }
}

/// Measures `config.technique`, pass by pass; the scene has to be prepared with guarantees for it.
///
/// # Errors
/// A setting out of range.
pub fn detection(
    prepared: &PreparedScene,
    config: &SolveConfig,
    what: &DetectionConfig,
) -> Result<Vec<Detection>, SolveError> {
    config.validate()?;
    match prepared.scene.channels() {
        1 => detect::<1>(prepared, config, what),
        _ => detect::<3>(prepared, config, what),
    }
}

fn detect<const C: usize>(
    prepared: &PreparedScene,
    config: &SolveConfig,
    what: &DetectionConfig,
) -> Result<Vec<Detection>, SolveError> {
    let normal = SolveConfig {
        technique: Technique::Normal,
        keep_blocked: what.sample,
        ..config.clone()
    };
    let points = ElementPoints::new(&prepared.scene, &prepared.hierarchy);
    let mut solver = Solver::<C>::new(prepared, &normal, &Silent);
    let mut rows = Vec::new();
    for pass in 1..=what.passes {
        let trial: PassStatistics = solver.trial(pass, config)?.statistics;
        let outcome = solver.advance(pass)?;
        let sample = outcome.blocked.into_claims();
        let blocked = sample
            .par_iter()
            .filter(|pair| stays_blocked(prepared, &points, &pair.claim, what.rays))
            .count();
        rows.push(Detection {
            pass,
            technique: config.technique,
            exchanges: outcome.statistics.exchanges,
            blocked: outcome.statistics.exchanges_blocked,
            blocked_left: trial.exchanges_blocked,
            sampled: sample.len() as u64,
            sampled_blocked: blocked as u64,
            visible: trial.exchanges_visible,
        });
    }
    Ok(rows)
}

/// True when none of `rays` uniform rays that carry light gets through.
fn stays_blocked(
    prepared: &PreparedScene,
    points: &ElementPoints,
    pair: &Claim,
    rays: u32,
) -> bool {
    let [a, b] = pair.elements(&prepared.scene, &prepared.hierarchy);
    let name = |e: &Element| hash_u64(u64::from(e.node.0) ^ hash_u64(e.path.0));
    let mut dice = Dice::new(name(&a) ^ name(&b).rotate_left(32));
    (0..rays.div_ceil(8)).all(|_| {
        let mut packet = RayPacket8::EMPTY;
        let active = fill(
            &mut packet,
            points,
            [&a, &b],
            prepared.scene.tau(),
            &mut dice,
        );
        active == 0 || is_blocked(&prepared.embree, &mut packet, active)
    })
}

fn is_blocked(embree: &CommittedScene, packet: &mut RayPacket8, active: u8) -> bool {
    embree.occluded8(packet, active) == active
}

/// Eight rays as the solver casts them; the lanes that carry light.
fn fill(
    packet: &mut RayPacket8,
    points: &ElementPoints,
    [a, b]: [&Element; 2],
    tau: f32,
    dice: &mut Dice,
) -> u8 {
    let mut active = 0;
    for lane in 0..RayPacket8::WIDTH {
        let from = points.draw(a, Place::Inside, dice);
        let to = points.draw(b, Place::Inside, dice);
        let direction = to.position - from.position;
        let (leaving, arriving) = (from.normal.dot(direction), -to.normal.dot(direction));
        if leaving.min(arriving) <= LEAST_COSINE * direction.length() {
            continue;
        }
        let (near, far) = (tau / leaving, 1.0 - tau / arriving);
        if near < far {
            packet.set(lane, from.position, direction, near, far);
            active |= 1 << lane;
        }
    }
    active
}
