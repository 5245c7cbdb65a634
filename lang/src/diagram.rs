//! Diagrams: a save as a graph of blocks, and what can be done with it.

pub mod archive;
pub mod blocks;
pub mod objects;
pub mod ports;
pub mod project;
pub mod read;
pub mod sketch;
pub mod structure;
pub mod tree;
