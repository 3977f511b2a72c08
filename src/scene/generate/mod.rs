//! Built-in scenes: furnished places, and scenes with known answers.

mod analytic;
mod blocks;
mod border;
mod catalogue;
mod cell_grid;
mod dice;
mod furniture;
mod lathe;
mod material;
mod mesh;
mod obj_text;
mod palette;
mod placement;
mod places;
mod plate;
mod shell;
mod sphere;
mod unknown_scene;
mod weakly_convex;

pub use catalogue::{CatalogueEntry, GeneratedScene, catalogue, generate};
pub use unknown_scene::UnknownScene;
