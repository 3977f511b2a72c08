//! Scenes with known answers.

mod cie171;
mod furnace;
mod plates;
mod sealed;
mod spheres;

pub use cie171::{cie171_diffuse_reflection, cie171_flux, cie171_interreflection};
pub use furnace::{FurnaceContent, furnace};
pub use plates::{coaxial_discs, infinite_plates, parallel_plates, perpendicular_plates};
pub use sealed::{sealed, sealed_slab};
pub use spheres::concentric_spheres;
