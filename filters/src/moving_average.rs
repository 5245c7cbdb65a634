//! Moving average: y[n] = (x[n] + x[n-1] + ... + x[n-N+1]) / N.
//!
//! The best filter against white noise that keeps a step sharp (Smith, The Scientist and Engineer's Guide to Digital Signal
//! Processing, chapter 15, equation 15-1). Until N values have come, the mean of those that have.
//! Integers round to nearest, halves away from zero.
//! Cost: integers one addition, one subtraction and one 64-bit division (recursive form, equation 15-3);
//! floats N additions, oldest first, for a running sum of floats keeps the rounding error of every value that ever passed.

use crate::lanes::{Filter, overflow};
use crate::number::Number;
use crate::params::{Named, check};
use converter::{Fault, OpenInfo};
use std::ffi::CStr;

/// Values in the window when the configuration does not say.
pub const WINDOW: f64 = 8.0;
/// Most values in the window.
pub const WINDOW_MAX: f64 = 256.0;

/// The mean of the last values.
#[derive(Clone, Debug)]
pub struct MovingAverage<V: Number> {
    /// The window, a ring once it is full.
    ring: Vec<V>,
    /// Values in a full window.
    window: usize,
    /// Place of the oldest value of a full ring.
    oldest: usize,
    /// Sum of the ring, kept up for integers only: at most 2^31 * 256.
    sum: V::Wide,
}

impl<V: Number> MovingAverage<V> {
    /// A mean of the last `window` values, from 1 to [`WINDOW_MAX`].
    ///
    /// # Errors
    /// A window out of range or not whole.
    pub fn new(window: f64) -> Result<Self, Fault> {
        let named = Named {
            filter: Self::NAME,
            param: "window",
        };
        let window = check::<i32>(named, window, 1.0..=WINDOW_MAX)? as usize;
        Ok(Self {
            ring: Vec::with_capacity(window),
            window,
            oldest: 0,
            sum: V::from_param(0.0),
        })
    }

    /// Puts a value into the ring and keeps up the sum.
    fn push(&mut self, value: V) {
        if self.ring.len() < self.window {
            self.ring.push(value);
        } else {
            self.sum = self.sum - self.ring[self.oldest].wide();
            self.ring[self.oldest] = value;
            self.oldest = (self.oldest + 1) % self.window;
        }
        self.sum = self.sum + value.wide();
    }
}

impl<V: Number> Filter for MovingAverage<V> {
    type Value = V;
    const NAME: &'static str = "moving_average";
    const DESCRIPTION: &'static CStr = c"mean of the last `window` values: calms noise";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        Self::new(info.param("window").unwrap_or(WINDOW))
    }

    fn step(&mut self, value: V) -> Result<Option<V>, Fault> {
        self.push(value);
        if !V::WHOLE {
            let (newer, older) = self.ring.split_at(self.oldest);
            let in_order = older.iter().chain(newer);
            self.sum = in_order.fold(V::from_param(0.0), |sum, value| sum + value.wide());
        }
        let mean = V::ratio(
            self.sum,
            V::from_param(1.0),
            V::from_param(self.ring.len() as f64),
        );
        V::narrow(mean).map(Some).ok_or_else(overflow)
    }

    fn reset(&mut self) {
        self.ring.clear();
        self.oldest = 0;
        self.sum = V::from_param(0.0);
    }

    fn state_bytes(&self) -> usize {
        size_of::<Self>() + self.window * size_of::<V>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run<V: Number>(window: f64, values: &[V]) -> Vec<V> {
        let mut average = MovingAverage::new(window).unwrap();
        values
            .iter()
            .map(|value| average.step(*value).unwrap().unwrap())
            .collect()
    }

    #[test]
    fn a_step_becomes_a_ramp_as_long_as_the_window() {
        // By hand, N = 4: 0 | 0 | (0+0+8)/3 = 2.67 | 16/4 | 24/4 | 32/4 | 32/4.
        assert_eq!(run(4.0, &[0, 0, 8, 8, 8, 8, 8]), [0, 0, 3, 4, 6, 8, 8]);
    }

    #[test]
    fn integers_round_halves_away_from_zero() {
        assert_eq!(run(2.0, &[1, 2, -3, -4]), [1, 2, -1, -4]);
    }

    #[test]
    fn a_huge_float_leaves_no_trace_once_it_is_out_of_the_window() {
        assert_eq!(run(2.0, &[1e30_f32, 0.25, 0.5, 0.75])[2..], [0.375, 0.625]);
    }

    #[test]
    fn extremes_neither_overflow_nor_wander() {
        let mut values = vec![i32::MIN; 300];
        values.extend([i32::MAX; 300]);
        let means = run(256.0, &values);
        assert_eq!((means[299], means[599]), (i32::MIN, i32::MAX));
        assert_eq!(run(3.0, &[f32::MAX; 4]), [f32::MAX; 4]);
    }

    #[test]
    fn the_window_has_limits() {
        let refused = |window| MovingAverage::<f32>::new(window).unwrap_err().to_string();
        for window in ["0", "2.5", "257", "NaN"] {
            let text = format!(
                "moving_average: window must be a whole number from 1 to 256, not {window}"
            );
            assert_eq!(refused(window.parse().unwrap()), text);
        }
    }
}
