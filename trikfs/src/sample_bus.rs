//! Samples in shared memory, for programs that want no system call and no copy: the filesystem's side of it.
//!
//! Owns which directory a mount has there, who may read it, and how much memory it takes. How a ring of samples looks
//! is the crate `sample-bus`'s business. `shared` does it; `absent` is what a build without the feature has instead.

#[cfg(not(feature = "sample-bus"))]
mod absent;
#[cfg(feature = "sample-bus")]
mod shared;

#[cfg(not(feature = "sample-bus"))]
pub use absent::{Ring, SampleBus, remove_left};
#[cfg(feature = "sample-bus")]
pub use shared::{Ring, SampleBus, remove_left};

/// Who may read the samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Readers {
    /// The user who has mounted the tree, like the tree itself.
    Owner,
    /// Everybody whom the mode of a node lets in: the tree is mounted with `--allow-other`.
    All,
}
