//! Waiting for what must come, and saying by name what cannot be tried here.
//!
//! Owns the two time limits of the suite. A condition is looked at again and again: nothing waits for a fixed time.

use needs::Need;
pub use needs::test_name;
use std::time::{Duration, Instant};

/// How long anything that must happen may take before the test fails. Generous: two processors serve all tests, and the
/// programs of a robot go after everything else, so beside busy loops Python alone needs many seconds to start.
pub const SOON: Duration = Duration::from_secs(90);
/// How long a whole mount may live before everything that hangs on it is cut off.
pub const LIFE: Duration = Duration::from_secs(300);

/// Looks until the condition holds.
///
/// # Panics
/// With `what`, when [`SOON`] is over.
pub fn eventually(what: &str, mut holds: impl FnMut() -> bool) {
    let deadline = Instant::now() + SOON;
    let mut pause = Duration::from_micros(200);
    while !holds() {
        assert!(Instant::now() < deadline, "not within {SOON:?}: {what}");
        std::thread::sleep(pause);
        pause = (pause * 2).min(Duration::from_millis(20));
    }
}

/// What nine tenths of these do not exceed: a busy machine makes single ones slow.
///
/// # Panics
/// There are none.
pub fn nine_tenths(times: &mut [Duration]) -> Duration {
    times.sort_unstable();
    times[times.len() * 9 / 10]
}

/// Says that the running test is skipped, and why. A limit of the machine: with `TRIK_REQUIRE_FUSE=1` it is a failure.
///
/// # Panics
/// With `TRIK_REQUIRE_FUSE=1`.
pub fn skip(why: &str) {
    Need::Fuse.missing(why);
}

/// Says that the running test is skipped for a reason that no machine can change.
pub fn note_skip(why: &str) {
    Need::Extra.missing(why);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_of_twenty_may_be_slow() {
        let mut times: Vec<Duration> = (0..19).chain([500]).map(Duration::from_secs).collect();
        assert_eq!(nine_tenths(&mut times), Duration::from_secs(18));
    }

    #[test]
    fn what_holds_at_the_third_look_is_waited_for() {
        let mut looks = 0;
        eventually("three looks", || {
            looks += 1;
            looks == 3
        });
    }
}
