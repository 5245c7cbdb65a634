//! The one clock of a replay: a position in the recording that runs, stands, runs faster, or jumps.
//!
//! Owns the position. Real time is an argument; what happens at a position is not known here.

use crate::limits;
use std::time::{Duration, Instant};

/// A position in a recording of some length.
#[derive(Clone, Debug)]
pub(crate) struct Clock {
    /// The position at `since`.
    at: Duration,
    since: Instant,
    /// Seconds of the recording in a real one.
    speed: f64,
    runs: bool,
    length: Duration,
}

impl Clock {
    /// At the beginning; `speed` is above 0.
    pub(crate) fn new(now: Instant, length: Duration, speed: f64, runs: bool) -> Self {
        Self {
            at: Duration::ZERO,
            since: now,
            speed,
            runs,
            length,
        }
    }

    /// Where it is; at most the end.
    pub(crate) fn position(&self, now: Instant) -> Duration {
        if !self.runs {
            return self.at;
        }
        let real = now.saturating_duration_since(self.since).as_secs_f64();
        let gone = Duration::try_from_secs_f64(real * self.speed).unwrap_or(self.length);
        self.at.saturating_add(gone).min(self.length)
    }

    /// Whether it runs; at the end it stands.
    pub(crate) fn runs(&self, now: Instant) -> bool {
        self.runs && self.position(now) < self.length
    }

    pub(crate) fn speed(&self) -> f64 {
        self.speed
    }

    pub(crate) fn length(&self) -> Duration {
        self.length
    }

    /// When it will be at a position; None if it stands. A position that has gone by is now.
    pub(crate) fn due(&self, position: Duration) -> Option<Instant> {
        if !self.runs {
            return None;
        }
        let left = position.saturating_sub(self.at).as_secs_f64() / self.speed;
        let left = Duration::try_from_secs_f64(left).ok()?;
        self.since.checked_add(left)
    }

    fn settle(&mut self, now: Instant) {
        self.at = self.position(now);
        self.since = now;
    }

    /// Runs on, or stands.
    pub(crate) fn run(&mut self, now: Instant, runs: bool) {
        self.settle(now);
        self.runs = runs;
    }

    /// Another speed from here on.
    pub(crate) fn set_speed(&mut self, now: Instant, speed: f64) {
        self.settle(now);
        self.speed = speed;
    }

    /// Twice as fast from here on, or half.
    pub(crate) fn double(&mut self, now: Instant, up: bool) {
        let speed = self.speed * if up { 2.0 } else { 0.5 };
        self.set_speed(
            now,
            speed.clamp(limits::REPLAY_SPEED_MIN, limits::REPLAY_SPEED_MAX),
        );
    }

    /// Goes back to a moment that has gone by for longer than `late`, in real time: it waits for what is late.
    pub(crate) fn hold(&mut self, now: Instant, position: Duration, late: Duration) {
        let is_late = |due: Instant| now.saturating_duration_since(due) > late;
        // A moment before the last jump is late since that jump.
        if self.due(position).is_some_and(is_late) {
            self.jump(now, position);
        }
    }

    /// Is at another position, the end at most, and runs or stands as before.
    pub(crate) fn jump(&mut self, now: Instant, position: Duration) {
        self.at = position.min(self.length);
        self.since = now;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const S: Duration = Duration::from_secs(1);

    #[test]
    fn it_runs_stands_and_jumps_in_its_own_time() {
        let zero = Instant::now();
        let mut clock = Clock::new(zero, S * 60, 2.0, true);
        assert_eq!(clock.position(zero + S), S * 2);
        assert_eq!(clock.due(S * 10), Some(zero + S * 5));
        clock.run(zero + S, false);
        assert_eq!(clock.position(zero + S * 9), S * 2);
        assert_eq!(clock.due(S * 10), None);
        assert!(!clock.runs(zero + S * 9));
        clock.run(zero + S * 9, true);
        clock.set_speed(zero + S * 10, 0.5);
        assert_eq!(clock.position(zero + S * 12), S * 5);
        clock.jump(zero + S * 12, S * 50);
        assert_eq!(clock.position(zero + S * 14), S * 51);
        // What has gone by is due at once.
        assert_eq!(clock.due(S), Some(zero + S * 12));
    }

    #[test]
    fn it_waits_for_what_is_too_late() {
        let zero = Instant::now();
        let mut clock = Clock::new(zero, S * 60, 2.0, true);
        let late = S / 10;
        clock.hold(zero + S, S * 2 - S / 10, late);
        assert_eq!(clock.position(zero + S), S * 2, "50 ms are not too late");
        clock.hold(zero + S * 3, S * 2, late);
        assert_eq!(clock.position(zero + S * 3), S * 2);
        assert_eq!(clock.position(zero + S * 4), S * 4, "and goes on");
        clock.run(zero + S * 4, false);
        clock.hold(zero + S * 9, S, late);
        assert_eq!(
            clock.position(zero + S * 9),
            S * 4,
            "one that stands waits for nothing"
        );
    }

    #[test]
    fn it_stands_at_the_end() {
        let zero = Instant::now();
        let mut clock = Clock::new(zero, S, 1e6, true);
        assert_eq!(clock.position(zero + S * 1000), S);
        assert!(!clock.runs(zero + S));
        clock.jump(zero + S, S * 99);
        assert_eq!(clock.position(zero + S), S);
    }
}
