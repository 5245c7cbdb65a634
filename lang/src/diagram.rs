//! Diagrams: a save as a graph of blocks, and what can be done with it.

pub mod project;
pub mod structure;
pub mod tree;
