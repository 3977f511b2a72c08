//! Boxes, cones, planes, typed ids, colour and low-discrepancy points.

mod aabb;
mod cone;
mod ids;
mod plane;
mod sequence;

pub use aabb::Aabb;
pub use cone::Cone;
pub use ids::{FacetId, NodeId, PolygonId};
pub use plane::Plane;
pub use sequence::{SampleSequence, hash_u64};
