//! The two kinds of values in a tuple and their wider kind to compute in: `i32` in `i64`, `f32` in `f64`.
//!
//! Owns rounding and saturation. A wide result is exact or rounded once, which is what lets Lua, whose only numbers are
//! `f64`, give the same bits.

use std::ops::{Add, Neg, Sub};

/// A value of a tuple.
pub trait Number: Copy + PartialOrd + Send + 'static {
    /// What it is computed in.
    type Wide: Copy
        + PartialOrd
        + Send
        + Add<Output = Self::Wide>
        + Sub<Output = Self::Wide>
        + Neg<Output = Self::Wide>;
    /// True if parameters of this kind must be whole numbers.
    const WHOLE: bool;
    /// Least value.
    const LEAST: f64;
    /// Greatest value.
    const GREATEST: f64;
    /// Nothing.
    const ZERO: Self;
    /// Largest multiplier or divisor of [`Number::ratio`]: products of integers then fit 52 bits, exact for Lua as well.
    const SPAN_MAX: f64;

    /// Decodes a value; absent if the bytes are not a finite number.
    fn decode(bytes: [u8; 4]) -> Option<Self>;
    /// Encodes a value.
    fn encode(self) -> [u8; 4];
    /// The same value, wider.
    fn wide(self) -> Self::Wide;
    /// The nearest value: integers saturate, floats round to even. Absent if the result is not a finite number.
    fn narrow(wide: Self::Wide) -> Option<Self>;
    /// The same value as a real number.
    fn real(self) -> f64;
    /// The nearest value to a real number: integers round halves away from zero and saturate, floats round to even.
    /// Absent if it is not a finite number, or none of the kind.
    fn from_real(real: f64) -> Option<Self>;
    /// A parameter that [`crate::params::check`] has accepted.
    fn from_param(param: f64) -> Self::Wide;
    /// `value * multiplier / divisor`; integers round to nearest, halves away from zero.
    /// `divisor` is not zero, and the product of integers fits 63 bits.
    fn ratio(value: Self::Wide, multiplier: Self::Wide, divisor: Self::Wide) -> Self::Wide;
    /// `dividend / divisor`; integers drop the fraction as C does. `divisor` is not zero.
    fn quotient(dividend: Self::Wide, divisor: Self::Wide) -> Self::Wide;
}

impl Number for i32 {
    type Wide = i64;
    const WHOLE: bool = true;
    const LEAST: f64 = i32::MIN as f64;
    const GREATEST: f64 = i32::MAX as f64;
    const ZERO: Self = 0;
    const SPAN_MAX: f64 = (1 << 20) as f64;

    fn decode(bytes: [u8; 4]) -> Option<Self> {
        Some(i32::from_le_bytes(bytes))
    }

    fn encode(self) -> [u8; 4] {
        self.to_le_bytes()
    }

    fn wide(self) -> i64 {
        i64::from(self)
    }

    fn narrow(wide: i64) -> Option<Self> {
        Some(wide.clamp(i64::from(i32::MIN), i64::from(i32::MAX)) as i32)
    }

    fn real(self) -> f64 {
        f64::from(self)
    }

    fn from_real(real: f64) -> Option<Self> {
        // The cast saturates. Adding the half first is what Lua does too.
        let nearest = (real.abs() + 0.5).floor().copysign(real) as i32;
        real.is_finite().then_some(nearest)
    }

    fn from_param(param: f64) -> i64 {
        param as i64
    }

    fn ratio(value: i64, multiplier: i64, divisor: i64) -> i64 {
        divide_rounding(value * multiplier, divisor)
    }

    fn quotient(dividend: i64, divisor: i64) -> i64 {
        dividend / divisor
    }
}

impl Number for f32 {
    type Wide = f64;
    const WHOLE: bool = false;
    const LEAST: f64 = f32::MIN as f64;
    const GREATEST: f64 = f32::MAX as f64;
    const ZERO: Self = 0.0;
    const SPAN_MAX: f64 = f64::MAX;

    fn decode(bytes: [u8; 4]) -> Option<Self> {
        Some(f32::from_le_bytes(bytes)).filter(|value| value.is_finite())
    }

    fn encode(self) -> [u8; 4] {
        self.to_le_bytes()
    }

    fn wide(self) -> f64 {
        f64::from(self)
    }

    fn narrow(wide: f64) -> Option<Self> {
        Some(wide as f32).filter(|value| value.is_finite())
    }

    fn real(self) -> f64 {
        f64::from(self)
    }

    fn from_real(real: f64) -> Option<Self> {
        Self::narrow(real)
    }

    fn from_param(param: f64) -> f64 {
        param
    }

    fn ratio(value: f64, multiplier: f64, divisor: f64) -> f64 {
        value * multiplier / divisor
    }

    fn quotient(dividend: f64, divisor: f64) -> f64 {
        dividend / divisor
    }
}

/// `dividend / divisor` rounded to nearest, halves away from zero. `divisor` is not zero.
fn divide_rounding(dividend: i64, divisor: i64) -> i64 {
    let quotient = dividend / divisor;
    let remainder = dividend % divisor;
    if remainder.unsigned_abs() >= divisor.unsigned_abs().div_ceil(2) {
        quotient
            + if (dividend < 0) == (divisor < 0) {
                1
            } else {
                -1
            }
    } else {
        quotient
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotients_round_to_nearest_and_halves_away_from_zero() {
        // 7/2 = 3.5, 5/3 = 1.67, 4/3 = 1.33, 1/2 = 0.5, 2/5 = 0.4; signs as in school.
        let cases = [
            (7, 2, 4),
            (5, 3, 2),
            (4, 3, 1),
            (1, 2, 1),
            (2, 5, 0),
            (6, 3, 2),
            (0, 9, 0),
            (3, 7, 0),
            (4, 7, 1),
        ];
        for (dividend, divisor, result) in cases {
            assert_eq!(divide_rounding(dividend, divisor), result);
            assert_eq!(divide_rounding(-dividend, divisor), -result);
            assert_eq!(divide_rounding(dividend, -divisor), -result);
            assert_eq!(divide_rounding(-dividend, -divisor), result);
        }
        assert_eq!(divide_rounding(i64::MAX, 1), i64::MAX);
    }

    #[test]
    fn integers_saturate_and_floats_are_finite_or_absent() {
        assert_eq!(i32::narrow(1 << 40), Some(i32::MAX));
        assert_eq!(i32::narrow(-(1 << 40)), Some(i32::MIN));
        assert_eq!(i32::from_real(-2.5), Some(-3));
        assert_eq!(i32::from_real(1e10), Some(i32::MAX));
        assert_eq!(i32::from_real(-1e300), Some(i32::MIN));
        assert_eq!(i32::from_real(f64::NAN), None);
        assert_eq!(i32::from_real(f64::INFINITY), None);
        assert_eq!(f32::from_real(0.5), Some(0.5));
        assert_eq!(f32::narrow(1e39), None);
        assert_eq!(f32::narrow(f64::NAN), None);
        assert_eq!(f32::narrow(0.1), Some(0.1_f32));
        assert_eq!(f32::decode(f32::INFINITY.to_le_bytes()), None);
        assert_eq!(f32::decode(f32::NAN.to_le_bytes()), None);
        assert_eq!(f32::decode((-0.0_f32).to_le_bytes()), Some(-0.0));
    }
}
