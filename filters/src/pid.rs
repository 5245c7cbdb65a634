//! PID controller: u = kp e + ki * integral of e + kd * derivative of -x, with e = setpoint - x, kept between min and max.
//!
//! The textbook form (Astrom and Hagglund, Advanced PID Control, 2006, chapter 3) with what practice needs:
//! - the derivative is that of the measured value, so that a new setpoint gives no kick, through a low pass of `filter_ms`;
//! - anti-windup: the integral does not grow while u is at a limit and would be driven further, and stays within the limits.
//!
//! The first tuple has no time before it: u = kp e.
//! In f64, so that Lua gives the same bits. Cost: about 20 operations, two of them divisions.

use crate::clock::Elapsed;
use crate::fused::{Fusion, Layout};
use crate::lanes::overflow;
use crate::limits::{PERIOD_MS_MAX, REAL_MAX};
use crate::number::Number;
use crate::params::Params;
use converter::{Conversion, Fault, OpenInfo};
use std::ffi::CStr;
use std::marker::PhantomData;

/// `kp` when the configuration does not say.
pub const KP: f64 = 1.0;
/// `max` when the configuration does not say, and `-min`.
pub const LIMIT: f64 = 100.0;

/// A PID controller.
#[derive(Clone, Copy, Debug)]
pub struct Pid<V: Number> {
    gains: Gains,
    integral: Integral,
    filter_s: f64,
    /// Measured value before, absent before the first.
    measured: Option<f64>,
    /// The derivative of the measured value.
    derivative: f64,
    kind: PhantomData<V>,
}

#[derive(Clone, Copy, Debug)]
struct Gains {
    kp: f64,
    ki: f64,
    kd: f64,
}

/// The integral part of a controller and its limits: the one place that keeps it from winding up.
#[derive(Clone, Copy, Debug)]
pub struct Integral {
    /// Least output.
    pub min: f64,
    /// Greatest output.
    pub max: f64,
    /// The sum so far, in units of the output.
    pub sum: f64,
}

impl Integral {
    /// The limited output for the other parts together and a step of the integral, which is taken if it does not drive an
    /// output at its limit further.
    pub fn output(&mut self, others: f64, step: f64) -> f64 {
        let wanted = others + self.sum + step;
        let drives_further = (wanted > self.max && step > 0.0) || (wanted < self.min && step < 0.0);
        if !drives_further {
            self.sum = (self.sum + step).clamp(self.min, self.max);
        }
        wanted.clamp(self.min, self.max)
    }
}

