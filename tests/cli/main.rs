//! The program as its users meet it: what it writes, what it says, and with which code it ends.

mod arguments;
mod command;
mod comparisons;
mod determinism;
mod hostile;
mod interruption;
mod invalid_scenes;
mod messages;
mod other_commands;
mod references;
mod results;
mod sweeps;
mod unwritable;
