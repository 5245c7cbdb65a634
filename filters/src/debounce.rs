//! Debouncing: a new value counts when it has come N times in a row; until then the old one stays.
//!
//! The counting debouncer (Ganssle, A Guide to Debouncing, 2004, "a counter-based algorithm"): for keys and switches, whose
//! contacts bounce for some milliseconds, and for sensors that give a wrong value now and then. A change is seen N - 1
//! samples late. The first value counts at once: there is no old one that could stay.
//! Cost: two comparisons.

use crate::lanes::Filter;
use crate::number::Number;
use crate::params::Params;
use converter::{Fault, OpenInfo};
use std::ffi::CStr;

/// Samples in a row when the configuration does not say.
pub const SAMPLES: f64 = 3.0;
/// Most samples in a row.
pub const SAMPLES_MAX: f64 = 1000.0;

/// A counting debouncer.
#[derive(Clone, Copy, Debug)]
pub struct Debounce<V: Number> {
    samples: u32,
    /// The value that counts.
    stable: Option<V>,
    /// A value that wants to count, and how often it has come in a row.
    candidate: (V, u32),
}

impl<V: Number> Filter for Debounce<V> {
    type Value = V;
    const NAME: &'static str = "debounce";
    const DESCRIPTION: &'static CStr =
        c"a new value counts when it has come `samples` times in a row";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let params = Params::new(Self::NAME, info);
        Ok(Self {
            samples: params.whole("samples", SAMPLES, 1.0..=SAMPLES_MAX)? as u32,
            stable: None,
            candidate: (V::ZERO, 0),
        })
    }

    fn step(&mut self, value: V) -> Result<Option<V>, Fault> {
        let stable = *self.stable.get_or_insert(value);
        let (candidate, times) = self.candidate;
        let times = if times > 0 && candidate == value {
            times + 1
        } else {
            1
        };
        if value == stable {
            self.candidate = (value, 0);
        } else if times >= self.samples {
            self.candidate = (value, 0);
            self.stable = Some(value);
        } else {
            self.candidate = (value, times);
        }
        Ok(self.stable)
    }

    fn reset(&mut self) {
        self.stable = None;
        self.candidate = (V::ZERO, 0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run<V: Number>(samples: u32, values: impl IntoIterator<Item = V>) -> Vec<V> {
        let mut filter = Debounce {
            samples,
            stable: None,
            candidate: (V::ZERO, 0),
        };
        values
            .into_iter()
            .map(|value| filter.step(value).unwrap().unwrap())
            .collect()
    }

    #[test]
    fn a_bouncing_contact_changes_once() {
        // By hand, three in a row: the third 1 in a row counts; the single 0 after it does not.
        let values = [0, 1, 0, 1, 1, 1, 0, 1, 0, 0, 0];
        assert_eq!(run(3, values), [0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 0]);
    }

    #[test]
    fn two_new_values_do_not_help_each_other() {
        assert_eq!(run(2, [5, 7, 9, 7, 9, 9]), [5, 5, 5, 5, 5, 9]);
        assert_eq!(run(2, [0.5_f32, 1.5, 1.5]), [0.5, 0.5, 1.5]);
    }

    #[test]
    fn one_sample_passes_everything() {
        assert_eq!(run(1, [i32::MIN, i32::MAX, 0]), [i32::MIN, i32::MAX, 0]);
    }
}
