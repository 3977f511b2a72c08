//! What a solve leaves on disk: the solution as a mesh, its picture and its numbers.

mod atomic;
mod auto_camera;
mod camera;
mod checkpoint_file;
mod cluster_colours;
mod comparison_table;
mod error;
mod exr_file;
mod eye_places;
mod fingerprint;
#[cfg(test)]
mod fixture;
mod incidence;
mod mean_value;
mod occluder_mesh;
mod panel;
mod picture;
mod ply_reader;
#[cfg(test)]
mod ply_tests;
mod ply_writer;
mod png_file;
mod reference_comparison;
mod reference_file;
mod report;
mod smoothing;
mod solved_mesh;
mod staging;
mod stats_file;
mod sweep_plot;
mod sweep_table;
mod tonemap;
mod view;
#[cfg(test)]
mod view_tests;

pub use atomic::{FileWriter, write_atomically};
pub use camera::{Camera, CameraError, PinHole};
pub use checkpoint_file::{
    CheckpointError, CheckpointKey, CheckpointProblem, read_checkpoint, write_checkpoint,
};
pub use cluster_colours::write_cluster_ply;
pub use comparison_table::{comparison_csv, comparison_markdown};
pub use error::OutputError;
pub use exr_file::write_exr;
pub use fingerprint::{ContentBlock, Fingerprint, HashText, file_hash, scene_hash};
pub use occluder_mesh::{OccluderSummary, write_occluders};
pub use picture::{Picture, Pixel};
pub use ply_reader::read_ply;
pub use ply_writer::write_ply;
pub use png_file::write_png;
pub use reference_comparison::{ComparisonError, solved_lights, true_faces};
pub use reference_file::{
    ReferenceFace, ReferenceMeta, mean_radiosity, read_reference, write_reference,
};
pub use report::{ReportError, write_report};
pub use solved_mesh::{SolvedFace, SolvedMesh};
pub use staging::Staging;
pub use stats_file::{HierarchyBlock, SceneBlock, SecondsBlock, StatsFile, write_json, write_text};
pub use sweep_plot::{SweepCost, write_sweep_plot};
pub use sweep_table::{
    DEFAULTS, NamedSettings, SweepKey, SweepMeta, read_sweep, sweep_csv, write_sweep,
};
pub use tonemap::ToneMap;
pub use view::{Shading, View, ViewConfig};
