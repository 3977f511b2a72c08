//! Furnished places.

mod cornell;
mod corridor;
mod flat;
mod gallery;
mod guest_house;
mod interiors;
mod living_room;
mod offices;
mod room;
mod showrooms;
mod two_rooms;
mod warehouse;

pub use cornell::{cornell, cornell_spheres};
pub use corridor::corridor;
pub use flat::flat;
pub use gallery::gallery;
pub use guest_house::guest_house;
pub use living_room::living_room;
pub use offices::offices;
pub use showrooms::showrooms;
pub use two_rooms::two_rooms;
pub use warehouse::warehouse;
