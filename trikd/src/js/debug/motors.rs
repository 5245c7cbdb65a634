//! Motors of a program in JavaScript while it is stopped: they rest, and come back as they were.
//!
//! Owns what they were told.

use crate::brick::{Brick, Group};

/// Motors that rest for a stop.
#[derive(Debug, Default)]
pub(super) struct Resting(Vec<(String, f64)>);

/// Whether it moves, or holds something: a servo that is off has no position.
fn told(brick: &Brick, port: &str) -> Option<f64> {
    let motor = brick.motor(port)?;
    let power = motor.power().ok()?;
    (power != 0.0 || motor.is_servo()).then_some(power)
}

impl Resting {
    /// Brings to rest what moves; again and again, as long as threads may still tell motors something.
    pub fn hold(&mut self, brick: &Brick) {
        let ports = [Group::Motors, Group::Servos].map(|group| brick.ports(group));
        for port in ports.into_iter().flatten() {
            let Some(power) = told(brick, &port) else {
                continue;
            };
            let off = brick.motor(&port).map(|motor| motor.power_off());
            // One that has failed is at rest.
            if off.is_some_and(|done| done.is_ok()) {
                self.0.retain(|(other, _)| *other != port);
                self.0.push((port, power));
            }
        }
    }

    /// They do again what they did, but for those that were told something in between.
    pub fn go_on(&mut self, brick: &Brick) {
        for (port, power) in self.0.drain(..) {
            let Some(motor) = brick.motor(&port) else {
                continue;
            };
            let is_off = motor.is_servo() || motor.power().is_ok_and(|now| now == 0.0);
            if is_off {
                // It says so itself when the program uses it.
                let _ = motor.set_power(power);
            }
        }
    }
}
