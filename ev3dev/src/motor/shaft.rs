//! The shaft of a motor: where it is and how fast it turns by its encoder, and whether it does what it should.
//!
//! Pure, as `control` is. Owns what the steps of an encoder mean.

use super::command::POWER_MAX;
use std::collections::VecDeque;

/// Time over which the speed is measured.
const SPEED_S: f64 = 0.08;
/// No motor turns so many counts in a second; a step beyond is an encoder that was set back.
const COUNTS_PER_S_MAX: f64 = 30_000.0;
/// Power from which on a shaft ought to turn, and how long it may stand.
const STALL_POWER: f64 = 20.0;
const STALL_S: f64 = 0.5;
/// How long full power may not suffice.
const OVERLOAD_S: f64 = 0.3;
/// Share of the wanted speed that counts as reached.
const REACHED_SHARE: f64 = 0.9;
/// A shaft that has not moved for so long stands.
const STILL_S: f64 = 0.2;
/// A step of time that is longer says nothing about what happened meanwhile.
pub(super) const STEP_S_MAX: f64 = 0.1;

/// Where the shaft is, by its encoder.
#[derive(Clone, Debug, Default)]
pub(super) struct Encoder {
    /// What it showed last, and when.
    shown: Option<(f64, i32)>,
    /// In the direction of the motor, from where it is called 0.
    pub(super) position: i64,
    /// Since the regulation asked last.
    way: f64,
    pub(super) speed: Speed,
    moved_s: Option<f64>,
}

impl Encoder {
    pub(super) fn take(&mut self, now_s: f64, counts: i32, sign: i32) {
        let Some((before_s, before)) = self.shown.replace((now_s, counts)) else {
            self.speed.take(now_s, self.position);
            return;
        };
        let way = f64::from(counts.wrapping_sub(before));
        let set_back = way.abs() > COUNTS_PER_S_MAX * (now_s - before_s).max(STEP_S_MAX);
        if !set_back && way != 0.0 {
            let way = way * f64::from(sign);
            self.position += way as i64;
            self.way += way;
            self.moved_s = Some(now_s);
        }
        self.speed.take(now_s, self.position);
    }

    pub(super) fn take_way(&mut self) -> f64 {
        std::mem::take(&mut self.way)
    }

    /// What it showed last says nothing of now.
    pub(super) fn lose_sight(&mut self) {
        self.moved_s = None;
        self.speed.clear();
    }

    pub(super) fn is_moving(&self, now_s: f64) -> bool {
        self.moved_s.is_some_and(|at| now_s - at < STILL_S)
    }
}

/// The speed over the last [`SPEED_S`].
#[derive(Clone, Debug, Default)]
pub(super) struct Speed {
    places: VecDeque<(f64, i64)>,
}

impl Speed {
    pub(super) fn take(&mut self, now_s: f64, position: i64) {
        // After a pause it is unknown when it moved.
        if self
            .places
            .back()
            .is_some_and(|(at, _)| now_s - at > STEP_S_MAX)
        {
            self.places.clear();
        }
        self.places.push_back((now_s, position));
        while self.places.len() > 2
            && self
                .places
                .front()
                .is_some_and(|(at, _)| now_s - at > SPEED_S)
        {
            self.places.pop_front();
        }
    }

    pub(super) fn value(&self) -> f64 {
        match (self.places.front(), self.places.back()) {
            (Some((from_s, from)), Some((to_s, to))) if to_s - from_s > 0.005 => {
                (to - from) as f64 / (to_s - from_s)
            }
            _ => 0.0,
        }
    }

    pub(super) fn shift(&mut self, by: i64) {
        for (_, position) in &mut self.places {
            *position += by;
        }
    }

    pub(super) fn clear(&mut self) {
        self.places.clear();
    }
}

/// Whether the shaft does what it should.
#[derive(Clone, Debug, Default)]
pub(super) struct Guard {
    /// Where it began to stand still.
    anchor: i64,
    still_s: f64,
    overloaded_s: f64,
}

impl Guard {
    pub(super) fn watch(
        &mut self,
        should_turn: bool,
        position: i64,
        power: f64,
        (speed, wanted): (f64, f64),
        dt_s: f64,
    ) {
        let moved = (position - self.anchor).unsigned_abs() > 1;
        if !should_turn || power.abs() < STALL_POWER || moved {
            self.anchor = position;
            self.still_s = 0.0;
        } else {
            self.still_s += dt_s;
        }
        let lags = speed.abs() < wanted.abs() * REACHED_SHARE;
        if should_turn && power.abs() >= POWER_MAX && lags {
            self.overloaded_s += dt_s;
        } else {
            self.overloaded_s = 0.0;
        }
    }

    pub(super) fn is_stalled(&self) -> bool {
        self.still_s >= STALL_S
    }

    pub(super) fn is_overloaded(&self) -> bool {
        self.overloaded_s >= OVERLOAD_S
    }
}
