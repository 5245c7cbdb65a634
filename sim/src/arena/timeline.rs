//! How fast a world runs beside the clock on the wall: speed, pause, single steps.
//!
//! Owns the count of ticks that are due. Knows no world and no clock: both times come from the caller.

use lang_diagram::machine::STEP_MS;

use crate::limits;

/// A pace for a world.
#[derive(Clone, Debug)]
pub struct Timeline {
    speed: f64,
    is_paused: bool,
    /// Milliseconds of the world that no tick has covered yet.
    rest_ms: f64,
    steps: u32,
}

impl Timeline {
    /// A world that runs so many times as fast as the clock, within [`limits::MIN_SPEED`] and [`limits::MAX_SPEED`].
    pub fn new(speed: f64) -> Self {
        let mut timeline = Self {
            speed: 1.0,
            is_paused: false,
            rest_ms: 0.0,
            steps: 0,
        };
        timeline.set_speed(speed);
        timeline
    }

    /// Another speed; one that is no number changes nothing.
    pub fn set_speed(&mut self, speed: f64) {
        if speed.is_finite() {
            self.speed = speed.clamp(limits::MIN_SPEED, limits::MAX_SPEED);
        }
    }

    /// The speed.
    pub fn speed(&self) -> f64 {
        self.speed
    }

    /// Stands still, or goes on.
    pub fn pause(&mut self, is_paused: bool) {
        self.is_paused = is_paused;
    }

    /// Whether it stands still.
    pub fn is_paused(&self) -> bool {
        self.is_paused
    }

    /// One tick more although it stands still.
    pub fn step(&mut self) {
        self.steps = self.steps.saturating_add(1);
    }

    /// How many ticks are due after so many seconds by the clock. What a sleeping PC has missed is left out.
    pub fn due(&mut self, passed_s: f64) -> u32 {
        let steps = std::mem::take(&mut self.steps);
        if self.is_paused {
            return steps;
        }
        let passed_s = if passed_s.is_finite() { passed_s } else { 0.0 };
        let passed_s = passed_s.clamp(0.0, limits::MAX_CATCH_UP_S);
        self.rest_ms += passed_s * 1000.0 * self.speed;
        let ticks = (self.rest_ms / f64::from(STEP_MS)).floor();
        self.rest_ms -= ticks * f64::from(STEP_MS);
        steps.saturating_add(ticks as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_follow_the_speed_and_nothing_is_lost_between_looks() {
        let mut timeline = Timeline::new(2.0);
        let ticks: u32 = (0..100).map(|_| timeline.due(0.007)).sum();
        assert_eq!(ticks, 140);
    }

    #[test]
    fn a_pause_leaves_only_single_steps() {
        let mut timeline = Timeline::new(1.0);
        timeline.pause(true);
        timeline.step();
        timeline.step();
        assert_eq!(timeline.due(1.0), 2);
        assert_eq!(timeline.due(1.0), 0);
        timeline.pause(false);
        assert_eq!(timeline.due(0.01), 1);
    }

    #[test]
    fn speeds_and_times_that_mean_nothing_do_nothing() {
        let mut timeline = Timeline::new(f64::NAN);
        assert_eq!(timeline.speed(), 1.0);
        assert_eq!(timeline.due(f64::NAN), 0);
        assert_eq!(timeline.due(-5.0), 0);
        assert_eq!(timeline.due(1e9), 200);
        timeline.set_speed(1e300);
        assert_eq!(timeline.speed(), limits::MAX_SPEED);
    }
}
