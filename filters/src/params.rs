//! The one check of a filter's parameter and the text of its refusal.

use crate::number::Number;
use converter::{Fault, OpenInfo};
use std::fmt;
use std::ops::RangeInclusive;

/// Which parameter of which filter, for messages.
#[derive(Clone, Copy, Debug)]
pub struct Named {
    /// Name of the filter without the suffix of the variant.
    pub filter: &'static str,
    /// Name of the parameter.
    pub param: &'static str,
}

impl fmt::Display for Named {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.filter, self.param)
    }
}

/// Checks a parameter of a filter over `V`.
///
/// # Errors
/// A value outside the range, NaN, and for integers a value that is not whole.
pub fn check<V: Number>(
    named: Named,
    value: f64,
    range: RangeInclusive<f64>,
) -> Result<V::Wide, Fault> {
    if range.contains(&value) && !(V::WHOLE && value.fract() != 0.0) {
        return Ok(V::from_param(value));
    }
    let kind = if V::WHOLE {
        "a whole number from"
    } else {
        "from"
    };
    Err(Fault::new(format!(
        "{named} must be {kind} {} to {}, not {value}",
        range.start(),
        range.end()
    )))
}

/// Checks a parameter that is any value of the tuple's kind.
///
/// # Errors
/// As [`check`].
pub fn check_value<V: Number>(named: Named, value: f64) -> Result<V::Wide, Fault> {
    check::<V>(named, value, V::LEAST..=V::GREATEST)
}

/// The parameters of one opening, for filters whose parameters are all real numbers.
#[derive(Clone, Copy)]
pub struct Params<'a> {
    filter: &'static str,
    info: &'a OpenInfo<'a>,
}

impl<'a> Params<'a> {
    /// The parameters that a node gives to a filter.
    pub fn new(filter: &'static str, info: &'a OpenInfo<'a>) -> Self {
        Self { filter, info }
    }

    /// A number within a range; `default` when the configuration does not say.
    ///
    /// # Errors
    /// As [`check`].
    pub fn real(
        self,
        param: &'static str,
        default: f64,
        range: RangeInclusive<f64>,
    ) -> Result<f64, Fault> {
        let value = self.info.param(param).unwrap_or(default);
        check::<f32>(self.named(param), value, range)
    }

    /// A whole number within a range; `default` when the configuration does not say.
    ///
    /// # Errors
    /// As [`check`].
    pub fn whole(
        self,
        param: &'static str,
        default: f64,
        range: RangeInclusive<f64>,
    ) -> Result<f64, Fault> {
        let value = self.info.param(param).unwrap_or(default);
        check::<i32>(self.named(param), value, range).map(|whole| whole as f64)
    }

    /// A number that the configuration must give, because any default would be a guess.
    ///
    /// # Errors
    /// As [`check`], and a parameter that is missing.
    pub fn required(self, param: &'static str, range: RangeInclusive<f64>) -> Result<f64, Fault> {
        let named = self.named(param);
        match self.info.param(param) {
            Some(value) => check::<f32>(named, value, range),
            None => Err(Fault::new(format!("{named} is missing"))),
        }
    }

    /// The lower and the upper bound of a result: `min` and `max`.
    ///
    /// # Errors
    /// As [`check`], and a `min` above `max`.
    pub fn bounds(self, min: f64, max: f64, limit: f64) -> Result<(f64, f64), Fault> {
        let min = self.real("min", min, -limit..=limit)?;
        let max = self.real("max", max, -limit..=limit)?;
        if min > max {
            let text = format!("{}: min must not be above max", self.filter);
            return Err(Fault::new(text));
        }
        Ok((min, max))
    }

    fn named(self, param: &'static str) -> Named {
        Named {
            filter: self.filter,
            param,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NAMED: Named = Named {
        filter: "scale",
        param: "x1",
    };

    #[test]
    fn a_parameter_is_a_number_within_its_range() {
        assert_eq!(check::<i32>(NAMED, 3.0, 0.0..=3.0), Ok(3));
        assert_eq!(check::<f32>(NAMED, 2.5, 0.0..=3.0), Ok(2.5));
        let text = |result: Result<i64, Fault>| result.unwrap_err().to_string();
        assert_eq!(
            text(check::<i32>(NAMED, 2.5, 0.0..=3.0)),
            "scale: x1 must be a whole number from 0 to 3, not 2.5"
        );
        assert_eq!(
            text(check::<i32>(NAMED, 4.0, 0.0..=3.0)),
            "scale: x1 must be a whole number from 0 to 3, not 4"
        );
        let refused = check::<f32>(NAMED, f64::NAN, 0.0..=3.0).unwrap_err();
        assert_eq!(refused.text(), "scale: x1 must be from 0 to 3, not NaN");
        assert!(check_value::<i32>(NAMED, 2_147_483_648.0).is_err());
        assert!(check_value::<f32>(NAMED, f64::INFINITY).is_err());
        assert!(check_value::<f32>(NAMED, 3.5e38).is_err());
    }
}
