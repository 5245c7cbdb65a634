//! Dead band (dead zone): y = c for |x - c| <= w, y = x - w above, y = x + w below.
//!
//! The static dead-zone nonlinearity of unit slope around a centre c (Slotine and Li, Applied Nonlinear Control, 1991,
//! section 5.2). Makes the rest position of a stick exact, without a jump at the edge of the band.
//! Cost: two comparisons and two additions.

use crate::lanes::{Filter, overflow};
use crate::number::Number;
use crate::params::{Named, check, check_value};
use converter::{Fault, OpenInfo};
use std::ffi::CStr;

/// Half the breadth of the band when the configuration does not say: no band.
pub const WIDTH: f64 = 0.0;
/// Centre of the band when the configuration does not say.
pub const CENTER: f64 = 0.0;

/// A dead band. It has no memory.
#[derive(Clone, Copy, Debug)]
pub struct DeadBand<V: Number> {
    width: V::Wide,
    center: V::Wide,
}

impl<V: Number> DeadBand<V> {
    /// A band that reaches from `center - width` to `center + width`; a width is not negative.
    ///
    /// # Errors
    /// A parameter that is no value of the kind, or a negative width.
    pub fn new(width: f64, center: f64) -> Result<Self, Fault> {
        let named = |param| Named {
            filter: Self::NAME,
            param,
        };
        Ok(Self {
            width: check::<V>(named("width"), width, 0.0..=V::GREATEST)?,
            center: check_value::<V>(named("center"), center)?,
        })
    }
}

impl<V: Number> Filter for DeadBand<V> {
    type Value = V;
    const NAME: &'static str = "dead_band";
    const DESCRIPTION: &'static CStr =
        c"values within `width` of `center` become `center`, the others move towards it";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        Self::new(
            info.param("width").unwrap_or(WIDTH),
            info.param("center").unwrap_or(CENTER),
        )
    }

    fn step(&mut self, value: V) -> Result<Option<V>, Fault> {
        let wide = value.wide();
        let deviation = wide - self.center;
        let result = if deviation > self.width {
            wide - self.width
        } else if deviation < -self.width {
            wide + self.width
        } else {
            self.center
        };
        V::narrow(result).map(Some).ok_or_else(overflow)
    }

    fn reset(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stick_rests_exactly_and_leaves_the_band_without_a_jump() {
        // By hand, centre 128, width 10: 118..138 rest; 139 - 10 = 129, 117 + 10 = 127, 255 - 10 = 245, 0 + 10 = 10.
        let mut band = DeadBand::<i32>::new(10.0, 128.0).unwrap();
        let outputs =
            [128, 118, 138, 139, 117, 255, 0].map(|value| band.step(value).unwrap().unwrap());
        assert_eq!(outputs, [128, 128, 128, 129, 127, 245, 10]);
        let mut band = DeadBand::<f32>::new(0.5, 0.0).unwrap();
        let outputs = [0.5_f32, -0.5, 0.75, -0.75].map(|value| band.step(value).unwrap().unwrap());
        assert_eq!(outputs, [0.0, 0.0, 0.25, -0.25]);
    }

    #[test]
    fn extremes_do_not_overflow() {
        let mut band = DeadBand::<i32>::new(2_147_483_647.0, -2_147_483_648.0).unwrap();
        assert_eq!(band.step(i32::MAX), Ok(Some(0)));
        assert_eq!(band.step(i32::MIN), Ok(Some(i32::MIN)));
    }

    #[test]
    fn a_width_is_not_negative() {
        let refused = DeadBand::<i32>::new(-1.0, 0.0).unwrap_err();
        assert_eq!(
            refused.text(),
            "dead_band: width must be a whole number from 0 to 2147483647, not -1"
        );
        assert!(DeadBand::<f32>::new(0.0, f64::INFINITY).is_err());
    }
}
