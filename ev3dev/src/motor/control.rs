//! What a motor does: commands, ramps, regulation by the encoder, state flags. Pure: times and encoder counts in, power out.
//!
//! Owns the semantics of the commands of the classes tacho-motor and dc-motor. Knows no file, no clock and no thread.
//!
//! A motor with an encoder follows a reference. The wanted speed changes within the ramps; for a move to a position it also
//! is small enough to stop there in time: v = sqrt(2 a s), a the deceleration and s the way left. While it runs freely the power is
//!   u = kf (v_ref + T a_ref) + kp (v_ref - v) - kd dv/dt + ki * integral of (v_ref - v),
//! the integral taken as the way itself, which the encoder gives without error; while it moves to a position or holds one,
//!   u = kf (v_ref + T a_ref) + kp (x_ref - x) + kd (v_ref - v) + ki * integral of (x_ref - x),
//! with v_ref = 0 when it holds, and the integral only then. Both with the anti-windup of the filter `pid` (Astrom and
//! Hagglund, Advanced PID Control, 2006).
//! A motor without an encoder follows its ramps in percent, and nothing is regulated.

use super::command::{
    Command, Flags, Gains, HOLD_GAINS, Output, POWER_MAX, SPEED_GAINS, Setpoints, StopAction,
};
use super::shaft::{Encoder, Guard, STEP_S_MAX};
use trikfs_filters::pid::Integral;

