//! The clock by which a run is bounded in real time. Nothing that a run does depends on it.
//!
//! Owns which clock there is. In a browser the system has none for this code: what runs there brings its own.

use std::fmt;
use std::time::Duration;

/// A clock: time that has passed since some moment.
#[derive(Clone, Copy)]
pub struct Clock(fn() -> Duration);

impl Clock {
    /// One that is read by a function; it never goes back.
    pub fn new(read: fn() -> Duration) -> Self {
        Self(read)
    }

    /// Time since some moment, the same one every time.
    pub fn now(self) -> Duration {
        (self.0)()
    }

    /// Time since an earlier answer of [`Clock::now`].
    pub fn since(self, earlier: Duration) -> Duration {
        self.now().saturating_sub(earlier)
    }
}

impl Default for Clock {
    /// That of the system. Without the feature `board` there is none, and this one stands still: no run takes too long.
    fn default() -> Self {
        Self(system)
    }
}

#[cfg(feature = "board")]
fn system() -> Duration {
    use std::sync::LazyLock;
    use std::time::Instant;

    static BEGAN: LazyLock<Instant> = LazyLock::new(Instant::now);
    BEGAN.elapsed()
}

#[cfg(not(feature = "board"))]
fn system() -> Duration {
    Duration::ZERO
}

impl fmt::Debug for Clock {
    fn fmt(&self, into: &mut fmt::Formatter<'_>) -> fmt::Result {
        into.write_str("Clock")
    }
}
