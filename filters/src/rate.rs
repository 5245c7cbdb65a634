//! Rate of change: y[n] = (x[n] - x[n-1]) * 1000 / T, per second, for samples that come every T milliseconds.
//!
//! The backward difference (Astrom and Wittenmark, Computer-Controlled Systems, chapter 8: approximation of a derivative).
//! It turns an encoder's angle into a speed. It enlarges noise: put a median or a low pass in front of it.
//! The first value has no predecessor and gives no output. There is no clock here: T is what the configuration says.
//! Integers: exact, then rounded to nearest, halves away from zero; results outside the integers saturate.
//! Cost: one 64-bit multiplication and one 64-bit division; for floats the same in f64.

use crate::lanes::{Filter, overflow};
use crate::number::Number;
use crate::params::{Named, check};
use converter::{Fault, OpenInfo};
use std::ffi::CStr;

/// `period_ms` when the configuration does not say: the plain difference of two values.
pub const PERIOD_MS: f64 = 1000.0;
/// Longest period: one hour, as for `poll_ms`.
pub const PERIOD_MS_MAX: f64 = 3_600_000.0;

/// A backward difference.
#[derive(Clone, Copy, Debug)]
pub struct Rate<V: Number> {
    period_ms: V::Wide,
    previous: Option<V>,
}

impl<V: Number> Rate<V> {
    /// A difference for values that come every `period_ms` milliseconds, a whole number from 1 to [`PERIOD_MS_MAX`].
    ///
    /// # Errors
    /// A period out of range or not whole.
    pub fn new(period_ms: f64) -> Result<Self, Fault> {
        let named = Named {
            filter: Self::NAME,
            param: "period_ms",
        };
        check::<i32>(named, period_ms, 1.0..=PERIOD_MS_MAX)?;
        Ok(Self {
            period_ms: V::from_param(period_ms),
            previous: None,
        })
    }
}

impl<V: Number> Filter for Rate<V> {
    type Value = V;
    const NAME: &'static str = "rate";
    const DESCRIPTION: &'static CStr = c"change per second of values that come every `period_ms`";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        Self::new(info.param("period_ms").unwrap_or(PERIOD_MS))
    }

    fn step(&mut self, value: V) -> Result<Option<V>, Fault> {
        let Some(previous) = self.previous.replace(value) else {
            return Ok(None);
        };
        let change = value.wide() - previous.wide();
        let rate = V::ratio(change, V::from_param(1000.0), self.period_ms);
        V::narrow(rate).map(Some).ok_or_else(overflow)
    }

    fn reset(&mut self) {
        self.previous = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_value_gives_nothing_and_the_next_their_change_per_second() {
        // By hand, every 10 ms: (5-0)*1000/10 = 500, (2-5)*100 = -300, no change 0.
        let mut rate = Rate::<i32>::new(10.0).unwrap();
        let outputs = [0, 5, 2, 2].map(|value| rate.step(value).unwrap());
        assert_eq!(outputs, [None, Some(500), Some(-300), Some(0)]);
        let mut rate = Rate::<f32>::new(2000.0).unwrap();
        let outputs = [1.0_f32, 2.0].map(|value| rate.step(value).unwrap());
        assert_eq!(outputs, [None, Some(0.5)]);
    }

    #[test]
    fn halves_round_away_from_zero_and_extremes_saturate() {
        let mut rate = Rate::<i32>::new(2000.0).unwrap();
        let outputs = [0, 1, 0, -3].map(|value| rate.step(value).unwrap());
        assert_eq!(outputs, [None, Some(1), Some(-1), Some(-2)]);
        let mut rate = Rate::<i32>::new(1.0).unwrap();
        let outputs = [i32::MIN, i32::MAX, i32::MIN].map(|value| rate.step(value).unwrap());
        assert_eq!(outputs, [None, Some(i32::MAX), Some(i32::MIN)]);
    }

    #[test]
    fn the_period_has_limits() {
        for period in ["0", "0.5", "3600001", "NaN"] {
            let refused = Rate::<f32>::new(period.parse().unwrap()).unwrap_err();
            let text =
                format!("rate: period_ms must be a whole number from 1 to 3600000, not {period}");
            assert_eq!(refused.text(), text);
        }
    }
}
