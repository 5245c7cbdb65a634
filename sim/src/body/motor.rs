//! A power motor with its gear and encoder: duty to speed, with a first-order lag.
//!
//! The duty-speed curve is that of TRIK's `motor100`, so that the linearisation of a configuration makes it straight.

use super::Power;

/// Duty in percent and speed as measured by the makers of the controller; 2650 is full speed.
const CURVE: [(f64, f64); 5] = [
    (0.0, 0.0),
    (5.0, 30.0),
    (20.0, 1700.0),
    (40.0, 2335.0),
    (100.0, 2650.0),
];
/// Turns per minute at full duty and nominal voltage.
const FULL_SPEED_RPM: f64 = 200.0;
/// Of the battery for which [`FULL_SPEED_RPM`] holds.
const NOMINAL_V: f64 = 12.0;
/// How fast the shaft follows while it is driven, while it coasts and while it is braked.
const DRIVEN_S: f64 = 0.08;
const COASTING_S: f64 = 0.2;
const BRAKED_S: f64 = 0.02;
/// Without load, and when full power meets a shaft that stands.
const IDLE_A: f64 = 0.1;
const STALL_A: f64 = 2.0;

/// Where the shaft is and how fast it turns.
#[derive(Debug, Clone, Copy, Default)]
pub struct Motor {
    /// Of the shaft, positive is forward.
    pub speed_dps: f64,
    /// Since the start.
    pub angle_deg: f64,
}

/// Full speed at nominal voltage.
pub const FULL_SPEED_DPS: f64 = FULL_SPEED_RPM * 6.0;

impl Motor {
    /// Turns for `dt_s`; gives the current that it took.
    pub fn step(&mut self, dt_s: f64, power: Power, battery_v: f64) -> f64 {
        let (target, lag_s) = match power {
            Power::Duty(duty) if duty != 0.0 => (
                speed_share(duty) * FULL_SPEED_DPS * battery_v / NOMINAL_V,
                DRIVEN_S,
            ),
            Power::Duty(_) | Power::Open => (0.0, COASTING_S),
            Power::Brake => (0.0, BRAKED_S),
            Power::Blocked => {
                self.speed_dps = 0.0;
                return 0.0;
            }
        };
        let before = self.speed_dps;
        // The exact solution of a first-order lag, so that the length of a step does not matter.
        let left = libm::exp(-dt_s / lag_s);
        self.speed_dps = target + (before - target) * left;
        self.angle_deg += target * dt_s + (before - target) * lag_s * (1.0 - left);
        match power {
            Power::Duty(duty) if duty != 0.0 => {
                let slip = (target - self.speed_dps).abs() / FULL_SPEED_DPS;
                IDLE_A * duty.abs() / 100.0 + STALL_A * slip
            }
            Power::Duty(_) | Power::Brake | Power::Open | Power::Blocked => 0.0,
        }
    }
}

/// Speed as a share of full speed, for a duty in percent.
pub fn speed_share(duty: f64) -> f64 {
    let size = duty.abs().min(100.0);
    let full = CURVE[CURVE.len() - 1].1;
    let mut share = 0.0;
    for pair in CURVE.windows(2) {
        let ((low, slow), (high, fast)) = (pair[0], pair[1]);
        if size >= low {
            share = (slow + (fast - slow) * (size.min(high) - low) / (high - low)) / full;
        }
    }
    share.copysign(duty)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Duty 16 is what the linearisation sends for 50 percent: (30 + 1670 * 11/15) / 2650 = 0.4734.
    #[test]
    fn the_curve_is_that_of_motor100() {
        assert!((speed_share(16.0) - 0.473_459).abs() < 1e-6);
        assert_eq!(speed_share(100.0), 1.0);
        assert_eq!(speed_share(-100.0), -1.0);
        assert_eq!(speed_share(0.0), 0.0);
        assert!((speed_share(5.0) - 30.0 / 2650.0).abs() < 1e-12);
    }

    #[test]
    fn after_one_lag_63_percent_of_the_speed_are_reached() {
        let mut motor = Motor::default();
        for _ in 0..80 {
            motor.step(0.001, Power::Duty(100.0), 12.0);
        }
        let share = motor.speed_dps / FULL_SPEED_DPS;
        assert!((share - 0.632_12).abs() < 1e-4, "{share}");
        for _ in 0..2000 {
            motor.step(0.001, Power::Duty(100.0), 6.0);
        }
        assert!(
            (motor.speed_dps - 600.0).abs() < 0.1,
            "half the voltage is half the speed"
        );
    }

    #[test]
    fn a_brake_stops_sooner_than_coasting_and_a_blocked_shaft_stands() {
        let run = |power| {
            let mut motor = Motor {
                speed_dps: 1000.0,
                angle_deg: 0.0,
            };
            for _ in 0..50 {
                motor.step(0.001, power, 12.0);
            }
            motor
        };
        assert!(run(Power::Brake).speed_dps < 100.0);
        assert!(run(Power::Duty(0.0)).speed_dps > 700.0);
        assert_eq!(run(Power::Blocked).angle_deg, 0.0);
    }
}
