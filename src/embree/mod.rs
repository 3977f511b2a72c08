//! Intel Embree 4 behind safe types: the only `unsafe` code of the engine.
//!
//! A [`Device`] makes a [`CommittedScene`], which answers occlusion queries by packets of rays and
//! nearest-hit queries in batches, from any number of threads at once; an [`AllHitsScene`] lists
//! every hit of a ray for audits.
//!
//! Embree recommends that callers set the processor's flush-to-zero and denormals-are-zero modes
//! for speed. We do not: the modes belong to a thread, would change the engine's own arithmetic on
//! some threads and not on others, and would void the error bounds of predicates that count on
//! gradual underflow.
#![allow(unsafe_code)]

mod all_hits;
#[cfg(feature = "c-baseline")]
mod c_baseline;
mod device;
mod error;
mod hits;
mod packet;
mod ray;
mod scene;
mod shim;

pub use all_hits::{AllHitsScene, RayHit};
#[cfg(feature = "c-baseline")]
pub use c_baseline::{CBaseline, SingleRay};
pub use device::{Device, DeviceConfig};
pub use error::{EmbreeError, EmbreeErrorKind, EmbreeVersion};
pub use hits::Hit;
pub use packet::{RayPacket8, RayPacket16};
pub use ray::Ray;
pub use scene::CommittedScene;