impl<V: Number> Fusion for Pid<V> {
    type Input = V;
    type Output = V;
    const LAYOUT: Layout = Layout {
        name: "pid",
        inputs: &[2],
        outputs: &[1],
        is_timed: true,
    };
    const DESCRIPTION: &'static CStr =
        c"PID controller of a setpoint and a measured value, with anti-windup";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let params = Params::new(Self::LAYOUT.name, info);
        let gain = |name, default| params.real(name, default, -REAL_MAX..=REAL_MAX);
        let gains = Gains {
            kp: gain("kp", KP)?,
            ki: gain("ki", 0.0)?,
            kd: gain("kd", 0.0)?,
        };
        let filter_ms = params.real("filter_ms", 0.0, 0.0..=PERIOD_MS_MAX)?;
        let (min, max) = params.bounds(-LIMIT, LIMIT, REAL_MAX)?;
        Ok(Self {
            gains,
            integral: Integral { min, max, sum: 0.0 },
            filter_s: filter_ms / 1000.0,
            measured: None,
            derivative: 0.0,
            kind: PhantomData,
        })
    }

    fn step(
        &mut self,
        values: &[V],
        elapsed: Elapsed,
        results: &mut [V],
    ) -> Result<Conversion, Fault> {
        let (setpoint, measured) = (values[0].real(), values[1].real());
        let error = setpoint - measured;
        let mut step = 0.0;
        if let (Some(before), Some(seconds)) = (self.measured, elapsed.seconds()) {
            let slope = (measured - before) / seconds;
            let weight = seconds / (self.filter_s + seconds);
            self.derivative += (slope - self.derivative) * weight;
            step = self.gains.ki * error * seconds;
        }
        self.measured = Some(measured);
        let others = self.gains.kp * error - self.gains.kd * self.derivative;
        results[0] = V::from_real(self.integral.output(others, step)).ok_or_else(overflow)?;
        Ok(Conversion::Produced)
    }

    fn reset(&mut self) {
        self.measured = None;
        self.derivative = 0.0;
        self.integral.sum = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fused::tests::{open, step};

    #[test]
    fn every_part_does_its_part() {
        // By hand, T = 100 ms, kp 2, ki 10, kd 0.5: error 10: 20. Error 8, x from 0 to 2: P 16, I 10*8/10 = 8,
        // D -0.5 * 20 = -10: 14. Error 8 again: P 16, I 16, D 0: 32.
        let params = [("period_ms", 100.0), ("kp", 2.0), ("ki", 10.0), ("kd", 0.5)];
        let mut pid = open::<Pid<f32>>((2, 1), &params).unwrap();
        assert_eq!(step(&mut pid, &[10.0, 0.0], None), Ok([20.0]));
        assert_eq!(step(&mut pid, &[10.0, 2.0], None), Ok([14.0]));
        assert_eq!(step(&mut pid, &[10.0, 2.0], None), Ok([32.0]));
        let mut pid = open::<Pid<i32>>((2, 1), &params).unwrap();
        assert_eq!(step(&mut pid, &[10, 0], None), Ok([20]));
        assert_eq!(step(&mut pid, &[10, 2], None), Ok([14]));
    }

    #[test]
    fn a_new_setpoint_gives_no_kick_of_the_derivative() {
        let params = [("period_ms", 10.0), ("kp", 0.0), ("kd", 1.0)];
        let mut pid = open::<Pid<i32>>((2, 1), &params).unwrap();
        assert_eq!(step(&mut pid, &[0, 5], None), Ok([0]));
        assert_eq!(step(&mut pid, &[1000, 5], None), Ok([0]));
    }

    #[test]
    fn the_integral_does_not_wind_up() {
        // For 100 s the setpoint cannot be reached; the first sample beyond it must bring the output down.
        let params = [("period_ms", 100.0), ("kp", 1.0), ("ki", 1.0)];
        let mut pid = open::<Pid<i32>>((2, 1), &params).unwrap();
        for _ in 0..1000 {
            let [output] = step(&mut pid, &[1000, 0], None).unwrap();
            assert_eq!(output, 100);
        }
        assert_eq!(step(&mut pid, &[1000, 1010], None), Ok([-11]));
    }

    #[test]
    fn a_first_order_plant_reaches_the_setpoint() {
        // x' = (u - x) / 1 s, gain 1; the integral removes what the proportional part leaves.
        let params = [("period_ms", 10.0), ("kp", 4.0), ("ki", 4.0)];
        let mut pid = open::<Pid<f32>>((2, 1), &params).unwrap();
        let mut x = 0.0;
        for _ in 0..500 {
            let [u] = step(&mut pid, &[20.0, x], None).unwrap();
            x += (u - x) * 0.01;
        }
        assert!((x - 20.0).abs() < 0.1, "{x}");
    }

    #[test]
    fn limits_are_in_order_and_extremes_stay_within() {
        let refused = open::<Pid<i32>>((3, 1), &[("min", 5.0), ("max", 4.0)])
            .err()
            .unwrap();
        assert_eq!(refused.text(), "pid: min must not be above max");
        let refused = open::<Pid<i32>>((3, 1), &[("kp", f64::NAN)]).err().unwrap();
        assert_eq!(
            refused.text(),
            "pid: kp must be from -1000000000 to 1000000000, not NaN"
        );
        let params = [("kp", REAL_MAX), ("ki", REAL_MAX), ("kd", -REAL_MAX)];
        let mut pid = open::<Pid<f32>>((3, 1), &params).unwrap();
        for (n, x) in [f32::MAX, f32::MIN, f32::MAX, 0.0].into_iter().enumerate() {
            let [u] = step(&mut pid, &[f32::MAX, x], Some(n as u32)).unwrap();
            assert!(u.abs() <= 100.0, "{u}");
        }
    }
}
