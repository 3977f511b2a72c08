//! Furnished places.

mod cornell;
mod corridor;
mod offices;
mod room;
mod two_rooms;

pub use cornell::{cornell, cornell_spheres};
pub use corridor::corridor;
pub use offices::offices;
pub use two_rooms::two_rooms;
