//! The functions of the language: one row for each.
//!
//! Owns their names, how many arguments they take and what they give. How another language calls them is known to its
//! generator, and their derivatives to `jacobian`.

/// A function of one or two numbers.
#[derive(Clone, Copy, Debug, Eq, PartialEq, Hash, Ord, PartialOrd)]
pub enum Function {
    /// `sin(x)`, x in radians, as all angles here.
    Sin,
    /// `cos(x)`
    Cos,
    /// `tan(x)`
    Tan,
    /// `asin(x)`
    Asin,
    /// `acos(x)`
    Acos,
    /// `atan(x)`
    Atan,
    /// `atan2(y, x)`
    Atan2,
    /// `sqrt(x)`
    Sqrt,
    /// `exp(x)`
    Exp,
    /// `log(x)`, natural.
    Log,
    /// `abs(x)`
    Abs,
    /// `pow(x, y)`
    Pow,
    /// `min(x, y)`; the other one where one is not a number.
    Min,
    /// `max(x, y)`; the other one where one is not a number.
    Max,
    /// `sign(x)`: -1, 0 or 1; not a number for what is none.
    Sign,
    /// `floor(x)`
    Floor,
}

impl Function {
    /// All, in the order of the documentation.
    pub const ALL: [Self; 16] = [
        Self::Sin,
        Self::Cos,
        Self::Tan,
        Self::Asin,
        Self::Acos,
        Self::Atan,
        Self::Atan2,
        Self::Sqrt,
        Self::Exp,
        Self::Log,
        Self::Abs,
        Self::Pow,
        Self::Min,
        Self::Max,
        Self::Sign,
        Self::Floor,
    ];

    /// The function of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.name() == name)
    }

    /// Its name in the language.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sin => "sin",
            Self::Cos => "cos",
            Self::Tan => "tan",
            Self::Asin => "asin",
            Self::Acos => "acos",
            Self::Atan => "atan",
            Self::Atan2 => "atan2",
            Self::Sqrt => "sqrt",
            Self::Exp => "exp",
            Self::Log => "log",
            Self::Abs => "abs",
            Self::Pow => "pow",
            Self::Min => "min",
            Self::Max => "max",
            Self::Sign => "sign",
            Self::Floor => "floor",
        }
    }

    /// How many arguments it takes: one or two.
    pub const fn arguments(self) -> usize {
        match self {
            Self::Atan2 | Self::Pow | Self::Min | Self::Max => 2,
            _ => 1,
        }
    }

    /// Its value; `y` is not looked at by functions of one argument.
    pub fn apply(self, x: f64, y: f64) -> f64 {
        match self {
            Self::Sin => libm::sin(x),
            Self::Cos => libm::cos(x),
            Self::Tan => libm::tan(x),
            Self::Asin => libm::asin(x),
            Self::Acos => libm::acos(x),
            Self::Atan => libm::atan(x),
            Self::Atan2 => libm::atan2(x, y),
            Self::Sqrt => x.sqrt(),
            Self::Exp => libm::exp(x),
            Self::Log => libm::log(x),
            Self::Abs => x.abs(),
            Self::Pow => libm::pow(x, y),
            Self::Min => x.min(y),
            Self::Max => x.max(y),
            Self::Sign if x > 0.0 => 1.0,
            Self::Sign if x < 0.0 => -1.0,
            // Zero of either sign, and what is no number.
            Self::Sign => x + 0.0,
            Self::Floor => x.floor(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_again_and_no_two_are_the_same() {
        for function in Function::ALL {
            assert_eq!(Function::named(function.name()), Some(function));
        }
        assert_eq!(Function::named("sinh"), None);
    }

    #[test]
    fn the_second_argument_of_an_arc_tangent_is_the_way_ahead() {
        assert_eq!(Function::Atan2.apply(1.0, 0.0), std::f64::consts::FRAC_PI_2);
        assert_eq!(Function::Sign.apply(-0.0, 0.0), 0.0);
        assert!(Function::Sign.apply(f64::NAN, 0.0).is_nan());
    }
}
