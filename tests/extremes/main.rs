//! Scenes and settings at the edge of what is allowed, each with a stated tolerance; `docs/extremes.md` says what is
//! promised in each case and names the test.

mod agreement;
mod crowds;
mod gaps;
mod lights;
mod mesh;
mod neighbours;
mod reflectances;
mod settings;
mod similarity;
mod slivers;
