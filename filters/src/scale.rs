//! Linear scale through two points, clamped: y = y0 + (x - x0) (y1 - y0) / (x1 - x0), then min <= y <= max.
//!
//! The two-point form of a straight line (Bronshtein and others, Handbook of Mathematics, analytic geometry of the plane).
//! It is also how TRIK's runtime describes its linear analog sensors, though that one drops fractions.
//! Integers: exact, then rounded to nearest, halves away from zero; results outside the integers are clamped anyway.
//! Cost: one 64-bit multiplication and one 64-bit division; for floats the same in f64.

use crate::lanes::{Filter, overflow};
use crate::number::Number;
use crate::params::{Named, check, check_value};
use converter::{Fault, OpenInfo};
use std::ffi::CStr;

/// The parameters of a scale. The default is the identity, clamped to what the kind of value can hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Input of the first point.
    pub x0: f64,
    /// Output of the first point.
    pub y0: f64,
    /// Input of the second point.
    pub x1: f64,
    /// Output of the second point.
    pub y1: f64,
    /// Least output.
    pub min: f64,
    /// Greatest output.
    pub max: f64,
}

impl Line {
    /// The line y = x for values of a kind.
    pub fn identity<V: Number>() -> Self {
        Self {
            x0: 0.0,
            y0: 0.0,
            x1: 1.0,
            y1: 1.0,
            min: V::LEAST,
            max: V::GREATEST,
        }
    }
}

/// A linear scale. It has no memory.
#[derive(Clone, Copy, Debug)]
pub struct Scale<V: Number> {
    x0: V::Wide,
    y0: V::Wide,
    /// x1 - x0.
    run: V::Wide,
    /// y1 - y0.
    rise: V::Wide,
    min: V::Wide,
    max: V::Wide,
}

impl<V: Number> Scale<V> {
    /// A scale along this line.
    ///
    /// # Errors
    /// A coordinate that is no value of the kind, two points with one x, for integers points further apart than
    /// 2^20 in x or y, or a `min` above `max`.
    pub fn new(line: Line) -> Result<Self, Fault> {
        let named = |param| Named {
            filter: Self::NAME,
            param,
        };
        let coordinates = [
            ("x0", line.x0),
            ("y0", line.y0),
            ("x1", line.x1),
            ("y1", line.y1),
            ("min", line.min),
            ("max", line.max),
        ];
        for (param, value) in coordinates {
            check_value::<V>(named(param), value)?;
        }
        let span = |param, value| check::<V>(named(param), value, -V::SPAN_MAX..=V::SPAN_MAX);
        let run = span("x1 - x0", line.x1 - line.x0)?;
        let rise = span("y1 - y0", line.y1 - line.y0)?;
        if line.x0 == line.x1 {
            return Err(Fault::new("scale: x0 and x1 must differ"));
        }
        if line.min > line.max {
            return Err(Fault::new("scale: min must not be above max"));
        }
        Ok(Self {
            x0: V::from_param(line.x0),
            y0: V::from_param(line.y0),
            run,
            rise,
            min: V::from_param(line.min),
            max: V::from_param(line.max),
        })
    }
}

impl<V: Number> Filter for Scale<V> {
    type Value = V;
    const NAME: &'static str = "scale";
    const DESCRIPTION: &'static CStr =
        c"straight line through (x0, y0) and (x1, y1), clamped to `min` and `max`";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let default = Line::identity::<V>();
        let param = |name, default| info.param(name).unwrap_or(default);
        Self::new(Line {
            x0: param("x0", default.x0),
            y0: param("y0", default.y0),
            x1: param("x1", default.x1),
            y1: param("y1", default.y1),
            min: param("min", default.min),
            max: param("max", default.max),
        })
    }

    fn step(&mut self, value: V) -> Result<Option<V>, Fault> {
        let result = V::ratio(value.wide() - self.x0, self.rise, self.run) + self.y0;
        let clamped = if result < self.min {
            self.min
        } else if result > self.max {
            self.max
        } else {
            result
        };
        V::narrow(clamped).map(Some).ok_or_else(overflow)
    }

    fn reset(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::*;

    fn run<V: Number>(line: Line, values: &[V]) -> Vec<V> {
        let mut scale = Scale::new(line).unwrap();
        values
            .iter()
            .map(|value| scale.step(*value).unwrap().unwrap())
            .collect()
    }

    fn line<V: Number>(x0: f64, y0: f64, x1: f64, y1: f64) -> Line {
        let whole = Line::identity::<V>();
        Line {
            x0,
            y0,
            x1,
            y1,
            ..whole
        }
    }

    #[test]
    fn a_light_sensor_reads_in_percent() {
        // By hand, TRIK's light sensor, raw 30 is 0 and raw 1023 is 100:
        // (0-30)*100/993 = -3.02, (526-30)*100/993 = 49.95, 99300/993 = 100.
        let light = line::<i32>(30.0, 0.0, 1023.0, 100.0);
        assert_eq!(run(light, &[30, 1023, 0, 526]), [0, 100, -3, 50]);
        let clamped = Line {
            min: 0.0,
            max: 100.0,
            ..light
        };
        assert_eq!(run(clamped, &[0, 2000, 526]), [0, 100, 50]);
    }

    #[test]
    fn a_line_may_fall_and_halves_round_away_from_zero() {
        assert_eq!(
            run(line::<i32>(0.0, 10.0, 2.0, 9.0), &[0, 1, 2, -1]),
            [10, 9, 9, 11]
        );
        assert_eq!(
            run(line::<f32>(0.0, 10.0, 2.0, 9.0), &[0.0_f32, 1.0, -1.0]),
            [10.0, 9.5, 10.5]
        );
    }

    #[test]
    fn integers_saturate_and_floats_that_leave_their_range_are_clamped() {
        let steep = line::<i32>(0.0, 0.0, 1.0, 1_048_576.0);
        assert_eq!(
            run(steep, &[i32::MAX, i32::MIN, 2]),
            [i32::MAX, i32::MIN, 2_097_152]
        );
        assert_eq!(
            run(line::<f32>(0.0, 0.0, 1.0, 1e10), &[1e30_f32]),
            [f32::MAX]
        );
    }

    #[test]
    fn lines_that_are_none_are_refused() {
        let refused = |line| Scale::<i32>::new(line).unwrap_err().to_string();
        assert_eq!(
            refused(line::<i32>(5.0, 0.0, 5.0, 1.0)),
            "scale: x0 and x1 must differ"
        );
        assert_eq!(
            refused(line::<i32>(0.0, 0.0, 2e6, 1.0)),
            "scale: x1 - x0 must be a whole number from -1048576 to 1048576, not 2000000"
        );
        assert_eq!(
            refused(line::<i32>(0.0, 0.5, 1.0, 1.0)),
            "scale: y0 must be a whole number from -2147483648 to 2147483647, not 0.5"
        );
        let upside_down = Line {
            min: 1.0,
            max: 0.0,
            ..Line::identity::<i32>()
        };
        assert_eq!(refused(upside_down), "scale: min must not be above max");
        assert!(Scale::<f32>::new(line::<f32>(0.0, f64::NAN, 1.0, 1.0)).is_err());
        assert!(Scale::<f32>::new(line::<f32>(0.0, 0.0, 1e38, 1e38)).is_ok());
    }
}
