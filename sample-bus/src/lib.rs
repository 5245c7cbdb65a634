//! Samples in shared memory: one ring of memory for each node, written by one process and read by any number.
//!
//! Owns the layout of a ring, the names under which rings are found, writing and reading. Knows no FUSE, no
//! configuration and no device. A reader never writes: a subscriber cannot delay, fill or break the publisher.
//!
//! `layout` has the numbers, `place` the names and the directory, `map` the memory, `ring` the order of loads and stores,
//! `writer` and `reader` the two ends.

pub mod layout;
mod limits;
mod map;
pub mod place;
mod reader;
mod ring;
mod writer;

pub use reader::{Event, Reader, Step};
pub use writer::{Rights, Writer};

#[cfg(test)]
mod tests;
