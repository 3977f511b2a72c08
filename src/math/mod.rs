//! Boxes, cones, planes, typed ids, colour and low-discrepancy points.

mod aabb;
mod cone;
mod ids;
mod plane;
mod scrambled_pairs;
mod sequence;

pub use aabb::Aabb;
pub use cone::Cone;
pub use ids::{FacetId, NodeId, PolygonId};
pub use plane::Plane;
pub use scrambled_pairs::ScrambledPairs;
pub use sequence::{SampleSequence, hash_u64};
