//! Diagrams: a save as a graph of blocks, and what can be done with it.

pub mod blocks;
pub mod ports;
pub mod project;
