//! Units: what they measure, and how large they are.
//!
//! Owns the words of units and how they are multiplied. Quantities are those of the SI; angles are numbers, and a radian
//! is 1.

use crate::limits;
use std::fmt::Write;

/// What a value measures, and in what size. Powers are counted in quarters, so that roots are exact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    powers: [i16; 7],
    /// How many units of the SI one of these is.
    pub scale: f64,
}

/// How a power of 1 is counted.
const WHOLE: i16 = 4;

/// Base units in the order of powers.
const BASES: [&str; 7] = ["m", "kg", "s", "A", "K", "mol", "cd"];

/// Names, powers of m, kg, s, A, and size.
const NAMED: [(&str, [i16; 4], f64); 29] = [
    ("1", [0, 0, 0, 0], 1.0),
    ("rad", [0, 0, 0, 0], 1.0),
    ("sr", [0, 0, 0, 0], 1.0),
    ("deg", [0, 0, 0, 0], std::f64::consts::PI / 180.0),
    ("rev", [0, 0, 0, 0], std::f64::consts::TAU),
    ("m", [1, 0, 0, 0], 1.0),
    ("g", [0, 1, 0, 0], 1e-3),
    ("s", [0, 0, 1, 0], 1.0),
    ("min", [0, 0, 1, 0], 60.0),
    ("h", [0, 0, 1, 0], 3600.0),
    ("A", [0, 0, 0, 1], 1.0),
    ("Hz", [0, 0, -1, 0], 1.0),
    ("rpm", [0, 0, -1, 0], std::f64::consts::TAU / 60.0),
    ("N", [1, 1, -2, 0], 1.0),
    ("Nm", [2, 1, -2, 0], 1.0),
    ("J", [2, 1, -2, 0], 1.0),
    ("W", [2, 1, -3, 0], 1.0),
    ("Wh", [2, 1, -2, 0], 3600.0),
    ("Pa", [-1, 1, -2, 0], 1.0),
    ("bar", [-1, 1, -2, 0], 1e5),
    ("C", [0, 0, 1, 1], 1.0),
    ("V", [2, 1, -3, -1], 1.0),
    ("Ohm", [2, 1, -3, -2], 1.0),
    ("F", [-2, -1, 4, 2], 1.0),
    ("H", [2, 1, -2, -2], 1.0),
    ("Wb", [2, 1, -2, -1], 1.0),
    ("T", [0, 1, -2, -1], 1.0),
    ("L", [3, 0, 0, 0], 1e-3),
    ("t", [0, 1, 0, 0], 1e3),
];

/// Names that have no prefix, because it would be another unit or is not used.
const WITHOUT_PREFIX: [&str; 8] = ["1", "deg", "rev", "min", "h", "rpm", "t", "sr"];

/// Prefixes of the SI that models use.
const PREFIXES: [(&str, f64); 11] = [
    ("p", 1e-12),
    ("n", 1e-9),
    ("u", 1e-6),
    ("m", 1e-3),
    ("c", 1e-2),
    ("d", 1e-1),
    ("h", 1e2),
    ("k", 1e3),
    ("M", 1e6),
    ("G", 1e9),
    ("T", 1e12),
];

impl Unit {
    /// A number.
    pub const ONE: Self = Self {
        powers: [0; 7],
        scale: 1.0,
    };
    /// The unit of time.
    pub const SECOND: Self = Self {
        powers: [0, 0, WHOLE, 0, 0, 0, 0],
        scale: 1.0,
    };

    /// Reads a unit: names with powers `m^2`, joined by `*`, `.` and `/`, to the left; parentheses group. Else why it is
    /// none.
    pub fn read(text: &str) -> Result<Self, NoUnit> {
        let mut reader = Reader {
            rest: text.trim(),
            depth: 0,
        };
        let unit = reader.product()?;
        if reader.rest.is_empty() {
            Ok(unit)
        } else {
            Err(NoUnit::Rest(reader.rest.to_owned()))
        }
    }

    /// Whether both measure the same, in whatever size.
    pub fn is_like(self, other: Self) -> bool {
        self.powers == other.powers
    }

    /// Whether both are of one size, except for rounding.
    pub fn is_as_large(self, other: Self) -> bool {
        (self.scale / other.scale - 1.0).abs() < 1e-9
    }

    /// Both multiplied; nothing if powers become too high.
    pub fn times(self, other: Self) -> Option<Self> {
        self.joined(other, 1)
    }

    /// One divided by the other; nothing if powers become too high.
    pub fn over(self, other: Self) -> Option<Self> {
        self.joined(other, -1)
    }

