//! Samples in shared memory, for programs that want no system call and no copy: the filesystem's side of it.
//!
//! Owns which directory a mount has there, who may read it, and how much memory it takes. How a ring of samples looks
//! is the crate `sample-bus`'s business. `shared` does it; `absent` is what a build without the feature has instead.

#[cfg(not(feature = "sample-bus"))]
mod absent;
#[cfg(feature = "sample-bus")]
mod shared;

use std::fmt;

#[cfg(not(feature = "sample-bus"))]
pub use absent::{Ring, SampleBus, remove_left};
#[cfg(feature = "sample-bus")]
pub use shared::{Ring, SampleBus, remove_left};

/// Why samples are not in shared memory. The machine has to act: its shared memory is full, or others have a name in it.
/// Files are not affected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BusError {
    /// The mount has no sample bus.
    Off(String),
    /// A second name is not there.
    Alias {
        /// The name.
        name: String,
        /// Why.
        why: String,
    },
    /// A node's samples are not published.
    Ring(String),
}

impl fmt::Display for BusError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Off(why) => write!(f, "sample bus: off: {why}; files are not affected"),
            Self::Alias { name, why } => write!(
                f,
                "sample bus: the second name {name} is not there: {why}; files are not affected"
            ),
            Self::Ring(why) => write!(
                f,
                "sample bus: not published: {why}; the node's files are not affected"
            ),
        }
    }
}

impl std::error::Error for BusError {}

/// Who may read the samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Readers {
    /// The user who has mounted the tree, like the tree itself.
    Owner,
    /// Everybody whom the mode of a node lets in: the tree is mounted with `--allow-other`.
    All,
}
