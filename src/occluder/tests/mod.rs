//! Tests of the extraction by what could go wrong: coverage that depends on the mesh, rectangles
//! that reach past the surface, slots that a segment slips through.

mod builders;
mod containment;
mod coverage;
mod planted;
mod solids;
mod soundness;
mod tessellation;
