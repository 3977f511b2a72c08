//! The program as its users meet it: what it writes, what it says, and with which code it ends.

mod arguments;
mod batch;
mod command;
mod comparisons;
mod configuration;
mod determinism;
mod hostile;
mod interruption;
mod invalid_scenes;
mod logging;
mod manual;
mod messages;
mod other_commands;
mod references;
mod reports;
mod results;
mod resumption;
mod sweeps;
mod unwritable;
