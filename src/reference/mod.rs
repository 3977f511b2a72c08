//! Known answers that the engine is measured against: closed forms, and radiosity measured by path tracing.

mod closed_forms;
mod config;
mod estimate;
mod measure;
mod observer;
mod path_tracer;
mod plan;
mod random;
mod solution_error;
mod solution_lights;
mod source_side;
mod traced_scene;
mod weighted_choice;

pub use closed_forms::{
    coaxial_discs, concentric_spheres, interreflection_illuminance, parallel_rectangles,
    perpendicular_rectangles, point_to_parallel_rectangle, point_to_perpendicular_rectangle,
    two_infinite_plates,
};
pub use config::{ReferenceConfig, ReferenceConfigError};
pub use measure::{FaceRadiosity, Reference, ReferenceError, measure};
pub use observer::{ReferenceObserver, SilentReference};
pub use solution_error::{
    FaceError, NothingToCompare, ReferenceNoise, SolutionError, SolvedLight, SolvedLights,
    TrueFace, reference_noise, solution_error,
};
pub use solution_lights::solution_lights;
pub use traced_scene::TracedScene;
