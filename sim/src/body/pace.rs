//! How fast the room of a shipped robot runs beside the clock of its board: speed, pause, steps.
//!
//! Owns the time that is due in steps of the board. Worlds of TRIK Studio have [`crate::arena::Timeline`] instead, which
//! counts their ticks.

use crate::limits::{PACE_STEPS, STEP_S};

/// A pace.
#[derive(Debug, Clone, Copy)]
pub struct Pace {
    /// How many times as fast as the clock.
    pub speed: f64,
    /// Whether only ordered steps are done.
    pub is_paused: bool,
    /// What no step has covered yet.
    rest_s: f64,
    ordered_s: f64,
}

impl Default for Pace {
    fn default() -> Self {
        Self {
            speed: 1.0,
            is_paused: false,
            rest_s: 0.0,
            ordered_s: 0.0,
        }
    }
}

impl Pace {
    /// So many seconds are done although time stands still.
    pub fn order(&mut self, seconds: f64) {
        self.is_paused = true;
        self.ordered_s += seconds;
    }

    /// How many steps are due after a step of the board, and how long each of them is. Much that was ordered is spread over
    /// several steps of the board.
    pub fn due(&mut self, dt_s: f64) -> (u32, f64) {
        if !self.is_paused && self.speed == 1.0 && self.rest_s == 0.0 && self.ordered_s == 0.0 {
            return (1, dt_s);
        }
        let passed_s = if self.is_paused {
            0.0
        } else {
            dt_s * self.speed
        };
        let most_s = f64::from(PACE_STEPS) * STEP_S;
        let ordered_s = self.ordered_s.min(most_s);
        self.ordered_s -= ordered_s;
        self.rest_s += passed_s + ordered_s;
        // A little more, so that the sum of a thousand thousandths is one.
        let steps = ((self.rest_s / STEP_S + 1e-6).floor()).max(0.0);
        self.rest_s = (self.rest_s - steps * STEP_S).max(0.0);
        (steps as u32, STEP_S)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps(pace: &mut Pace, count: u32) -> f64 {
        (0..count)
            .map(|_| pace.due(0.001))
            .map(|(count, dt_s)| f64::from(count) * dt_s)
            .sum()
    }

    #[test]
    fn a_usual_pace_changes_nothing() {
        assert_eq!(Pace::default().due(0.0004), (1, 0.0004));
    }

    #[test]
    fn speed_pause_and_steps_are_what_they_say() {
        let mut pace = Pace {
            speed: 0.25,
            ..Pace::default()
        };
        assert!((steps(&mut pace, 1000) - 0.25).abs() < 0.0011);
        pace.speed = 20.0;
        assert!((steps(&mut pace, 100) - 2.0).abs() < 0.0011);
        pace.is_paused = true;
        assert_eq!(steps(&mut pace, 1000), 0.0);
        pace.order(10.0);
        let (count, _) = pace.due(0.001);
        assert!(count <= PACE_STEPS + 1, "{count} at once");
        let rest = steps(&mut pace, 1000);
        assert!(
            (rest + f64::from(count) * STEP_S - 10.0).abs() < 0.0011,
            "{rest}"
        );
        assert_eq!(steps(&mut pace, 1000), 0.0);
    }
}
