//! The peripheral filesystem: device nodes in, files in physical units out.
//!
//! From the kernel inwards: `transport` (the only part that knows FUSE), `fs` (operations), `tree` (names),
//! `files` (what is open), `node` (what a name stands for), `reader`, `state_reader`, `writer`, `newest` (the ways
//! data takes), `hub` (one opening for many readers), `device` (sources), `convert` (converters).
//! Beside them: `reload` and `daemon`, `events` and `engine`, `mount`, `guardian`, `check`, `trial`, `kit`, `cli`.

pub mod admission;
pub mod bytes;
pub mod check;
pub mod cli;
pub mod clock;
mod command;
pub mod convert;
pub mod crew;
pub mod daemon;
pub mod device;
pub mod engine;
pub mod errno;
pub mod events;
pub mod failure;
pub mod files;
pub mod fs;
pub mod guardian;
pub mod hash;
pub mod hub;
pub mod kit;
pub mod latch;
pub mod lease;
pub mod limits;
pub mod log;
mod memory;
pub mod mount;
pub mod newest;
pub mod node;
pub mod panics;
pub mod process;
pub mod programs;
pub mod reader;
pub mod regulation;
pub mod reload;
pub mod sample_bus;
#[cfg(test)]
mod scratch;
pub mod setup;
pub mod state_reader;
pub mod stats;
pub mod text;
pub mod transport;
pub mod tree;
pub mod trial;
pub mod writer;
