//! Built-in scenes: furnished places, and scenes with known answers.

mod analytic;
mod blocks;
mod border;
mod catalogue;
mod cell_grid;
mod dice;
#[allow(dead_code, unused_imports)]
mod furniture;
#[allow(dead_code)]
mod lathe;
mod material;
mod mesh;
mod obj_text;
#[allow(dead_code)]
mod palette;
#[allow(dead_code)]
mod placement;
mod places;
mod plate;
mod shell;
mod sphere;
mod unknown_scene;
mod weakly_convex;

pub use catalogue::{CatalogueEntry, GeneratedScene, catalogue, generate};
pub use unknown_scene::UnknownScene;
