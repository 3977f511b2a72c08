//! The reference against closed forms, within its own error bars. The seeds are fixed, so every test gives the
//! same answer on every run; the levels say how likely a right reference would have been to fail.
//!
//! `cargo test --test reference -- --nocapture` prints what was measured.

mod cie171;
mod determinism;
mod furnace;
mod measured;
mod overlaps;
mod plates;
mod sealed;
mod z_scores;
