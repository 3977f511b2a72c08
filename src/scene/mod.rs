//! From an OBJ file to a validated, normalised scene.

mod model;

pub use model::{Facet, Normalisation, Polygon, Scene, SceneWarning, Side, Surface};
