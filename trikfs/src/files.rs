//! Open files: one type for each kind of file in the tree, all with one trait.
//!
//! Owns the trait and nothing else; each type has a file below. Knows no name in the tree.

// A kind of file that is forgotten must not be another one in silence.
#![deny(clippy::wildcard_enum_match_arm)]

pub mod config;
pub mod control;
pub mod device;
pub mod devices;
pub mod log;
pub mod owner;
pub mod ownership;
pub mod param;
pub mod stages;
pub mod value;

use crate::errno::Error;
use crate::transport::{Caller, Outcome, PollHandle, RequestId, Transfer};

/// What can be asked of an open file. Operations that a kind does not name are refused here.
pub trait OpenFile: Send + Sync {
    /// See [`crate::transport::Operations::read`].
    fn read(&self, _request: &Transfer, _out: &mut [u8]) -> Result<Outcome, Error> {
        Err(Error::AccessDenied)
    }

    /// Whether the kernel may read this file into its page cache.
    fn is_cached(&self) -> bool {
        false
    }

    /// See [`crate::transport::Operations::write`].
    fn write(&self, _request: &Transfer, _data: &[u8]) -> Result<Outcome, Error> {
        Err(Error::AccessDenied)
    }

    /// See [`crate::transport::Operations::poll`]. A plain file is always ready.
    fn poll(&self, _handle: PollHandle, events: u32) -> Result<u32, Error> {
        Ok(events & READY)
    }

    /// A descriptor was closed.
    fn flush(&self, _id: RequestId, _caller: Caller) -> Result<Outcome, Error> {
        Ok(Outcome::Done(0))
    }

    /// fsync(2).
    fn fsync(&self, _id: RequestId, _caller: Caller) -> Result<Outcome, Error> {
        Ok(Outcome::Done(0))
    }

    /// ftruncate(2).
    fn truncate(&self, _size: u64) -> Result<(), Error> {
        Ok(())
    }

    /// Bytes of memory that the file keeps for its reader or writer beside itself.
    fn held_bytes(&self) -> usize {
        0
    }

    /// The last descriptor is gone.
    fn release(&self) {}

    /// The node of the file was retired: answer the requests that wait.
    fn retire(&self) {}
}

/// Readable bits of poll(2).
pub const READABLE: u32 = (libc::POLLIN | libc::POLLRDNORM) as u32;
/// Writable bits of poll(2).
pub const WRITABLE: u32 = (libc::POLLOUT | libc::POLLWRNORM) as u32;
/// Both.
pub const READY: u32 = READABLE | WRITABLE;
