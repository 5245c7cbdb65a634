//! Every limit of the bridges.
//!
//! Owns the numbers only; the code that enforces each one names it from here.

use std::time::Duration;

/// Numbers of one node that become series: a picture or a cloud of points is none.
pub const FIELDS_MAX: usize = 64;
/// Kinds of failures of one node that are counted apart.
pub const ERRNOS_MAX: usize = 16;
/// Bytes of `status` that are read.
pub const STATUS_BYTES_MAX: u64 = 1 << 20;
/// Bytes of a request and its head.
pub const HEAD_BYTES_MAX: usize = 8 << 10;
/// Requests that are served at once; a further one is told to come later.
pub const CONNECTIONS_MAX: usize = 8;
/// From the first byte of a request to the last byte of its answer.
pub const REQUEST_TIME: Duration = Duration::from_secs(5);
/// Until a tree that has gone is looked for again.
pub const RETURN_TIME: Duration = Duration::from_secs(1);
