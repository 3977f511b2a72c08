//! From an OBJ file to a validated, normalised scene.

mod assets;
mod config;
mod contact_search;
mod contacts;
mod convex;
mod degenerate;
mod error;
mod facet;
mod fingerprint;
mod flat;
pub mod generate;
mod load;
mod material;
mod model;
mod mtl_scan;
mod normalise;
mod obj_parse;
mod obj_scan;
mod overlap;
mod polygon_tree;
mod polygons;
mod side_graph;
mod sides;
mod statement;
mod surface;
mod texture;
mod texture_map;
mod triangulate;

pub use config::{CLAMPED_REFLECTANCE, LoadConfig};
pub use contacts::Contacts;
pub use error::{Defect, LoadError, MAX_ELEMENTS, Reason};
pub use facet::{Facet, Side};
pub use load::{load_file, load_text};
pub use model::{Normalisation, Polygon, Scene, SceneWarning, Surface};
pub use overlap::{Overlaps, find_overlaps};
pub use sides::{SidesMode, resolve_sides};
