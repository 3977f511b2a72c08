//! Furniture: closed solids standing on z = 0 around the origin, their backs towards +y.
//!
//! `cell` is the largest side of a mesh cell in metres, `segments` the sides of what is round: the
//! two knobs that set the number of triangles.

mod bed;
mod chair;
mod crates;
mod cupboard;
mod desk;
mod lamp;
mod plant;
mod screen;
mod shelf;
mod sofa;
mod table;

pub use bed::bed;
pub use chair::{chair, panel_chair, stool};
pub use crates::{BAY, RackSize, crate_stack, rack};
pub use cupboard::{bath, counter, cupboard};
pub use desk::desk;
pub use lamp::{floor_lamp, lamp_panel, lantern, table_lamp};
pub use plant::{plant, vase};
pub use screen::{bench, block, screen};
pub use shelf::{ShelfSize, shelf};
pub use sofa::sofa;
pub use table::{round_table, table};
