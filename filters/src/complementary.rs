//! Complementary filter: an angle from a rate, which drifts, and a measured angle, which is noisy.
//!
//! y <- y + w T, then y <- y + (x - y) T / (tau + T): the rate through a high pass and the angle through a low pass of the same
//! time constant tau, which together pass everything (Higgins, A Comparison of Complementary and Kalman Filtering, IEEE
//! Transactions on Aerospace and Electronic Systems 11, 1975; Franklin, Powell and Emami-Naeini, Feedback Control of Dynamic
//! Systems). Short changes come from the rate, everything slower than tau from the angle. Begin: y = x.
//! With `wrap` angles that differ by it are the same: differences and results lie between -wrap/2 and wrap/2.
//! In f64, so that Lua gives the same bits. Cost: eight operations, one of them a division; with `wrap` two more divisions.

use crate::clock::Elapsed;
use crate::fused::{Fusion, Layout};
use crate::lanes::overflow;
use crate::limits::{PERIOD_MS_MAX, REAL_MAX};
use crate::number::Number;
use crate::params::Params;
use crate::trig::wrapped;
use converter::{Conversion, Fault, OpenInfo};
use std::ffi::CStr;
use std::marker::PhantomData;

/// Time constant when the configuration does not say.
pub const TIME_CONSTANT_MS: f64 = 1000.0;

/// A complementary filter of first order.
#[derive(Clone, Copy, Debug)]
pub struct Complementary<V: Number> {
    time_constant_s: f64,
    /// A whole turn; 0 for none.
    wrap: f64,
    angle: Option<f64>,
    kind: PhantomData<V>,
}

impl<V: Number> Complementary<V> {
    fn wrapped(&self, angle: f64) -> f64 {
        if self.wrap > 0.0 {
            wrapped(angle, self.wrap)
        } else {
            angle
        }
    }
}

impl<V: Number> Fusion for Complementary<V> {
    type Input = V;
    type Output = V;
    const LAYOUT: Layout = Layout {
        name: "complementary",
        inputs: &[2],
        outputs: &[1],
        is_timed: true,
    };
    const DESCRIPTION: &'static CStr =
        c"angle from a rate and a measured angle, with `time_constant_ms` and `wrap`";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let params = Params::new(Self::LAYOUT.name, info);
        let ms = params.real("time_constant_ms", TIME_CONSTANT_MS, 0.0..=PERIOD_MS_MAX)?;
        Ok(Self {
            time_constant_s: ms / 1000.0,
            wrap: params.real("wrap", 0.0, 0.0..=REAL_MAX)?,
            angle: None,
            kind: PhantomData,
        })
    }

    fn step(
        &mut self,
        values: &[V],
        elapsed: Elapsed,
        results: &mut [V],
    ) -> Result<Conversion, Fault> {
        let (rate, measured) = (values[0].real(), values[1].real());
        let angle = match (self.angle, elapsed.seconds()) {
            (Some(angle), Some(seconds)) => {
                let predicted = angle + rate * seconds;
                let weight = seconds / (self.time_constant_s + seconds);
                predicted + self.wrapped(measured - predicted) * weight
            }
            _ => measured,
        };
        let angle = self.wrapped(angle);
        self.angle = Some(angle);
        results[0] = V::from_real(angle).ok_or_else(overflow)?;
        Ok(Conversion::Produced)
    }

    fn reset(&mut self) {
        self.angle = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fused::tests::{open, step};

    #[test]
    fn the_rate_leads_and_the_angle_pulls() {
        // By hand, T = 100 ms, tau = 300 ms, weight 1/4: 0; 0 + 100/10 = 10, angle 0: 10 - 2.5 = 7.5; then 7.5 + 10 = 17.5,
        // angle 21.5: 17.5 + 1 = 18.5.
        let params = [("period_ms", 100.0), ("time_constant_ms", 300.0)];
        let mut filter = open::<Complementary<f32>>((2, 1), &params).unwrap();
        assert_eq!(step(&mut filter, &[100.0, 0.0], None), Ok([0.0]));
        assert_eq!(step(&mut filter, &[100.0, 0.0], None), Ok([7.5]));
        assert_eq!(step(&mut filter, &[100.0, 21.5], None), Ok([18.5]));
        let mut filter = open::<Complementary<i32>>((2, 1), &params).unwrap();
        assert_eq!(step(&mut filter, &[100, 0], None), Ok([0]));
        assert_eq!(step(&mut filter, &[100, 0], None), Ok([8]));
    }

    #[test]
    fn across_the_wrap_the_short_way_counts() {
        // 170 and -170 degrees are 20 apart, not 340: half of the way (tau = T) from 170 is 180, which is -180.
        let params = [
            ("period_ms", 10.0),
            ("time_constant_ms", 10.0),
            ("wrap", 360.0),
        ];
        let mut filter = open::<Complementary<i32>>((2, 1), &params).unwrap();
        assert_eq!(step(&mut filter, &[0, 170], None), Ok([170]));
        assert_eq!(step(&mut filter, &[0, -170], None), Ok([-180]));
        assert_eq!(step(&mut filter, &[0, -170], None), Ok([-175]));
    }

    #[test]
    fn a_drifting_rate_stays_near_the_angle() {
        // A rate that is wrong by b permanently leaves an error of b tau: 10 * 0.5 = 5.
        let params = [("period_ms", 10.0), ("time_constant_ms", 500.0)];
        let mut filter = open::<Complementary<f32>>((2, 1), &params).unwrap();
        let last = (0..2000)
            .map(|_| step::<_, 1>(&mut filter, &[10.0, 0.0], None))
            .last();
        let [angle] = last.unwrap().unwrap();
        assert!((angle - 5.0).abs() < 1e-3, "{angle}");
    }

    #[test]
    fn extremes_saturate_or_are_faults() {
        let mut filter = open::<Complementary<i32>>((3, 1), &[]).unwrap();
        assert_eq!(
            step(&mut filter, &[i32::MAX, i32::MAX], Some(0)),
            Ok([i32::MAX])
        );
        assert_eq!(
            step(&mut filter, &[i32::MAX, i32::MAX], Some(1_000_000)),
            Ok([i32::MAX])
        );
        let mut filter = open::<Complementary<f32>>((3, 1), &[]).unwrap();
        assert_eq!(
            step(&mut filter, &[f32::MAX, f32::MAX], Some(0)),
            Ok([f32::MAX])
        );
        assert_eq!(
            step::<_, 1>(&mut filter, &[f32::MAX, f32::MAX], Some(1_000_000)).unwrap_err(),
            "complementary: the result is not a finite number"
        );
        // And it starts over.
        assert_eq!(step(&mut filter, &[0.0, 3.0], Some(0)), Ok([3.0]));
    }
}
