//! How the publisher and the readers of a ring agree on one event: its number before its bytes, and again after them.
//!
//! Owns the order of stores and loads, over any [`Memory`]. Knows no file and no mapping; `ring/model.rs` tries all orders
//! in which two processors can see them.

use crate::layout::{self, Layout};
use std::sync::atomic::Ordering;

/// One sample, or one failure to take one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Event {
    /// Its number: 1 for the first of the ring, and so on; 0 is left out when it wraps.
    pub sequence: u32,
    /// When it was taken, in ns of CLOCK_MONOTONIC.
    pub time_ns: u64,
    /// 0 for a sample; else why there is none.
    pub errno: i32,
}

#[cfg(all(test, loom))]
mod model;

/// Memory that another may read or write at any moment: each number and each word is whole, their order is that of fences.
pub(crate) trait Memory {
    /// Reads a number; order it with a fence.
    fn get(&self, at: usize) -> u32;
    /// Writes a number; order it with a fence.
    fn set(&self, at: usize, number: u32);
    /// Writes bytes; the rest of the last word becomes 0.
    fn copy_in(&self, at: usize, bytes: &[u8]);
    /// Reads bytes.
    fn copy_out(&self, at: usize, bytes: &mut [u8]);
    /// Orders what is before it and what is after it.
    fn fence(&self, order: Ordering);
}

/// Writes an event into its slot and makes it the newest. The tuple must not be larger than its room.
pub(crate) fn write(memory: &impl Memory, layout: &Layout, event: Event, tuple: &[u8]) {
    let slot = layout.slot_at(event.sequence);
    memory.set(slot + layout::AT_BEGIN, event.sequence);
    // A reader that sees a byte of what follows also sees that it has begun.
    memory.fence(Ordering::Release);
    let size = u32::try_from(tuple.len()).unwrap_or(0);
    let mut head = [0; 16];
    head[..4].copy_from_slice(&size.to_ne_bytes());
    head[4..8].copy_from_slice(&event.errno.to_ne_bytes());
    head[8..].copy_from_slice(&event.time_ns.to_ne_bytes());
    memory.copy_in(slot + layout::AT_SIZE, &head);
    memory.copy_in(slot + layout::SLOT_HEADER_BYTES, tuple);
    // A reader that sees the end also sees what came before.
    memory.fence(Ordering::Release);
    memory.set(slot + layout::AT_END, event.sequence);
    memory.set(layout::AT_NEWEST, event.sequence);
}

/// The number of the newest event; 0 before the first.
pub(crate) fn newest(memory: &impl Memory) -> u32 {
    let sequence = memory.get(layout::AT_NEWEST);
    memory.fence(Ordering::Acquire);
    sequence
}

/// The event with a number, with its bytes. None: it is not there yet, or no longer.
pub(crate) fn read(
    memory: &impl Memory,
    layout: &Layout,
    sequence: u32,
    tuple: &mut Vec<u8>,
) -> Option<Event> {
    let slot = layout.slot_at(sequence);
    let end = memory.get(slot + layout::AT_END);
    // What was written before the end is seen after this.
    memory.fence(Ordering::Acquire);
    if end != sequence {
        return None;
    }
    let mut head = [0; 16];
    memory.copy_out(slot + layout::AT_SIZE, &mut head);
    let [size, errno, time_low, time_high] = split(head);
    let size = usize::try_from(size).ok()?.min(layout.tuple_bytes);
    tuple.resize(size, 0);
    memory.copy_out(slot + layout::SLOT_HEADER_BYTES, tuple);
    // If a byte of a later event was seen above, its beginning is seen below.
    memory.fence(Ordering::Acquire);
    if memory.get(slot + layout::AT_BEGIN) != sequence {
        return None;
    }
    let mut time = [0; 8];
    time[..4].copy_from_slice(&time_low.to_ne_bytes());
    time[4..].copy_from_slice(&time_high.to_ne_bytes());
    Some(Event {
        sequence,
        time_ns: u64::from_ne_bytes(time),
        errno: i32::from_ne_bytes(errno.to_ne_bytes()),
    })
}

fn split(head: [u8; 16]) -> [u32; 4] {
    let (numbers, _) = head.as_chunks::<4>();
    std::array::from_fn(|at| {
        numbers
            .get(at)
            .map_or(0, |bytes| u32::from_ne_bytes(*bytes))
    })
}
