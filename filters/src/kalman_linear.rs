//! Kalman filter of position and velocity: a position is measured, both are estimated.
//!
//! Motion with constant velocity and random acceleration of standard deviation s (Bar-Shalom, Li and Kirubarajan, Estimation
//! with Applications to Tracking and Navigation, 2001, section 6.3.2, discrete white noise acceleration), T seconds apart:
//!   predict  x <- x + T v,  P <- F P F' + Q,  F = [1 T; 0 1],  Q = s^2 [T^4/4 T^3/2; T^3/2 T^2]
//!   correct  S = P00 + r,  K = [P00 P01]' / S,  y = z - x,  x <- x + K0 y,  v <- v + K1 y,  P <- (1 - K [1 0]) P
//! Begin from two positions (section 5.5.3): x = z1, v = (z1 - z0)/T, P = r [1 1/T; 1/T 2/T^2]; the first gives no output.
//! P is symmetric and kept as three numbers. In f64: P holds differences of numbers of very different size, which f32
//! would lose after some thousand samples.
//! Cost: about 40 operations, three of them divisions.

use crate::clock::Elapsed;
use crate::fused::{Fusion, Layout};
use crate::lanes::overflow;
use crate::limits::REAL_MAX;
use crate::number::Number;
use crate::params::Params;
use converter::{Conversion, Fault, OpenInfo};
use std::ffi::CStr;
use std::marker::PhantomData;

/// Standard deviation of the acceleration, units/s^2, when the configuration does not say.
pub const ACCELERATION: f64 = 1000.0;
/// Standard deviation of a measured position, units, when the configuration does not say.
pub const NOISE: f64 = 1.0;
/// Least standard deviation of both: the variances stay positive.
pub const DEVIATION_MIN: f64 = 1e-6;

/// A Kalman filter of a position and its velocity.
#[derive(Clone, Copy, Debug)]
pub struct KalmanLinear<V: Number> {
    acceleration_variance: f64,
    noise_variance: f64,
    state: State,
    kind: PhantomData<V>,
}

#[derive(Clone, Copy, Debug)]
enum State {
    /// Nothing has been measured.
    Unknown,
    /// One position has been measured.
    Position(f64),
    /// Estimates and the variances P00, P01 = P10, P11.
    Motion {
        position: f64,
        velocity: f64,
        p: [f64; 3],
    },
}

impl<V: Number> KalmanLinear<V> {
    /// The state after a measured position, `t` seconds after the one before.
    fn follow(&self, measured: f64, t: f64) -> State {
        let r = self.noise_variance;
        let (x, v, [p00, p01, p11]) = match self.state {
            State::Unknown => return State::Position(measured),
            State::Position(before) => {
                let velocity = (measured - before) / t;
                let p = [r, r / t, 2.0 * r / (t * t)];
                return State::Motion {
                    position: measured,
                    velocity,
                    p,
                };
            }
            State::Motion {
                position,
                velocity,
                p,
            } => (position, velocity, p),
        };
        let x = x + t * v;
        // Q: half of the change of velocity in T acts on the position.
        let change = self.acceleration_variance * t * t;
        let p00 = p00 + t * (2.0 * p01 + t * p11) + change * t * t / 4.0;
        let p01 = p01 + t * p11 + change * t / 2.0;
        let p11 = p11 + change;
        let s = p00 + r;
        let (k0, k1) = (p00 / s, p01 / s);
        let innovation = measured - x;
        State::Motion {
            position: x + k0 * innovation,
            velocity: v + k1 * innovation,
            p: [(1.0 - k0) * p00, (1.0 - k0) * p01, p11 - k1 * p01],
        }
    }
}

