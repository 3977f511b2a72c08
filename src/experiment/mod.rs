//! Experiments on the engine: the audit of its guarantees, and what they detect.

mod audit;
#[cfg(test)]
mod audit_tests;
mod continuous_surface;
mod detection;
mod dice;
mod element_points;
mod flat_polygon;
mod polygon_boxes;
mod ray_attack;
mod shaft_replay;
mod surface_chain;

pub use audit::{AuditConfig, AuditError, AuditReport, Flaw, audit};
pub use detection::{Detection, DetectionConfig, detection};
