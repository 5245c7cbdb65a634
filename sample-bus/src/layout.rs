//! The layout of a ring in memory: numbers and sizes.
//!
//! Owns what the C header and docs/user/sample-bus.md repeat; a change of any number here is a new [`MAGIC`].
//! All numbers have the byte order of the machine.

use crate::limits;
use std::io;

/// The first bytes of a ring.
pub const MAGIC: [u8; 8] = *b"TRIKSMP1";
/// Bytes before the first slot.
pub const HEADER_BYTES: usize = 64;
/// Bytes of a slot before its tuple.
pub const SLOT_HEADER_BYTES: usize = 32;

/// Offset in the ring: size of what comes before the slots, [`HEADER_BYTES`].
pub const AT_HEADER_BYTES: usize = 8;
/// Offset in the ring: distance between two slots.
pub const AT_SLOT_BYTES: usize = 12;
/// Offset in the ring: number of slots, a power of two.
pub const AT_SLOTS: usize = 16;
/// Offset in the ring: room for a tuple.
pub const AT_TUPLE_BYTES: usize = 20;
/// Offset in the ring: age in ms from which a sample is no longer the newest value; 0: it never is too old.
pub const AT_STALE_MS: usize = 24;
/// Offset in the ring: [`LIVE`] or [`ENDED`].
pub const AT_STATE: usize = 28;
/// Offset in the ring: number of the newest event, 0 before the first.
pub const AT_NEWEST: usize = 32;

/// Offset in a slot: number of the event that is being written.
pub const AT_BEGIN: usize = 0;
/// Offset in a slot: number of the event that has been written.
pub const AT_END: usize = 4;
/// Offset in a slot: size, errno, time; then the tuple at [`SLOT_HEADER_BYTES`].
pub const AT_SIZE: usize = 8;

/// The node is published.
pub const LIVE: u32 = 0;
/// The node is gone: nothing more comes.
pub const ENDED: u32 = 1;

/// Sizes of one ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Room for a tuple.
    pub tuple_bytes: usize,
    /// Number of slots, a power of two.
    pub slots: usize,
    /// Distance between two slots.
    pub slot_bytes: usize,
}

impl Layout {
    /// The ring for tuples of one size.
    ///
    /// # Errors
    /// The tuple is too large.
    pub fn new(tuple_bytes: usize) -> io::Result<Self> {
        if tuple_bytes > limits::TUPLE_BYTES_MAX {
            return Err(io::Error::other(format!(
                "tuples of {tuple_bytes} bytes are larger than {} bytes",
                limits::TUPLE_BYTES_MAX
            )));
        }
        let slot_bytes = (SLOT_HEADER_BYTES + tuple_bytes).next_multiple_of(64);
        let mut slots = limits::SLOTS;
        while slots > limits::SLOTS_MIN && slots * slot_bytes > limits::RING_BYTES {
            slots /= 2;
        }
        Ok(Self {
            tuple_bytes,
            slots,
            slot_bytes,
        })
    }

    /// Checks what a foreign ring says about itself against the size of its file.
    ///
    /// # Errors
    /// What is wrong.
    pub fn check(header: &[u8; HEADER_BYTES], file_bytes: u64) -> io::Result<Self> {
        let bad = |what: &str| {
            io::Error::new(
                io::ErrorKind::InvalidData,
                format!("not a ring of samples: {what}"),
            )
        };
        if header[..MAGIC.len()] != MAGIC {
            return Err(bad("it begins with other bytes, or is of another version"));
        }
        let number = |at: usize| {
            let mut bytes = [0; 4];
            bytes.copy_from_slice(&header[at..at + 4]);
            usize::try_from(u32::from_ne_bytes(bytes)).unwrap_or(usize::MAX)
        };
        let layout = Self {
            tuple_bytes: number(AT_TUPLE_BYTES),
            slots: number(AT_SLOTS),
            slot_bytes: number(AT_SLOT_BYTES),
        };
        if number(AT_HEADER_BYTES) != HEADER_BYTES {
            return Err(bad("the size of its header"));
        }
        if layout.tuple_bytes > limits::TUPLE_BYTES_MAX {
            return Err(bad("the size of its tuples"));
        }
        if !layout.slots.is_power_of_two() || layout.slots > limits::SLOTS_MAX {
            return Err(bad("the number of its slots"));
        }
        if !layout.slot_bytes.is_multiple_of(8)
            || layout.slot_bytes < SLOT_HEADER_BYTES + layout.tuple_bytes.next_multiple_of(8)
        {
            return Err(bad("the size of its slots"));
        }
        let whole = layout.slots.checked_mul(layout.slot_bytes);
        let whole = whole.and_then(|slots| slots.checked_add(HEADER_BYTES));
        match whole {
            Some(whole) if whole as u64 <= file_bytes => Ok(layout),
            _ => Err(bad("it is shorter than it says")),
        }
    }

    /// Bytes of the whole ring.
    pub fn bytes(&self) -> usize {
        HEADER_BYTES + self.slots * self.slot_bytes
    }

    /// Where the slot of an event begins.
    pub fn slot_at(&self, event: u32) -> usize {
        let event = usize::try_from(event).unwrap_or(usize::MAX);
        HEADER_BYTES + (event & (self.slots - 1)) * self.slot_bytes
    }
}

/// The number of the next event: 0 is left out, because it stands for no event.
pub fn next_event(event: u32) -> u32 {
    event.wrapping_add(1).max(1)
}
