//! From an OBJ file to a validated, normalised scene.

mod assets;
mod config;
mod degenerate;
mod error;
pub mod generate;
mod load;
mod material;
mod model;
mod mtl_scan;
mod normalise;
mod obj_parse;
mod obj_scan;
mod polygons;
mod statement;
mod surface;
mod texture;
mod texture_map;
mod triangulate;

pub use config::{CLAMPED_REFLECTANCE, LoadConfig};
pub use error::{Defect, LoadError, MAX_ELEMENTS, Reason};
pub use load::{load_file, load_text};
pub use model::{Facet, Normalisation, Polygon, Scene, SceneWarning, Side, Surface};
