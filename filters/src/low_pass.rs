//! Low-pass filter of first order, the exponential moving average: y[n] = y[n-1] + alpha (x[n] - y[n-1]), y[0] = x[0].
//!
//! The single-pole low pass (Smith, The Scientist and Engineer's Guide to Digital Signal Processing, chapter 19, equation
//! 19-2, where 1 - alpha is called x). It is the RC circuit with its derivative replaced by the backward difference: a time
//! constant of tau with samples every T gives alpha = T / (tau + T), and a cutoff frequency f_c has tau = 1 / (2 pi f_c).
//! Integers: alpha is rounded to a multiple of 2^-15 and y is kept with 16 bits after the point, so that the output settles
//! within one quarter of a count of a constant input, whatever alpha is, before it is rounded.
//! Cost: one 64-bit multiplication and two additions; for floats the same in f64.

use crate::lanes::{Filter, overflow};
use crate::number::Number;
use crate::params::{Named, check};
use converter::{Fault, OpenInfo};
use std::ffi::CStr;

/// Weight of a new value when the configuration does not say.
pub const ALPHA: f64 = 0.25;
/// Least weight of a new value.
pub const ALPHA_MIN: f64 = 1.0 / 32_768.0;
/// Bits after the point of an integer filter's alpha.
const ALPHA_BITS: u32 = 15;
/// Bits after the point of an integer filter's state: 2^32 * 2^16 * 2^15 is the largest product and fits 63 bits.
const STATE_BITS: u32 = 16;

/// An exponential moving average.
#[derive(Clone, Copy, Debug)]
pub struct LowPass<V: Smooth> {
    alpha: V::Wide,
    /// The last output before rounding.
    state: Option<V::Wide>,
}

/// The recurrence in the arithmetic of a kind of value.
pub trait Smooth: Number {
    /// The weight of a new value.
    fn weight(alpha: f64) -> Self::Wide;
    /// The state after the first value.
    fn begin(value: Self) -> Self::Wide;
    /// The state after a further value.
    fn follow(state: Self::Wide, value: Self, weight: Self::Wide) -> Self::Wide;
    /// The output for a state.
    fn output(state: Self::Wide) -> Option<Self>;
}

impl Smooth for i32 {
    fn weight(alpha: f64) -> i64 {
        (alpha * f64::from(1 << ALPHA_BITS) + 0.5).floor() as i64
    }

    fn begin(value: i32) -> i64 {
        i64::from(value) << STATE_BITS
    }

    fn follow(state: i64, value: i32, weight: i64) -> i64 {
        let change = ((i64::from(value) << STATE_BITS) - state) * weight;
        state + ((change + (1 << (ALPHA_BITS - 1))) >> ALPHA_BITS)
    }

    fn output(state: i64) -> Option<i32> {
        i32::narrow((state + (1 << (STATE_BITS - 1))) >> STATE_BITS)
    }
}

impl Smooth for f32 {
    fn weight(alpha: f64) -> f64 {
        alpha
    }

    fn begin(value: f32) -> f64 {
        f64::from(value)
    }

    fn follow(state: f64, value: f32, weight: f64) -> f64 {
        state + weight * (f64::from(value) - state)
    }

    fn output(state: f64) -> Option<f32> {
        f32::narrow(state)
    }
}

impl<V: Smooth> LowPass<V> {
    /// A filter that gives a new value this weight, from [`ALPHA_MIN`] to 1.
    ///
    /// # Errors
    /// An alpha out of range.
    pub fn new(alpha: f64) -> Result<Self, Fault> {
        let named = Named {
            filter: Self::NAME,
            param: "alpha",
        };
        let alpha = check::<f32>(named, alpha, ALPHA_MIN..=1.0)?;
        Ok(Self {
            alpha: V::weight(alpha),
            state: None,
        })
    }
}

impl<V: Smooth> Filter for LowPass<V> {
    type Value = V;
    const NAME: &'static str = "low_pass";
    const DESCRIPTION: &'static CStr =
        c"first-order low pass: each new value has the weight `alpha`";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        Self::new(info.param("alpha").unwrap_or(ALPHA))
    }

    fn step(&mut self, value: V) -> Result<Option<V>, Fault> {
        let state = match self.state {
            Some(state) => V::follow(state, value, self.alpha),
            None => V::begin(value),
        };
        self.state = Some(state);
        V::output(state).map(Some).ok_or_else(overflow)
    }

    fn reset(&mut self) {
        self.state = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run<V: Smooth>(alpha: f64, values: impl IntoIterator<Item = V>) -> Vec<V> {
        let mut filter = LowPass::new(alpha).unwrap();
        values
            .into_iter()
            .map(|value| filter.step(value).unwrap().unwrap())
            .collect()
    }

    #[test]
    fn a_step_is_approached_by_the_same_share_each_time() {
        // By hand, alpha = 1/2 from 0 to 100: 50, 75, 87.5, 93.75, 96.875; halves round up.
        assert_eq!(
            run(0.5, [0, 100, 100, 100, 100, 100]),
            [0, 50, 75, 88, 94, 97]
        );
        assert_eq!(
            run(0.5, [0.0_f32, 100.0, 100.0, 100.0]),
            [0.0, 50.0, 75.0, 87.5]
        );
    }

    #[test]
    fn the_first_value_is_the_first_output() {
        assert_eq!(run(ALPHA_MIN, [-7]), [-7]);
        assert_eq!(run(ALPHA_MIN, [-7.5_f32]), [-7.5]);
    }

    #[test]
    fn even_the_slowest_integer_filter_arrives() {
        let mut filter = LowPass::<i32>::new(ALPHA_MIN).unwrap();
        assert_eq!(filter.step(0), Ok(Some(0)));
        let last = (0..400_000).map(|_| filter.step(1000)).last();
        assert_eq!(last, Some(Ok(Some(1000))));
    }

    #[test]
    fn extremes_do_not_overflow() {
        assert_eq!(
            run(1.0, [i32::MIN, i32::MAX, i32::MIN]),
            [i32::MIN, i32::MAX, i32::MIN]
        );
        assert_eq!(run(1.0, [f32::MIN, f32::MAX]), [f32::MIN, f32::MAX]);
    }

    #[test]
    fn alpha_has_limits() {
        for alpha in ["0", "1.5", "-1", "NaN"] {
            let refused = LowPass::<i32>::new(alpha.parse().unwrap()).unwrap_err();
            let text = format!("low_pass: alpha must be from 0.000030517578125 to 1, not {alpha}");
            assert_eq!(refused.text(), text);
        }
    }
}
