//! The number of the only fault that a recorder makes itself.
//!
//! Owns that number. All others are the filesystem's.

/// The node has left the tree; a handle that is still open gives the same.
pub const LEFT: i32 = libc::ESTALE;
