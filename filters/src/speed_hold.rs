//! Speed hold: the power of a motor such that its encoder turns at the wanted speed, whatever the battery and the load.
//!
//! A PI controller with feedforward (Astrom and Hagglund, Advanced PID Control, 2006, section 3.5 for the anti-windup):
//!   u = kf s + kp (s - v) + ki * integral of (s - v), between -max and max,
//! where s is the wanted speed and v the measured one through a low pass of `speed_ms`. The integral of the speed is the way
//! itself, so the integral part is ki (sum of s T - way): exact, free of the steps of a differentiated encoder, and the
//! reason why the same speed comes out of a full and of an empty battery.
//! The wanted speed 0 lets go: power 0, and everything but the encoder is forgotten.
//! Stall guard: when the power is at its limit and the encoder has not moved by more than one count for `stall_ms`, the power
//! becomes 0 and stays 0 until the wanted speed has been 0. It is no fault, because a fault would leave the power as it was.
//! A step of the encoder that is faster than `speed_max` is a counter that was set back and says nothing about the speed.
//! In f64, so that Lua gives the same bits. Cost: about 25 operations, two of them divisions.

use crate::clock::Elapsed;
use crate::fused::{Fusion, Layout};
use crate::lanes::overflow;
use crate::limits::{PERIOD_MS_MAX, REAL_MAX};
use crate::number::Number;
use crate::params::Params;
use crate::pid::Integral;
use converter::{Conversion, Fault, OpenInfo};
use std::ffi::CStr;

/// `kp` in percent for each count per second when the configuration does not say.
pub const KP: f64 = 0.05;
/// `ki` in percent for each count when the configuration does not say.
pub const KI: f64 = 0.5;
/// Greatest power.
pub const MAX: f64 = 100.0;
/// Time constant of the measured speed when the configuration does not say.
pub const SPEED_MS: f64 = 50.0;
/// How long a motor may stand still at full power when the configuration does not say.
pub const STALL_MS: f64 = 1000.0;
/// Counts per second that no motor reaches when the configuration does not say.
pub const SPEED_MAX: f64 = 10_000.0;
/// Counts that an encoder may waver without moving.
const STILL_COUNTS: i32 = 1;

/// A speed hold.
#[derive(Clone, Copy, Debug)]
pub struct SpeedHold {
    kf: f64,
    kp: f64,
    integral_gain: f64,
    integral: Integral,
    speed_s: f64,
    /// 0 for no guard.
    stall_s: f64,
    speed_max: f64,
    /// Counts of the tuple before, absent before the first.
    position: Option<i32>,
    speed: f64,
    stall: Stall,
}

/// What the stall guard knows.
#[derive(Clone, Copy, Debug, Default)]
struct Stall {
    /// Where the encoder stood when it began to stand still.
    anchor: i32,
    /// How long it has stood still at full power.
    still_s: f64,
    /// True from a stall until the wanted speed is 0.
    has_tripped: bool,
}

impl Stall {
    /// Takes where the encoder is and whether the power before was at its limit; `seconds` since.
    fn watch(&mut self, position: i32, at_limit: bool, seconds: f64, stall_s: f64) {
        let way = position.wrapping_sub(self.anchor);
        if !at_limit || way.unsigned_abs() > STILL_COUNTS.unsigned_abs() {
            self.anchor = position;
            self.still_s = 0.0;
            return;
        }
        self.still_s += seconds;
        self.has_tripped |= stall_s > 0.0 && self.still_s >= stall_s;
    }
}

impl SpeedHold {
    /// The power for the wanted speed, `seconds` after the tuple before, in which the encoder went `way` counts.
    fn control(&mut self, wanted: f64, way: f64, seconds: f64) -> f64 {
        if seconds > 0.0 && way.abs() <= self.speed_max * seconds {
            let weight = seconds / (self.speed_s + seconds);
            self.speed += (way / seconds - self.speed) * weight;
        } else {
            // The first tuple, or a counter that was set back: no error of the way is known.
            return self
                .integral
                .output(self.kf * wanted + self.kp * (wanted - self.speed), 0.0);
        }
        let others = self.kf * wanted + self.kp * (wanted - self.speed);
        let step = self.integral_gain * (wanted * seconds - way);
        self.integral.output(others, step)
    }
}