    fn joined(self, other: Self, sign: i16) -> Option<Self> {
        let mut powers = self.powers;
        for (one, more) in powers.iter_mut().zip(other.powers) {
            *one += more * sign;
        }
        let scale = if sign > 0 {
            self.scale * other.scale
        } else {
            self.scale / other.scale
        };
        Self { powers, scale }.sane()
    }

    /// To a power; nothing if that is none of whole quarters, or too high.
    pub fn power(self, exponent: f64) -> Option<Self> {
        let mut powers = self.powers;
        for one in &mut powers {
            let exact = f64::from(*one) * exponent;
            if exact.fract() != 0.0 || exact.abs() > f64::from(limits::DCML_UNIT_POWER * WHOLE) {
                return None;
            }
            // A whole number in range.
            *one = exact as i16;
        }
        let scale = libm::pow(self.scale, exponent);
        Self { powers, scale }.sane()
    }

    fn sane(self) -> Option<Self> {
        let is_low = self
            .powers
            .iter()
            .all(|one| one.abs() <= limits::DCML_UNIT_POWER * WHOLE);
        (is_low && self.scale.is_normal()).then_some(self)
    }

    /// A unit of one name, with its prefix.
    fn named(name: &str) -> Option<Self> {
        let base = |name: &str| {
            if let Some((_, powers, scale)) = NAMED.iter().find(|(one, ..)| *one == name) {
                let mut all = [0; 7];
                for (to, from) in all.iter_mut().zip(powers) {
                    *to = from * WHOLE;
                }
                return Some(Self {
                    powers: all,
                    scale: *scale,
                });
            }
            let at = BASES.iter().position(|one| *one == name)?;
            let mut powers = [0; 7];
            powers[at] = WHOLE;
            Some(Self { powers, scale: 1.0 })
        };
        if let Some(unit) = base(name) {
            return Some(unit);
        }
        PREFIXES.iter().find_map(|(prefix, factor)| {
            let rest = name.strip_prefix(prefix)?;
            if WITHOUT_PREFIX.contains(&rest) || rest == "kg" {
                return None;
            }
            let mut unit = base(rest)?;
            unit.scale *= factor;
            Some(unit)
        })
    }

    /// All names without prefixes, for the documentation.
    pub fn names() -> impl Iterator<Item = &'static str> {
        let named = NAMED.iter().map(|(name, ..)| *name);
        named.chain(
            BASES
                .into_iter()
                .filter(|one| NAMED.iter().all(|(name, ..)| name != one)),
        )
    }
}

/// In base units, with the size in front of it: `0.01 m/s`.
impl std::fmt::Display for Unit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let part = |sign: i16| {
            let mut text = String::new();
            for (base, power) in BASES
                .iter()
                .zip(self.powers)
                .filter(|(_, power)| power * sign > 0)
            {
                let power = f64::from(power * sign) / f64::from(WHOLE);
                if !text.is_empty() {
                    text.push('*');
                }
                text.push_str(base);
                if power != 1.0 {
                    let _ = write!(text, "^{power}");
                }
            }
            text
        };
        let (above, below) = (part(1), part(-1));
        let size = if (self.scale - 1.0).abs() < 1e-9 {
            String::new()
        } else {
            // As many digits as tell sizes from each other.
            let digits: f64 = format!("{:.4e}", self.scale).parse().unwrap_or(self.scale);
            format!("{digits} ")
        };
        let above = if above.is_empty() {
            "1".to_owned()
        } else {
            above
        };
        match below {
            below if below.is_empty() && above == "1" && !size.is_empty() => {
                write!(f, "{}", size.trim_end())
            }
            below if below.is_empty() => write!(f, "{size}{above}"),
            below if below.contains('*') => write!(f, "{size}{above}/({below})"),
            below => write!(f, "{size}{above}/{below}"),
        }
    }
}

/// Why a text is no unit.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum NoUnit {
    /// What is left after a unit.
    Rest(String),
    /// A name that no unit has.
    Unknown(String),
    /// A name is missing.
    Missing,
    /// A power that is no whole number.
    Power,
    /// Powers beyond all that is measured.
    TooHigh,
    /// A parenthesis that is not closed.
    Open,
    /// Parentheses in parentheses without end.
    TooDeep,
}

impl std::fmt::Display for NoUnit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let shown = super::parser::shown;
        match self {
            Self::Rest(rest) => write!(f, "`{}` is not understood", shown(rest)),
            Self::Unknown(name) => write!(f, "there is no unit `{}`", shown(name)),
            Self::Missing => f.write_str("a name of a unit is missing"),
            Self::Power => f.write_str("a power is a whole number: `m^2`"),
            Self::TooHigh => f.write_str("its powers are too high"),
            Self::Open => f.write_str("a parenthesis is not closed"),
            Self::TooDeep => f.write_str("it nests too deep"),
        }
    }
}

