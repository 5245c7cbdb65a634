//! The two clocks of a sample: monotonic for ages and order, real time for `stat`.
//!
//! Owns reading them, nothing else.

use nix::time::{ClockId, clock_gettime};
use std::time::{Duration, SystemTime};

/// When a sample was taken, in nanoseconds of CLOCK_MONOTONIC.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Stamp(pub u64);

fn now_ns(clock: ClockId) -> u64 {
    clock_gettime(clock).map_or(0, |time| {
        u64::try_from(Duration::from(time).as_nanos()).unwrap_or(u64::MAX)
    })
}

impl Stamp {
    /// This moment.
    pub fn now() -> Self {
        Self(now_ns(ClockId::CLOCK_MONOTONIC))
    }

    /// Nanoseconds from this stamp until now.
    pub fn age_ns(self) -> u64 {
        Self::now().0.saturating_sub(self.0)
    }

    /// The same moment in real time, by the clocks' present distance.
    pub fn system_time(self) -> SystemTime {
        let age = Duration::from_nanos(self.age_ns());
        SystemTime::now()
            .checked_sub(age)
            .unwrap_or(SystemTime::UNIX_EPOCH)
    }
}

/// Milliseconds of the coarse monotonic clock, which costs a few nanoseconds and is a few milliseconds late. Wraps.
pub fn coarse_ms() -> u32 {
    let Ok(time) = clock_gettime(ClockId::CLOCK_MONOTONIC_COARSE) else {
        return 0;
    };
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "differences are taken modulo 2^32"
    )]
    let ms = (time.tv_sec() as u32)
        .wrapping_mul(1000)
        .wrapping_add((time.tv_nsec() / 1_000_000) as u32);
    ms
}

/// Real time minus monotonic time.
pub fn realtime_offset_ns() -> i128 {
    i128::from(now_ns(ClockId::CLOCK_REALTIME)) - i128::from(now_ns(ClockId::CLOCK_MONOTONIC))
}
