//! Kalman filter of one number that wanders: x[n] = x[n-1] + noise of variance q, measured with noise of variance r.
//!
//! Predict: P <- P + q. Correct: K = P / (P + r), x <- x + K (z - x), P <- (1 - K) P. Begin: x = z, P = r.
//! (Kalman, A New Approach to Linear Filtering and Prediction Problems, 1960; in this form Simon, Optimal State Estimation,
//! 2006, section 5.1 with F = H = 1.) After some samples K settles and the filter is a low pass whose alpha is optimal for
//! the two variances; before that it trusts the measurements more, so it has no slow start.
//! Computed in f64 for integers too: K lies between 0 and 1. The result is rounded once.
//! Cost: seven operations, one of them a division.

use crate::lanes::{Filter, overflow};
use crate::limits::REAL_MAX;
use crate::number::Number;
use crate::params::Params;
use converter::{Fault, OpenInfo};
use std::ffi::CStr;
use std::marker::PhantomData;

/// Variance of the change from one sample to the next when the configuration does not say.
pub const Q: f64 = 1.0;
/// Variance of the measurement when the configuration does not say.
pub const R: f64 = 16.0;
/// Least variance of the measurement: P + r is never 0.
pub const R_MIN: f64 = 1e-9;

/// A scalar Kalman filter.
#[derive(Clone, Copy, Debug)]
pub struct Kalman<V: Number> {
    q: f64,
    r: f64,
    /// Estimate and its variance.
    state: Option<(f64, f64)>,
    kind: PhantomData<V>,
}

impl<V: Number> Kalman<V> {
    /// A filter for these variances, in squares of the unit of the values.
    pub fn new(q: f64, r: f64) -> Self {
        Self {
            q,
            r,
            state: None,
            kind: PhantomData,
        }
    }
}

impl<V: Number> Filter for Kalman<V> {
    type Value = V;
    const NAME: &'static str = "kalman";
    const DESCRIPTION: &'static CStr =
        c"scalar Kalman filter: variance `q` of each change, `r` of each measurement";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let params = Params::new(Self::NAME, info);
        let q = params.real("q", Q, 0.0..=REAL_MAX)?;
        Ok(Self::new(q, params.real("r", R, R_MIN..=REAL_MAX)?))
    }

    fn step(&mut self, value: V) -> Result<Option<V>, Fault> {
        let measured = value.real();
        let state = match self.state {
            None => (measured, self.r),
            Some((estimate, variance)) => {
                let predicted = variance + self.q;
                let gain = predicted / (predicted + self.r);
                (
                    estimate + gain * (measured - estimate),
                    (1.0 - gain) * predicted,
                )
            }
        };
        self.state = Some(state);
        V::from_real(state.0).map(Some).ok_or_else(overflow)
    }

    fn reset(&mut self) {
        self.state = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run<V: Number>(q: f64, r: f64, values: impl IntoIterator<Item = V>) -> Vec<V> {
        let mut filter = Kalman::new(q, r);
        values
            .into_iter()
            .map(|value| filter.step(value).unwrap().unwrap())
            .collect()
    }

    #[test]
    fn a_constant_is_estimated_by_the_mean() {
        // By hand, q = 0, r = 4: P = 4, K = 1/2, P = 2, K = 1/3, P = 4/3, K = 1/4: the mean of all values so far.
        assert_eq!(
            run(0.0, 4.0, [0.0_f32, 4.0, 8.0, 16.0]),
            [0.0, 2.0, 4.0, 7.0]
        );
        assert_eq!(run(0.0, 4.0, [0, 4, 8, 16]), [0, 2, 4, 7]);
    }

    #[test]
    fn the_gain_settles_where_the_riccati_equation_says() {
        // P = P + q before, P^2 - q P - q r = 0 after: q = 1, r = 2 gives P = 2 and K = 1/2.
        let mut filter = Kalman::<f32>::new(1.0, 2.0);
        for _ in 0..200 {
            filter.step(0.0).unwrap();
        }
        assert_eq!(filter.step(1000.0), Ok(Some(500.0)));
    }

    #[test]
    fn extremes_stay_in_range() {
        let values = [i32::MIN, i32::MAX, i32::MIN, i32::MAX];
        assert_eq!(run(REAL_MAX, R_MIN, values), values);
        assert!(
            run(Q, R, [f32::MAX, f32::MIN, f32::MAX])
                .iter()
                .all(|value| value.is_finite())
        );
    }

    #[test]
    fn noise_is_calmed_and_a_step_is_followed() {
        // Alternating noise of 10 around 100: variance 100; after a step of 1000 the estimate is there within 50 samples.
        let noise = |n: i32| if n % 2 == 0 { 10 } else { -10 };
        let values = (0..200).map(|n| if n < 100 { 100 } else { 1100 } + noise(n));
        let outputs = run(10.0, 100.0, values);
        assert!(
            outputs[50..100]
                .iter()
                .all(|value| (97..=103).contains(value)),
            "{outputs:?}"
        );
        assert!(
            outputs[150..]
                .iter()
                .all(|value| (1097..=1103).contains(value)),
            "{outputs:?}"
        );
    }
}