impl Fusion for SpeedHold {
    type Input = i32;
    type Output = i32;
    const LAYOUT: Layout = Layout {
        name: "speed_hold",
        inputs: &[2],
        outputs: &[1, 2, 3],
        is_timed: true,
    };
    const DESCRIPTION: &'static CStr =
        c"PI control of a motor's speed by its encoder, with anti-windup and stall guard";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let params = Params::new(Self::LAYOUT.name, info);
        let gain = |name, default| params.real(name, default, 0.0..=REAL_MAX);
        let time = |name, default| {
            Ok::<_, Fault>(params.real(name, default, 0.0..=PERIOD_MS_MAX)? / 1000.0)
        };
        let (kf, kp, integral_gain) = (gain("kf", 0.0)?, gain("kp", KP)?, gain("ki", KI)?);
        let max = params.real("max", MAX, 0.0..=REAL_MAX)?;
        Ok(Self {
            kf,
            kp,
            integral_gain,
            integral: Integral {
                min: -max,
                max,
                sum: 0.0,
            },
            speed_s: time("speed_ms", SPEED_MS)?,
            stall_s: time("stall_ms", STALL_MS)?,
            speed_max: params.real("speed_max", SPEED_MAX, 1.0..=REAL_MAX)?,
            position: None,
            speed: 0.0,
            stall: Stall::default(),
        })
    }

    fn step(
        &mut self,
        values: &[i32],
        elapsed: Elapsed,
        results: &mut [i32],
    ) -> Result<Conversion, Fault> {
        let (wanted, position) = (values[0], values[1]);
        let seconds = elapsed.seconds().unwrap_or(0.0);
        let way = self
            .position
            .replace(position)
            .map_or(0, |before| position.wrapping_sub(before));
        let mut power = self.control(f64::from(wanted), f64::from(way), seconds);
        if wanted == 0 {
            self.integral.sum = 0.0;
            self.stall = Stall {
                anchor: position,
                ..Stall::default()
            };
            power = 0.0;
        } else {
            let at_limit = power.abs() >= self.integral.max;
            self.stall.watch(position, at_limit, seconds, self.stall_s);
        }
        if self.stall.has_tripped {
            self.integral.sum = 0.0;
            power = 0.0;
        }
        let real = [
            power,
            self.speed,
            f64::from(u8::from(self.stall.has_tripped)),
        ];
        for (result, real) in results.iter_mut().zip(real) {
            *result = i32::from_real(real).ok_or_else(overflow)?;
        }
        Ok(Conversion::Produced)
    }

    fn reset(&mut self) {
        self.integral.sum = 0.0;
        self.position = None;
        self.speed = 0.0;
        self.stall = Stall::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fused::tests::{open, step};

    /// A motor: at 100 percent and 12 V it reaches 1000 degrees per second, with a time constant of 100 ms.
    struct Motor {
        speed: f64,
        angle: f64,
    }

    impl Motor {
        fn run(&mut self, power: i32, volts: f64, load: f64) -> i32 {
            // In steps of a millisecond for one period of 10 ms.
            for _ in 0..10 {
                let target = f64::from(power) * 10.0 * volts / 12.0 - load;
                self.speed += (target - self.speed) * 0.01;
                self.angle += self.speed * 0.001;
            }
            self.angle as i32
        }
    }

    const PARAMS: [(&str, f64); 1] = [("period_ms", 10.0)];

    #[test]
    fn the_parts_add_up() {
        // By hand, T = 100 ms, speed_ms 0, kf 0.1, kp 0.2, ki 1: first tuple: 10 + 20 = 30. 4 degrees later v = 40:
        // 10 + 0.2 * 60 + (100 * 0.1 - 4) = 28. 10 degrees later: v = 100: 10 + 0 + 6 = 16.
        let params = [
            ("period_ms", 100.0),
            ("speed_ms", 0.0),
            ("kf", 0.1),
            ("kp", 0.2),
            ("ki", 1.0),
        ];
        let mut hold = open::<SpeedHold>((2, 3), &params).unwrap();
        assert_eq!(step(&mut hold, &[100, 7], None), Ok([30, 0, 0]));
        assert_eq!(step(&mut hold, &[100, 11], None), Ok([28, 40, 0]));
        assert_eq!(step(&mut hold, &[100, 21], None), Ok([16, 100, 0]));
        // 0 lets go at once.
        assert_eq!(step(&mut hold, &[0, 31], None), Ok([0, 100, 0]));
        assert_eq!(step(&mut hold, &[100, 41], None), Ok([10, 100, 0]));
    }

    #[test]
    fn the_speed_stays_while_the_battery_sags_and_a_load_comes() {
        for wanted in [300, -450] {
            let mut hold = open::<SpeedHold>((2, 1), &PARAMS).unwrap();
            let mut motor = Motor {
                speed: 0.0,
                angle: 0.0,
            };
            let mut encoder = 0;
            for n in 0..1500 {
                let volts = 12.4 - 4.0 * f64::from(n) / 1500.0;
                let load = if n > 700 { 100.0 } else { 0.0 };
                let [power] = step(&mut hold, &[wanted, encoder], None).unwrap();
                let before = motor.angle;
                encoder = motor.run(power, volts, load);
                let settling = n < 100 || (700..850).contains(&n);
                let speed = (motor.angle - before) / 0.01;
                assert!(
                    settling || (speed - f64::from(wanted)).abs() < 15.0,
                    "{n}: {speed}"
                );
            }
        }
    }

    #[test]
    fn a_motor_that_is_held_is_let_go_until_the_wanted_speed_was_zero() {
        let mut hold = open::<SpeedHold>((2, 3), &PARAMS).unwrap();
        let mut full = 0;
        let mut results = [0; 3];
        for n in 0..1000 {
            // The encoder wavers by a count, as at an edge of its disc.
            results = step(&mut hold, &[500, n % 2], None).unwrap();
            full += i32::from(results[0] == 100);
        }
        // After 1 s at full power, and not much later.
        assert!((100..=101).contains(&full), "{full}");
        assert_eq!((results[0], results[2]), (0, 1));
        let [power, _, stalled] = step(&mut hold, &[-500, 0], None).unwrap();
        assert_eq!((power, stalled), (0, 1), "another speed is no release");
        assert!(step::<_, 3>(&mut hold, &[0, 0], None).unwrap()[2] == 0);
        assert!(step::<_, 3>(&mut hold, &[500, 0], None).unwrap()[0] > 0);
    }

    #[test]
    fn a_motor_that_moves_slowly_at_full_power_is_not_stalled() {
        let mut hold = open::<SpeedHold>((2, 3), &PARAMS).unwrap();
        for n in 0..1000 {
            let [_, _, stalled] = step(&mut hold, &[500, n / 10], None).unwrap();
            assert_eq!(stalled, 0);
        }
    }

    #[test]
    fn a_counter_that_is_set_back_does_not_throw_the_power() {
        let mut hold = open::<SpeedHold>((2, 2), &PARAMS).unwrap();
        let mut position = 100_000;
        let mut before = 0;
        for n in 0..400 {
            position = if n == 300 { 0 } else { position + 3 };
            let [power, _] = step(&mut hold, &[300, position], None).unwrap();
            if n >= 299 {
                assert!((power - before).abs() <= 1, "{n}: {before} {power}");
            }
            before = power;
        }
        // The counter of 32 bits wraps around.
        let mut hold = open::<SpeedHold>((2, 2), &PARAMS).unwrap();
        let mut speeds = (0..100).map(|n| {
            let position = (i32::MAX - 150).wrapping_add(3 * n);
            step::<_, 2>(&mut hold, &[300, position], None).unwrap()[1]
        });
        assert!(speeds.all(|speed| (0..=300).contains(&speed)));
    }

    #[test]
    fn extremes_stay_within_the_limits() {
        let params = [
            ("period_ms", 1.0),
            ("kp", REAL_MAX),
            ("ki", REAL_MAX),
            ("kf", REAL_MAX),
            ("speed_max", REAL_MAX),
        ];
        let mut hold = open::<SpeedHold>((2, 1), &params).unwrap();
        for values in [
            [i32::MAX, i32::MIN],
            [i32::MIN, i32::MAX],
            [i32::MAX, 0],
            [1, 1],
        ] {
            let [power] = step(&mut hold, &values, None).unwrap();
            assert!(power.abs() <= 100, "{power}");
        }
        let refused = open::<SpeedHold>((2, 4), &PARAMS).err().unwrap();
        assert_eq!(
            refused.text(),
            "speed_hold: tuples of 8 to 16 bytes; it takes 8, 4 more with a time_us, and gives 4 or 8 or 12"
        );
    }
}