impl<V: Number> Fusion for KalmanLinear<V> {
    type Input = V;
    type Output = V;
    const LAYOUT: Layout = Layout {
        name: "kalman_linear",
        inputs: &[1],
        outputs: &[2],
        is_timed: true,
    };
    const DESCRIPTION: &'static CStr =
        c"Kalman filter of a measured position: gives position and velocity";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let params = Params::new(Self::LAYOUT.name, info);
        let range = DEVIATION_MIN..=REAL_MAX;
        let acceleration = params.real("acceleration", ACCELERATION, range.clone())?;
        let noise = params.real("noise", NOISE, range)?;
        Ok(Self {
            acceleration_variance: acceleration * acceleration,
            noise_variance: noise * noise,
            state: State::Unknown,
            kind: PhantomData,
        })
    }

    fn step(
        &mut self,
        values: &[V],
        elapsed: Elapsed,
        results: &mut [V],
    ) -> Result<Conversion, Fault> {
        self.state = self.follow(values[0].real(), elapsed.seconds().unwrap_or(0.0));
        let State::Motion {
            position, velocity, ..
        } = self.state
        else {
            return Ok(Conversion::Consumed);
        };
        results[0] = V::from_real(position).ok_or_else(overflow)?;
        results[1] = V::from_real(velocity).ok_or_else(overflow)?;
        Ok(Conversion::Produced)
    }

    fn reset(&mut self) {
        self.state = State::Unknown;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fused::tests::{open, step};

    #[test]
    fn two_positions_make_a_velocity() {
        // By hand, 100 ms: 10 units in a tenth of a second are 100 per second; a third on the line changes nothing.
        let mut filter = open::<KalmanLinear<i32>>((1, 2), &[("period_ms", 100.0)]).unwrap();
        assert_eq!(
            step::<_, 2>(&mut filter, &[0], None),
            Err("consumed".to_owned())
        );
        assert_eq!(step(&mut filter, &[10], None), Ok([10, 100]));
        assert_eq!(step(&mut filter, &[20], None), Ok([20, 100]));
        assert_eq!(step(&mut filter, &[30], None), Ok([30, 100]));
    }

    #[test]
    fn it_corrects_by_the_textbook() {
        // By hand, T = 1, s = 1, r = 1, positions 0, 0, 3: P = [1 1; 1 2]; predicted P00 = 1 + 2 + 2 + 1/4 = 21/4,
        // P01 = 1 + 2 + 1/2 = 7/2; S = 25/4, K = 21/25, 14/25; 3 K = 2.52 and 1.68.
        let params = [("period_ms", 1000.0), ("acceleration", 1.0), ("noise", 1.0)];
        let mut filter = open::<KalmanLinear<f32>>((1, 2), &params).unwrap();
        assert!(step::<_, 2>(&mut filter, &[0.0], None).is_err());
        assert_eq!(step(&mut filter, &[0.0], None), Ok([0.0, 0.0]));
        assert_eq!(step(&mut filter, &[3.0], None), Ok([2.52, 1.68]));
    }

    #[test]
    fn uneven_times_are_no_trouble() {
        // 2000 units per second, samples 1 to 9 ms apart.
        let mut filter = open::<KalmanLinear<f32>>((2, 2), &[]).unwrap();
        let mut time_us = 0;
        for n in 0..500 {
            time_us += 1000 + (n * 7 % 9) * 1000;
            let position = time_us as f32 * 0.002;
            if let Ok([x, v]) = step::<_, 2>(&mut filter, &[position], Some(time_us)) {
                assert!((x - position).abs() < 0.01, "{n}: {x} {position}");
                assert!((v - 2000.0).abs() < 1.0, "{n}: {v}");
            }
        }
    }

    #[test]
    fn extremes_saturate_or_are_faults_and_never_panic() {
        let mut filter = open::<KalmanLinear<i32>>((1, 2), &[("period_ms", 1.0)]).unwrap();
        assert!(step::<_, 2>(&mut filter, &[i32::MIN], None).is_err());
        assert_eq!(
            step(&mut filter, &[i32::MAX], None),
            Ok([i32::MAX, i32::MAX])
        );
        let mut filter = open::<KalmanLinear<f32>>((1, 2), &[("period_ms", 1.0)]).unwrap();
        assert!(step::<_, 2>(&mut filter, &[f32::MIN], None).is_err());
        let fault = step::<_, 2>(&mut filter, &[f32::MAX], None).unwrap_err();
        assert_eq!(fault, "kalman_linear: the result is not a finite number");
        assert_eq!(
            step::<_, 2>(&mut filter, &[f32::NAN], None).unwrap_err(),
            "kalman_linear: value 0: not a finite number"
        );
    }
}
