//! Whole solves of scenes with known answers. Every test prints what it measured:
//! `cargo test --test closed_forms -- --nocapture` is the table.

mod case;
mod cie171;
mod energy;
mod furnace;
mod plates;
mod reciprocity;
mod sealed;
