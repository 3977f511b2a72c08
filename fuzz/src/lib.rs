//! What the fuzz targets share: numbers and elements drawn from the fuzzer's bytes.

mod bytes;
mod elements;

pub use bytes::Bytes;
pub use elements::{element, slab, triangle};
