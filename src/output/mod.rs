//! What a solve leaves on disk: the solution as a mesh, its picture and its numbers.

mod atomic;
mod auto_camera;
mod camera;
mod canvas;
mod checkpoint_file;
mod cluster_colours;
mod colour_scale;
mod comparison_table;
mod emitters;
mod error;
mod exhibit;
#[cfg(test)]
mod exhibit_tests;
mod exr_file;
mod eye_places;
mod face_errors;
mod fingerprint;
#[cfg(test)]
mod fixture;
#[cfg(test)]
mod forms_tests;
mod gathering;
#[cfg(test)]
mod gathering_tests;
mod glb_file;
mod incidence;
mod legend;
mod level_frame;
mod mean_value;
mod occluder_mesh;
mod occluder_sheets;
mod outputs_block;
mod overlay;
mod panel;
mod panel_reflectance;
mod picture;
mod ply_reader;
#[cfg(test)]
mod ply_tests;
mod ply_writer;
mod png_file;
mod ray_density;
mod reference_comparison;
mod reference_file;
mod rendering;
mod report;
mod smoothing;
mod solved_mesh;
mod staging;
mod stats_file;
mod surface_points;
mod sweep_plot;
mod sweep_table;
mod tonemap;
mod up_axis;
mod vertex_value;
mod vertical;
mod view;
#[cfg(test)]
mod view_tests;
mod vtu_file;

pub use atomic::{FileWriter, write_atomically};
pub use camera::{Camera, CameraError, PinHole};
pub use canvas::Canvas;
pub use checkpoint_file::{
    CheckpointError, CheckpointKey, CheckpointProblem, read_checkpoint, write_checkpoint,
};
pub use cluster_colours::write_cluster_ply;
pub use colour_scale::{ColourScale, Spread};
pub use comparison_table::{comparison_csv, comparison_markdown};
pub use error::OutputError;
pub use exhibit::{Exhibit, Shown};
pub use exr_file::write_exr;
pub use face_errors::errors_of_faces;
pub use fingerprint::{ContentBlock, Fingerprint, HashText, file_hash, scene_hash};
pub use glb_file::write_glb;
pub use occluder_mesh::{OccluderSummary, write_occluders};
pub use outputs_block::{OutputsBlock, read_outputs, replace_outputs};
pub use picture::{Picture, Pixel};
pub use ply_reader::read_ply;
pub use ply_writer::write_ply;
pub use png_file::write_png;
pub use ray_density::{RaysByReceiver, ray_density};
pub use reference_comparison::{ComparisonError, noise_of_faces, solved_lights, true_faces};
pub use reference_file::{
    ReadReference, ReferenceFace, ReferenceMeta, ReferenceRequest, mean_radiosity, read_reference,
    write_reference,
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
pub use up_axis::UpAxis;
pub use view::{Shading, View, ViewConfig};
pub use vtu_file::write_vtu;