impl std::error::Error for NoUnit {}

struct Reader<'a> {
    rest: &'a str,
    depth: u8,
}

impl<'a> Reader<'a> {
    fn take(&mut self, sign: char) -> bool {
        self.rest = self.rest.trim_start();
        match self.rest.strip_prefix(sign) {
            Some(rest) => {
                self.rest = rest.trim_start();
                true
            }
            None => false,
        }
    }

    fn product(&mut self) -> Result<Unit, NoUnit> {
        let mut unit = self.factor()?;
        loop {
            unit = if self.take('*') || self.take('.') {
                unit.times(self.factor()?).ok_or(NoUnit::TooHigh)?
            } else if self.take('/') {
                unit.over(self.factor()?).ok_or(NoUnit::TooHigh)?
            } else {
                return Ok(unit);
            };
        }
    }

    fn factor(&mut self) -> Result<Unit, NoUnit> {
        let unit = if self.take('(') {
            self.depth += 1;
            if self.depth > 16 {
                return Err(NoUnit::TooDeep);
            }
            let inside = self.product()?;
            self.depth -= 1;
            if !self.take(')') {
                return Err(NoUnit::Open);
            }
            inside
        } else {
            let name = self.word(|sign| sign.is_alphanumeric());
            if name.is_empty() {
                return Err(NoUnit::Missing);
            }
            Unit::named(name).ok_or_else(|| NoUnit::Unknown(name.to_owned()))?
        };
        if !self.take('^') {
            return Ok(unit);
        }
        let is_negative = self.take('-');
        let digits = self.word(|sign| sign.is_ascii_digit());
        let power: i8 = digits.parse().map_err(|_| NoUnit::Power)?;
        let power = if is_negative { -power } else { power };
        unit.power(f64::from(power)).ok_or(NoUnit::TooHigh)
    }

    fn word(&mut self, is_of: impl Fn(char) -> bool) -> &'a str {
        let end = self
            .rest
            .find(|sign| !is_of(sign))
            .unwrap_or(self.rest.len());
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest.trim_start();
        word
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Unit {
        Unit::read(text).unwrap_or_else(|why| panic!("{text}: {why}"))
    }

    #[test]
    fn units_that_are_the_same_are_known_to_be() {
        for (one, other) in [
            ("N", "kg*m/s^2"),
            ("Nm", "N.m"),
            ("J", "W*s"),
            ("V", "W/A"),
            ("V", "A*Ohm"),
            ("1/s", "Hz"),
            ("rad", "1"),
            ("m/s/s", "m/(s*s)"),
            ("kg", "1 * kg"),
            ("s^-2", "1/s^2"),
        ] {
            assert!(
                read(one).is_like(read(other)) && read(one).is_as_large(read(other)),
                "{one} {other}"
            );
        }
        assert!(!read("m").is_like(read("s")));
    }

    #[test]
    fn prefixes_change_the_size_alone() {
        for (unit, size) in [
            ("cm", 0.01),
            ("mm", 1e-3),
            ("ms", 1e-3),
            ("g", 1e-3),
            ("km/h", 1.0 / 3.6),
            ("mN", 1e-3),
            ("min", 60.0),
            ("mm^2", 1e-6),
        ] {
            assert!((read(unit).scale / size - 1.0).abs() < 1e-12, "{unit}");
        }
        assert!((read("deg").scale - 1f64.to_radians()).abs() < 1e-15);
        assert!(read("mN").is_like(read("N")) && !read("mN").is_as_large(read("N")));
    }

    #[test]
    fn what_is_no_unit_says_why() {
        for text in [
            "",
            "furlong",
            "m^",
            "m^x",
            "m^99",
            "m//s",
            "(m",
            "m)",
            "kkg",
            "m s",
            "m^127^127",
            "\u{b5}m",
        ] {
            assert!(Unit::read(text).is_err(), "{text}");
        }
        assert!(Unit::read(&"(".repeat(1000)).is_err());
        assert!(Unit::read(&"m^25*".repeat(1000)).is_err());
    }

    #[test]
    fn a_unit_is_shown_in_base_units() {
        assert_eq!(read("Nm").to_string(), "m^2*kg/s^2");
        assert_eq!(read("cm/s").to_string(), "0.01 m/s");
        assert_eq!(read("deg").to_string(), "0.017453");
        assert_eq!(read("V").to_string(), "m^2*kg/(s^3*A)");
        assert_eq!(read("m").power(0.5).unwrap().to_string(), "m^0.5");
    }
}
