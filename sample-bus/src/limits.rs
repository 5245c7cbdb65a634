//! Every limit of the sample bus.
//!
//! Owns the numbers only; the code that enforces each one names it from here.

use std::time::Duration;

/// Events that a ring keeps while there is room.
pub const SLOTS: usize = 16;
/// Events that a ring keeps of the largest tuples: a reader of the newest one has the time of two more to finish.
pub const SLOTS_MIN: usize = 4;
/// Events of a ring that a reader accepts.
pub const SLOTS_MAX: usize = 1 << 16;
/// Bytes of a ring from which on it keeps fewer events.
pub const RING_BYTES: usize = 4 << 20;
/// Bytes of a tuple on the bus.
pub const TUPLE_BYTES_MAX: usize = 64 << 20;
/// Attempts of a reader to get one event that is overwritten again and again.
pub const ATTEMPTS: usize = 8;
/// Attempts to take a directory that another process has or is just removing.
pub const DIRECTORY_ATTEMPTS: usize = 16;
/// Pause between two of them: who cleans up has a directory for a moment only.
pub const DIRECTORY_PAUSE: Duration = Duration::from_millis(2);
/// Bytes of the longest name of a file, as in the kernel.
pub const NAME_BYTES_MAX: usize = 255;
