//! Inverse curve: y = k / (x + raw_offset) + offset, for sensors whose signal falls as the distance grows.
//!
//! Triangulating infrared sensors of Sharp (GP2Y0A series) give a voltage almost linear in 1 / (distance + constant), as
//! their data sheets plot it; the inverse of that line is this equation. It is the formula of TRIK's runtime for its
//! `sharpGP2` type, S / (raw + L) + N, with k = S, raw_offset = L, offset = N.
//! Three points (distance, raw) determine the constants; docs/converters/filters.md has the formulas.
//! Integers drop the fraction of the quotient, as the runtime does.
//! At and beyond the pole, x + raw_offset <= 0, there is no distance: that is a fault, not a number.
//! Cost: one 64-bit division; for floats one in f64.

use crate::lanes::{Filter, overflow};
use crate::number::Number;
use crate::params::{Named, check_value};
use converter::{Fault, OpenInfo};
use std::ffi::CStr;

/// `k` when the configuration does not say: with the other defaults TRIK's sharpGP2 sensor in centimetres.
pub const K: f64 = 8697.0;
/// `raw_offset` when the configuration does not say.
pub const RAW_OFFSET: f64 = 0.0;
/// `offset` when the configuration does not say.
pub const OFFSET: f64 = -2.0;

/// An inverse curve. It has no memory.
#[derive(Clone, Copy, Debug)]
pub struct Inverse<V: Number> {
    k: V::Wide,
    raw_offset: V::Wide,
    offset: V::Wide,
}

impl<V: Number> Inverse<V> {
    /// A curve with these constants, each any value of the kind.
    ///
    /// # Errors
    /// A constant that is none.
    pub fn new(k: f64, raw_offset: f64, offset: f64) -> Result<Self, Fault> {
        let value = |param, value| {
            let named = Named {
                filter: Self::NAME,
                param,
            };
            check_value::<V>(named, value)
        };
        Ok(Self {
            k: value("k", k)?,
            raw_offset: value("raw_offset", raw_offset)?,
            offset: value("offset", offset)?,
        })
    }
}

impl<V: Number> Filter for Inverse<V> {
    type Value = V;
    const NAME: &'static str = "inverse";
    const DESCRIPTION: &'static CStr = c"k / (x + raw_offset) + offset: infrared distance sensors";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        Self::new(
            info.param("k").unwrap_or(K),
            info.param("raw_offset").unwrap_or(RAW_OFFSET),
            info.param("offset").unwrap_or(OFFSET),
        )
    }

    fn step(&mut self, value: V) -> Result<Option<V>, Fault> {
        let shifted = value.wide() + self.raw_offset;
        if shifted <= V::from_param(0.0) {
            return Err(Fault::new("the raw value is beyond the pole of the curve"));
        }
        let result = V::quotient(self.k, shifted) + self.offset;
        V::narrow(result).map(Some).ok_or_else(overflow)
    }

    fn reset(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triks_infrared_sensor_reads_in_centimetres() {
        // By hand: 8697/322 = 27.01, 8697/235 = 37.01, 8697/511 = 17.02, each minus 2; 8697/1000 = 8.697 drops its fraction.
        let mut inverse = Inverse::<i32>::new(K, RAW_OFFSET, OFFSET).unwrap();
        let distances = [322, 235, 511, 1000].map(|raw| inverse.step(raw).unwrap().unwrap());
        assert_eq!(distances, [25, 35, 15, 6]);
        let mut inverse = Inverse::<f32>::new(10.0, 1.0, 0.5).unwrap();
        assert_eq!(inverse.step(3.0), Ok(Some(3.0)));
    }

    #[test]
    fn the_pole_and_what_lies_behind_it_is_a_fault() {
        let mut inverse = Inverse::<i32>::new(100.0, -5.0, 0.0).unwrap();
        for raw in [5, 4, i32::MIN] {
            let fault = inverse.step(raw).unwrap_err();
            assert_eq!(
                fault.text(),
                "the raw value is beyond the pole of the curve"
            );
        }
        assert_eq!(inverse.step(6), Ok(Some(100)));
    }

    #[test]
    fn results_saturate_as_integers_and_are_faults_as_floats() {
        let mut inverse = Inverse::<i32>::new(2_147_483_647.0, 0.0, 1.0).unwrap();
        assert_eq!(inverse.step(1), Ok(Some(i32::MAX)));
        let mut inverse = Inverse::<f32>::new(1e38, 0.0, 0.0).unwrap();
        assert_eq!(inverse.step(1e-5).unwrap_err(), overflow());
        assert_eq!(inverse.step(10.0), Ok(Some(1e37)));
    }

    #[test]
    fn constants_must_be_values() {
        let refused = Inverse::<i32>::new(0.5, 0.0, 0.0).unwrap_err();
        let text = "inverse: k must be a whole number from -2147483648 to 2147483647, not 0.5";
        assert_eq!(refused.text(), text);
        assert!(Inverse::<f32>::new(0.5, f64::NAN, 0.0).is_err());
    }
}
