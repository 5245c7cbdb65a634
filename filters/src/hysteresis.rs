//! Hysteresis (Schmitt trigger): y = 1 from x >= high on, y = 0 from x <= low on, and in between what it was.
//!
//! Two thresholds instead of one, so that noise at the threshold does not switch (Schmitt, A thermionic trigger, Journal of
//! Scientific Instruments 15, 1938). Before either threshold has been reached y is 0.
//! Cost: two comparisons.

use crate::lanes::Filter;
use crate::number::Number;
use crate::params::{Named, check_value};
use converter::{Fault, OpenInfo};
use std::ffi::CStr;

/// Lower threshold when the configuration does not say.
pub const LOW: f64 = 0.0;
/// Upper threshold when the configuration does not say.
pub const HIGH: f64 = 1.0;

/// A switch with two thresholds.
#[derive(Clone, Copy, Debug)]
pub struct Hysteresis<V: Number> {
    low: V::Wide,
    high: V::Wide,
    is_high: bool,
}

impl<V: Number> Hysteresis<V> {
    /// A switch that is off up to `low` and on from `high`.
    ///
    /// # Errors
    /// A threshold that is no value of the kind, or a lower one that is not below the upper one.
    pub fn new(low: f64, high: f64) -> Result<Self, Fault> {
        let named = |param| Named {
            filter: Self::NAME,
            param,
        };
        let thresholds = (
            check_value::<V>(named("low"), low)?,
            check_value::<V>(named("high"), high)?,
        );
        if low >= high {
            return Err(Fault::new("hysteresis: low must be below high"));
        }
        Ok(Self {
            low: thresholds.0,
            high: thresholds.1,
            is_high: false,
        })
    }
}

impl<V: Number> Filter for Hysteresis<V> {
    type Value = V;
    const NAME: &'static str = "hysteresis";
    const DESCRIPTION: &'static CStr =
        c"1 from `high` upwards, 0 from `low` downwards, in between as before";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        Self::new(
            info.param("low").unwrap_or(LOW),
            info.param("high").unwrap_or(HIGH),
        )
    }

    fn step(&mut self, value: V) -> Result<Option<V>, Fault> {
        let wide = value.wide();
        self.is_high = wide >= self.high || (self.is_high && wide > self.low);
        Ok(V::from_real(f64::from(u8::from(self.is_high))))
    }

    fn reset(&mut self) {
        self.is_high = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_switches_at_the_threshold_that_it_comes_to() {
        // By hand, 30 and 60: on at 60, still on at 31, off at 30, still off at 59.
        let mut switch = Hysteresis::<i32>::new(30.0, 60.0).unwrap();
        let outputs =
            [45, 60, 31, 30, 59, 99, 45, -5].map(|value| switch.step(value).unwrap().unwrap());
        assert_eq!(outputs, [0, 1, 1, 0, 0, 1, 1, 0]);
        let mut switch = Hysteresis::<f32>::new(-0.5, 0.5).unwrap();
        let outputs = [0.0_f32, 0.5, -0.25, -0.5].map(|value| switch.step(value).unwrap().unwrap());
        assert_eq!(outputs, [0.0, 1.0, 1.0, 0.0]);
    }

    #[test]
    fn thresholds_are_in_order_and_values_of_the_kind() {
        let refused = |low, high| Hysteresis::<i32>::new(low, high).unwrap_err().to_string();
        assert_eq!(refused(2.0, 2.0), "hysteresis: low must be below high");
        assert_eq!(
            refused(0.5, 2.0),
            "hysteresis: low must be a whole number from -2147483648 to 2147483647, not 0.5"
        );
        assert!(Hysteresis::<f32>::new(f64::NAN, 1.0).is_err());
    }
}
