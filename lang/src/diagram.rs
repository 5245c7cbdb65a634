//! Diagrams: a save as a graph of blocks, and what can be done with it.

pub mod archive;
pub mod convert;
pub mod objects;
pub mod project;
pub mod read;
pub mod save;
pub mod sketch;
pub mod version;
