//! Judges in exact arithmetic, for the audit and for tests: what they say is so.

mod dyadic;
mod occlusion_claim;
mod scene_segment;
mod segment;
mod solid_claim;
mod surface_claim;
mod visibility_claim;

pub use occlusion_claim::{OcclusionFlaw, replay_occlusion};
pub use scene_segment::{SegmentStanding, judge_segment};
pub use segment::{surely_blocked, surely_clear_of};
pub use solid_claim::replay_solid_occlusion;
pub use surface_claim::replay_surface_occlusion;
pub use visibility_claim::{
    PolygonStanding, hull_is_separated, judge_polygon, visibility_counterexample,
};
