//! What a solve leaves on disk: the solution as a mesh, its picture and its numbers.

mod atomic;
mod error;
#[cfg(test)]
mod fixture;
mod ply_reader;
#[cfg(test)]
mod ply_tests;
mod ply_writer;
mod solved_mesh;
mod stats_file;
mod tonemap;

pub use atomic::{FileWriter, write_atomically};
pub use error::OutputError;
pub use ply_reader::read_ply;
pub use ply_writer::write_ply;
pub use solved_mesh::{SolvedFace, SolvedMesh};
pub use stats_file::{HierarchyBlock, SceneBlock, SecondsBlock, StatsFile, write_json};
pub use tonemap::ToneMap;
