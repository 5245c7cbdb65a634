//! Bounds how often the serving thread wakes up: each turn costs the same, however little there is to do.
//!
//! Owns the count of turns and the pause before the next one. Many clients that ask one after the other are served
//! together once a millisecond, which takes less of the processor; few are served at once.

use crate::limits;
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Turns of one thread.
#[derive(Debug)]
pub struct Pace(Mutex<Window>);

#[derive(Debug)]
struct Window {
    since: Instant,
    turns: u32,
    pauses: bool,
}

impl Default for Pace {
    fn default() -> Self {
        Self(Mutex::new(Window {
            since: Instant::now(),
            turns: 0,
            pauses: false,
        }))
    }
}

impl Window {
    /// Counts a turn; whether to pause before the next.
    fn turn(&mut self, now: Instant) -> bool {
        self.turns = self.turns.saturating_add(1);
        let passed = now.saturating_duration_since(self.since);
        if passed >= Duration::from_millis(limits::PACE_WINDOW_MS) {
            let passed_ms = u32::try_from(passed.as_millis()).unwrap_or(u32::MAX).max(1);
            let per_second = self.turns.saturating_mul(1000) / passed_ms;
            // With pauses there are fewer turns for the same work.
            self.pauses = per_second
                > if self.pauses {
                    limits::PACE_FEW
                } else {
                    limits::PACE_MANY
                };
            (self.since, self.turns) = (now, 0);
        }
        self.pauses
    }
}

impl Pace {
    /// The end of a turn: nothing is left to do. Sleeps a moment if there are too many of them.
    pub fn rest(&self) {
        let mut window = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let pauses = window.turn(Instant::now());
        drop(window);
        if pauses {
            std::thread::sleep(Duration::from_micros(limits::PACE_PAUSE_US));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_many_turns_bring_pauses_and_only_few_end_them() {
        let start = Instant::now();
        let mut window = Window {
            since: start,
            turns: 0,
            pauses: false,
        };
        let mut at = start;
        let mut second = |per_second: u32| {
            let mut pauses = false;
            for _ in 0..per_second {
                at += Duration::from_secs(1) / per_second;
                pauses = window.turn(at);
            }
            pauses
        };
        assert!(!second(limits::PACE_MANY - 500));
        assert!(second(limits::PACE_MANY + 500));
        assert!(second(limits::PACE_FEW + 100));
        assert!(!second(limits::PACE_FEW - 100));
        assert!(!second(limits::PACE_FEW + 100));
    }
}
