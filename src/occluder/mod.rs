//! Occluders: rectangles with a thickness that are certainly covered by opaque surface.
//!
//! Paper, section 3.2. The stages, one file each: flat clusters (`candidate`) -> oriented
//! sheet of projected triangles -> welded boundary -> footprint -> bounding rectangle -> quadtree
//! -> grown rectangles -> occluders checked in exact arithmetic -> solids that they close (`solid_search`).

mod boundary;
mod bounding_rectangle;
mod candidate;
mod config;
mod extract;
mod footprint;
mod frame;
mod grow;
mod point_grid;
mod quadtree;
mod rectangle;
mod set;
mod sheet;
mod simplify;
mod slab;
mod solid;
mod solid_search;
mod thicken;
mod weld;

#[cfg(test)]
mod tests;

pub use candidate::flat_clusters;
pub use config::OccluderConfig;
pub use extract::extract_occluders;
pub use set::{ExtractionSeconds, Occluder, OccluderSet, OccluderStatistics};
pub use slab::SlabRectangle;
pub use solid::Solid;