/// Power that the feedforward asks for at `max_speed`: a motor without load reaches more than that speed.
const FEEDFORWARD_POWER: f64 = 80.0;
/// Without a ramp the reference reaches `max_speed` in this time, and comes to a stop at a position as fast in twice the time.
const ACCELERATION_S: f64 = 0.125;
const DECELERATION_S: f64 = 0.25;
/// With which lag a small geared motor follows its power: the feedforward gives that much more while it speeds up.
const MOTOR_LAG_S: f64 = 0.08;
/// Counts around a position that are the position.
const TOLERANCE: f64 = 1.0;
/// How far the reference may run ahead of a motor that moves to a position.
const LAG_MAX: f64 = 90.0;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Goal {
    Coast,
    Brake,
    Hold(f64),
    /// A speed, and when it ends.
    Speed(f64, Ends),
    Position(f64),
    Direct,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Ends {
    Never,
    At(f64),
    /// At the end of the ramp.
    AtZero,
}

/// One motor.
#[derive(Clone, Debug)]
pub struct Control {
    has_encoder: bool,
    max_speed: f64,
    /// As they were written last.
    pub setpoints: Setpoints,
    /// Of the speed regulation.
    pub speed_gains: Gains,
    /// Of the position regulation.
    pub hold_gains: Gains,
    /// As the command has found them.
    active: Setpoints,
    goal: Goal,
    /// Where the relative move that was the last command is to end.
    relative_end: Option<i64>,
    encoder: Encoder,
    time_s: Option<f64>,
    reference: f64,
    reference_speed: f64,
    reference_acceleration: f64,
    speed_before: f64,
    integral: Integral,
    power: f64,
    guard: Guard,
    ramps: bool,
}

impl Control {
    /// A motor at rest. `max_speed` is in counts per second, or 100 (percent) for one without an encoder.
    pub fn new(has_encoder: bool, max_speed: i32) -> Self {
        Self {
            has_encoder,
            max_speed: f64::from(max_speed),
            setpoints: Setpoints::default(),
            speed_gains: SPEED_GAINS,
            hold_gains: HOLD_GAINS,
            active: Setpoints::default(),
            goal: Goal::Coast,
            relative_end: None,
            encoder: Encoder::default(),
            time_s: None,
            reference: 0.0,
            reference_speed: 0.0,
            reference_acceleration: 0.0,
            speed_before: 0.0,
            integral: Integral {
                min: -POWER_MAX,
                max: POWER_MAX,
                sum: 0.0,
            },
            power: 0.0,
            guard: Guard::default(),
            ramps: false,
        }
    }

    /// Takes a command at this time; [`tick`](Self::tick) has to follow.
    pub fn command(&mut self, command: Command, now_s: f64) {
        let before = self.goal;
        let relative_end = self.relative_end.take();
        if command == Command::Reset {
            self.setpoints = Setpoints::default();
            (self.speed_gains, self.hold_gains) = (SPEED_GAINS, HOLD_GAINS);
        }
        if self.setpoints.polarity != self.active.polarity {
            self.encoder.speed.clear();
            self.reference_speed = -self.reference_speed;
        }
        self.active = self.setpoints;
        let speed = if self.has_encoder {
            self.active.speed
        } else {
            self.active.duty_cycle
        };
        let speed = f64::from(speed);
        match command {
            Command::RunForever => self.begin(before, Goal::Speed(speed, Ends::Never)),
            Command::RunTimed => {
                let end = now_s + f64::from(self.active.time) / 1000.0;
                self.begin(before, Goal::Speed(speed, Ends::At(end)));
            }
            Command::RunToAbsPos => {
                // On the round of 32 bits on which it is now.
                let round = self.encoder.position - i64::from(self.position());
                let end = round + i64::from(self.active.position);
                self.begin(before, Goal::Position(end as f64));
            }
            Command::RunToRelPos => {
                let from = relative_end.unwrap_or(self.encoder.position);
                let end = from + i64::from(self.active.position);
                self.relative_end = Some(end);
                self.begin(before, Goal::Position(end as f64));
            }
            Command::RunDirect => self.begin(before, Goal::Direct),
            Command::Stop => self.begin_to_stop(),
            Command::Reset => {
                self.goal = Goal::Coast;
                self.set_position(0);
            }
        }
    }

    /// Lets it run out, whatever it did, because it cannot be driven: whether it still turns is unknown.
    pub fn let_go(&mut self) {
        self.encoder.lose_sight();
        self.goal = Goal::Coast;
        self.relative_end = None;
        self.settle();
    }

    /// Takes what the encoder shows at this time.
    pub fn observe(&mut self, now_s: f64, counts: i32) {
        self.encoder
            .take(now_s, counts, self.active.polarity.sign());
    }

    /// The power for the time since the last tick; `counts` is what the encoder shows now.
    pub fn tick(&mut self, now_s: f64, counts: Option<i32>) -> Output {
        if let Some(counts) = counts {
            self.observe(now_s, counts);
        }
        let before = self.time_s.replace(now_s).unwrap_or(now_s);
        let dt_s = (now_s - before).clamp(0.0, STEP_S_MAX);
        self.advance_goal(now_s);
        self.ramps = false;
        self.reference_acceleration = 0.0;
        self.power = match self.goal {
            Goal::Coast | Goal::Brake => 0.0,
            Goal::Direct => f64::from(self.setpoints.duty_cycle),
            Goal::Speed(speed, _) => self.follow_speed(speed, dt_s),
            Goal::Position(target) => self.follow_position(target, dt_s),
            Goal::Hold(target) => {
                (self.reference, self.reference_speed) = (target, 0.0);
                self.hold_power(dt_s)
            }
        };
        let should_turn = match self.goal {
            Goal::Coast | Goal::Brake | Goal::Hold(_) => false,
            Goal::Direct => self.has_encoder,
            Goal::Speed(..) | Goal::Position(_) => self.has_encoder,
        };
        let (position, speed) = (self.encoder.position, self.encoder.speed.value());
        self.guard.watch(
            should_turn,
            position,
            self.power,
            (speed, self.reference_speed),
            dt_s,
        );
        self.speed_before = speed;
        self.output()
    }

    /// What the motor is to get, as the last tick has found.
    pub fn output(&self) -> Output {
        match self.goal {
            Goal::Brake => Output::Brake,
            Goal::Coast => Output::Power(0),
            Goal::Hold(_) | Goal::Speed(..) | Goal::Position(_) | Goal::Direct => {
                Output::Power(self.duty_cycle() * self.active.polarity.sign())
            }
        }
    }

    /// Counts since position 0. Beyond 32 bits it goes on at the other end.
    pub fn position(&self) -> i32 {
        self.encoder.position as i32
    }

    /// Calls this place so.
    pub fn set_position(&mut self, position: i32) {
        let shift = i64::from(position) - self.encoder.position;
        self.encoder.position += shift;
        self.encoder.speed.shift(shift);
        self.relative_end = None;
        self.reference += shift as f64;
        if let Goal::Hold(target) = &mut self.goal {
            *target += shift as f64;
        }
    }

    /// Counts per second.
    pub fn speed(&self) -> i32 {
        self.encoder.speed.value().round() as i32
    }

    /// Percent that it gets now, in its own direction.
    pub fn duty_cycle(&self) -> i32 {
        self.power.round() as i32
    }

    /// Flags of `state`.
    pub fn flags(&self) -> Flags {
        let running = match self.goal {
            Goal::Speed(..) | Goal::Position(_) | Goal::Direct => true,
            Goal::Coast | Goal::Brake | Goal::Hold(_) => false,
        };
        Flags {
            running,
            ramping: running && self.ramps,
            holding: matches!(self.goal, Goal::Hold(_)),
            overloaded: running && self.guard.is_overloaded(),
            stalled: running && self.guard.is_stalled(),
        }
    }

    /// True if the motor has been let go: nothing has to be done for it.
    pub fn is_let_go(&self) -> bool {
        self.goal == Goal::Coast
    }

    /// True if ticks have to go on: it runs or is held, or it still runs out.
    pub fn is_busy(&self, now_s: f64) -> bool {
        match self.goal {
            Goal::Coast | Goal::Brake => self.has_encoder && self.encoder.is_moving(now_s),
            Goal::Hold(_) | Goal::Speed(..) | Goal::Position(_) | Goal::Direct => true,
        }
    }

    /// When the goal ends by the clock.
    pub fn ends_at_s(&self) -> Option<f64> {
        match self.goal {
            Goal::Speed(_, Ends::At(at)) => Some(at),
            Goal::Speed(_, Ends::Never | Ends::AtZero)
            | Goal::Coast
            | Goal::Brake
            | Goal::Hold(_)
            | Goal::Position(_)
            | Goal::Direct => None,
        }
    }

    fn begin(&mut self, before: Goal, goal: Goal) {
        let position = self.encoder.position as f64;
        let regulates_position = |goal| matches!(goal, Goal::Position(_) | Goal::Hold(_));
        let goes_on = matches!((before, goal), (Goal::Speed(..), Goal::Speed(..)))
            || regulates_position(before) && regulates_position(goal);
        if !goes_on {
            self.integral.sum = 0.0;
            self.reference = position;
        }
        match before {
            Goal::Speed(..) | Goal::Position(_) => {}
            Goal::Coast | Goal::Brake | Goal::Hold(_) | Goal::Direct => {
                self.reference_speed = self.encoder.speed.value()
            }
        }
        self.guard = Guard::default();
        self.goal = goal;
    }

    fn begin_to_stop(&mut self) {
        let turns = matches!(self.goal, Goal::Speed(..) | Goal::Position(_));
        if turns && self.active.ramp_down > 0 && self.reference_speed != 0.0 {
            let before = self.goal;
            self.begin(before, Goal::Speed(0.0, Ends::AtZero));
        } else {
            self.stop(self.encoder.position);
        }
    }

    /// The stop action; `at` is beyond 32 bits where the shaft is.
    fn stop(&mut self, at: i64) {
        self.goal = match self.active.stop_action {
            StopAction::Coast => Goal::Coast,
            StopAction::Brake => Goal::Brake,
            StopAction::Hold if self.has_encoder => Goal::Hold(at as f64),
            StopAction::Hold => Goal::Brake,
        };
        self.settle();
    }

    /// Regulation starts over.
    fn settle(&mut self) {
        self.integral.sum = 0.0;
        self.reference_speed = 0.0;
        self.guard = Guard::default();
    }

    /// Ends what has reached its end.
    fn advance_goal(&mut self, now_s: f64) {
        match self.goal {
            Goal::Speed(_, Ends::At(end)) if now_s >= end => self.begin_to_stop(),
            Goal::Speed(_, Ends::AtZero) if self.reference_speed == 0.0 => {
                self.stop(self.encoder.position);
            }
            Goal::Position(target) => {
                let is_there = self.reference == target
                    && (self.encoder.position as f64 - target).abs() <= TOLERANCE;
                if is_there {
                    let sum = self.integral.sum;
                    self.stop(target as i64);
                    // What holds it against a load is known already.
                    self.integral.sum = sum;
                }
            }
            Goal::Speed(_, Ends::Never | Ends::At(_) | Ends::AtZero)
            | Goal::Coast
            | Goal::Brake
            | Goal::Hold(_)
            | Goal::Direct => {}
        }
    }

    fn follow_speed(&mut self, wanted: f64, dt_s: f64) -> f64 {
        self.ramp_towards(wanted, dt_s);
        let reference = self.reference_speed;
        if !self.has_encoder {
            return reference;
        }
        let gain = |gain: i32| f64::from(gain) / 1000.0;
        let gains = self.speed_gains;
        let speed = self.encoder.speed.value();
        let acceleration = if dt_s > 0.0 {
            (speed - self.speed_before) / dt_s
        } else {
            0.0
        };
        let others = self.feedforward() + gain(gains.kp) * (reference - speed)
            - gain(gains.kd) * acceleration;
        let step = gain(gains.ki) * (reference * dt_s - self.encoder.take_way());
        self.integral.output(others, step)
    }

    fn follow_position(&mut self, target: f64, dt_s: f64) -> f64 {
        let left = target - self.reference;
        let lag = self.reference - self.encoder.position as f64;
        let is_ahead = lag.abs() > LAG_MAX && lag.signum() == left.signum();
        if !is_ahead {
            let deceleration = self.max_speed / ramp_s(self.active.ramp_down, DECELERATION_S);
            let in_time = (2.0 * deceleration * left.abs()).sqrt();
            let wanted = f64::from(self.active.speed).abs().min(in_time);
            self.ramp_towards(wanted.copysign(left), dt_s);
            // What is less than the way of a step is a step.
            let step = self.reference_speed * dt_s;
            if step.abs() >= left.abs() || left.abs() < 0.5 {
                (self.reference, self.reference_speed) = (target, 0.0);
            } else {
                self.reference += step;
            }
        }
        self.hold_power(dt_s)
    }

    /// The power towards the reference.
    fn hold_power(&mut self, dt_s: f64) -> f64 {
        let gain = |gain: i32| f64::from(gain) / 1000.0;
        let gains = self.hold_gains;
        let mut error = self.reference - self.encoder.position as f64;
        // A count is as good as it gets, and power for it would only swing it to and fro.
        if self.reference_speed == 0.0 && error.abs() <= TOLERANCE {
            error = 0.0;
        }
        let slip = self.reference_speed - self.encoder.speed.value();
        let others = self.feedforward() + gain(gains.kp) * error + gain(gains.kd) * slip;
        self.encoder.take_way();
        // On the way the error is the lag of the shaft, which would be too much power at the end.
        let step = if self.reference_speed == 0.0 {
            gain(gains.ki) * error * dt_s
        } else {
            0.0
        };
        self.integral.output(others, step)
    }

    fn feedforward(&self) -> f64 {
        let speed = self.reference_speed + MOTOR_LAG_S * self.reference_acceleration;
        FEEDFORWARD_POWER / self.max_speed * speed
    }

    /// Changes the reference of the speed as fast as it may.
    fn ramp_towards(&mut self, wanted: f64, dt_s: f64) {
        let now = self.reference_speed;
        // Through 0 it is a way down and then a way up.
        let (next, speeds_up) = if now * wanted < 0.0 {
            (0.0, false)
        } else {
            (wanted, wanted.abs() > now.abs())
        };
        let (ramp, usual) = match (speeds_up, self.has_encoder) {
            (true, true) => (self.active.ramp_up, ACCELERATION_S),
            (true, false) => (self.active.ramp_up, 0.0),
            (false, true) => (self.active.ramp_down, ACCELERATION_S),
            (false, false) => (self.active.ramp_down, 0.0),
        };
        let span_s = ramp_s(ramp, usual);
        let step = if span_s > 0.0 {
            self.max_speed / span_s * dt_s
        } else {
            f64::INFINITY
        };
        self.reference_speed = if (next - now).abs() <= step {
            next
        } else {
            now + step.copysign(next - now)
        };
        if dt_s > 0.0 {
            self.reference_acceleration = (self.reference_speed - now) / dt_s;
        }
        self.ramps |= ramp > 0 && self.reference_speed != wanted;
    }
}

/// The length of a ramp, or the usual one if none was asked for.
fn ramp_s(ramp_ms: i32, usual_s: f64) -> f64 {
    if ramp_ms > 0 {
        f64::from(ramp_ms) / 1000.0
    } else {
        usual_s
    }
}

#[cfg(test)]
mod tests;
