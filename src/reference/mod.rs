//! Known answers that the engine is measured against.

mod closed_forms;

pub use closed_forms::{
    coaxial_discs, concentric_spheres, interreflection_illuminance, parallel_rectangles,
    perpendicular_rectangles, point_to_parallel_rectangle, point_to_perpendicular_rectangle,
    two_infinite_plates,
};
