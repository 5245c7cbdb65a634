//! Diagrams: a save as a graph of blocks, and what can be done with it.

// A kind of block, operation, command or value that is forgotten must not compile.
#![deny(clippy::wildcard_enum_match_arm)]
// Problems are rare, and their size costs nothing where none is.
#![allow(clippy::result_large_err)]

pub mod archive;
pub mod blocks;
pub mod brick;
pub mod check;
pub mod convert;
pub mod debug;
pub mod devices;
pub mod edit;
pub mod fuzz;
pub mod generate;
pub mod limits;
pub mod lower;
pub mod machine;
pub mod mailbox;
pub mod objects;
pub mod ports;
pub mod program;
pub mod project;
pub mod read;
pub mod save;
pub mod show;
pub mod sketch;
pub mod stand_in;
pub mod structure;
pub mod tree;
pub mod version;
mod words;
