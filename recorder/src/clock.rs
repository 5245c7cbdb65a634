//! The clocks of recordings: that of the machine, by which samples have their times, and that of the world.
//!
//! Owns how they are read. Knows no recording.

use nix::sys::time::TimeSpec;
use nix::time::{ClockId, clock_gettime};

/// A clock, in ns.
pub(crate) fn clock_ns(clock: ClockId) -> i64 {
    // Seconds of the controller have 32 bits.
    #[allow(clippy::useless_conversion, reason = "they have 64 on a PC")]
    let ns = |time: TimeSpec| i64::from(time.tv_sec()) * 1_000_000_000 + i64::from(time.tv_nsec());
    clock_gettime(clock).map_or(0, ns)
}

/// What the clock of the world is ahead of the machine's own.
pub(crate) fn offset_ns() -> i64 {
    clock_ns(ClockId::CLOCK_REALTIME) - clock_ns(ClockId::CLOCK_MONOTONIC)
}

/// The time of the world, in ns since 1970.
pub fn now_ns() -> u64 {
    u64::try_from(clock_ns(ClockId::CLOCK_REALTIME)).unwrap_or(0)
}
