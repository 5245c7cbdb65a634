//! Median of the last three values: y[n] = median(x[n-2], x[n-1], x[n]).
//!
//! Removes single outliers and keeps edges (Tukey, Exploratory Data Analysis, 1977, chapter 7: running medians of 3).
//! Before the first value the sequence is continued backwards by that value, so y[0] = y[1] = x[0].
//! Cost: at most three comparisons.

use crate::lanes::Filter;
use crate::number::Number;
use converter::{Fault, OpenInfo};
use std::ffi::CStr;

/// A running median of three. It has no parameters.
#[derive(Clone, Copy, Debug, Default)]
pub struct Median3<V> {
    /// The last two values, older first.
    past: Option<(V, V)>,
}

impl<V: Number> Median3<V> {
    /// A median that has seen no value.
    pub fn new() -> Self {
        Self { past: None }
    }
}

impl<V: Number> Filter for Median3<V> {
    type Value = V;
    const NAME: &'static str = "median3";
    const DESCRIPTION: &'static CStr = c"median of the last three values: removes single outliers";

    fn open(_: &OpenInfo<'_>) -> Result<Self, Fault> {
        Ok(Self::new())
    }

    fn step(&mut self, value: V) -> Result<Option<V>, Fault> {
        let (older, newer) = self.past.unwrap_or((value, value));
        self.past = Some((newer, value));
        let (low, high) = if older < newer {
            (older, newer)
        } else {
            (newer, older)
        };
        Ok(Some(if value < low {
            low
        } else if value > high {
            high
        } else {
            value
        }))
    }

    fn reset(&mut self) {
        self.past = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outlier_disappears_and_a_step_comes_one_value_late() {
        // By hand, windows of three: 5 5 5 | 5 5 900 -> 5 | 5 900 6 -> 6 | 900 6 7 -> 7 | 6 7 50 -> 7 | 7 50 50 -> 50.
        let mut median = Median3::<i32>::new();
        let outputs = [5, 900, 6, 7, 50, 50].map(|value| median.step(value).unwrap().unwrap());
        assert_eq!(outputs, [5, 5, 6, 7, 7, 50]);
    }

    #[test]
    fn every_order_of_three_values_has_the_same_median() {
        for order in [
            [1, 2, 3],
            [1, 3, 2],
            [2, 1, 3],
            [2, 3, 1],
            [3, 1, 2],
            [3, 2, 1],
        ] {
            let mut median = Median3::<f32>::new();
            let outputs = order.map(|value| median.step(value as f32).unwrap().unwrap());
            assert_eq!(outputs[2], 2.0);
        }
    }
}
