//! The program as its users meet it: what it writes, what it says, and with which code it ends.

mod arguments;
mod batch;
mod command;
mod comparisons;
mod configuration;
mod damaged;
mod determinism;
mod full_disk;
mod hostile;
mod interruption;
mod invalid_scenes;
mod logging;
mod manual;
mod messages;
mod not_a_number;
mod other_commands;
mod overwriting;
mod references;
mod reports;
mod results;
mod resumption;
mod sweeps;
mod unwritable;
mod views;
