//! Large convex occluders from flat face clusters (paper, section 3).

mod slab;

pub use slab::SlabRectangle;
