//! What is said of the words of the language itself, and how they are put in.
//!
//! Owns these texts; nothing of a document.

use lang_dcml::function::Function;
use lang_dcml::lexer::Keyword;
use lang_dcml::syntax::Kind;

/// What a function takes, by names.
pub(super) const fn parameters(function: Function) -> &'static [&'static str] {
    match function {
        Function::Atan2 => &["y", "x"],
        _ if function.arguments() == 2 => &["x", "y"],
        _ => &["x"],
    }
}

/// A function with the names of what it takes.
pub(super) fn signature(function: Function) -> String {
    format!("{}({})", function.name(), parameters(function).join(", "))
}

/// What a function gives.
pub(super) const fn function(function: Function) -> &'static str {
    match function {
        Function::Sin => "The sine of an angle in radians.",
        Function::Cos => "The cosine of an angle in radians.",
        Function::Tan => "The tangent of an angle in radians.",
        Function::Asin => {
            "The angle from -pi/2 to pi/2 whose sine is x; not a number where |x| > 1."
        }
        Function::Acos => "The angle from 0 to pi whose cosine is x; not a number where |x| > 1.",
        Function::Atan => "The angle between -pi/2 and pi/2 whose tangent is x.",
        Function::Atan2 => {
            "The direction of the point (x, y): an angle from -pi to pi. The second argument is the way ahead."
        }
        Function::Sqrt => "The square root; not a number where x < 0.",
        Function::Exp => "e to the power of x.",
        Function::Log => "The natural logarithm; not a number where x < 0.",
        Function::Abs => "The number without its sign.",
        Function::Pow => "x to the power of y.",
        Function::Min => "The smaller one of two numbers.",
        Function::Max => "The larger one of two numbers.",
        Function::Sign => "-1, 0 or 1: the sign of x.",
        Function::Floor => "The largest whole number that is not larger than x.",
    }
}

/// How `piecewise` is called.
pub(super) const PIECEWISE: &str = "piecewise(condition, value, ..., otherwise)";
/// What it gives.
pub(super) const PIECEWISE_MEANS: &str = "The value after the first condition that holds, or else the last one. A condition compares two values with `<`, `<=`, `>` or `>=`. An extension of the language.";
/// What `d(x)` is.
pub(super) const DERIVATIVE: &str = "How fast a part of the configuration changes: its derivative with respect to time. What has such an equation is a state.";
/// What `S1` is.
pub(super) const CIRCLE: &str =
    "An angle that wraps at a whole turn, into (-pi, pi]. An extension of the language.";
/// What `in` is.
pub(super) const DOMAIN: &str = "Where a value may be: `in S1` for an angle that wraps, `in -2 .. 2` for bounds. An extension of the language.";
/// What a unit is.
pub(super) const UNIT: &str = "A part of a unit: products with `*` or `.`, quotients with `/`, powers with `^`. An extension of the language.";

/// What a reserved word opens or closes.
pub(super) const fn keyword(keyword: Keyword) -> &'static str {
    match keyword {
        Keyword::Begin => "Begins a model: `BEGIN Name ... END;`",
        Keyword::End => "Ends a model: `END;`",
        Keyword::Package => "Where generated code belongs: `PACKAGE: robotics.models;`",
        Keyword::Section(kind) => section(kind),
    }
}

/// What a section declares.
pub(super) const fn section(kind: Kind) -> &'static str {
    match kind {
        Kind::Action => {
            "Declares the inputs, which a driver or a planner chooses: `ACTION: v, omega;`"
        }
        Kind::Param => {
            "Declares numbers that are fixed for one robot and given with it: `PARAM: wheelbase;`"
        }
        Kind::Const => "Declares numbers with names: `CONST: g = 9.81;`",
        Kind::Config => {
            "Declares the configuration. Each part has one equation: `d(x) = ...` makes it a state, `x = ...` an output."
        }
        Kind::Var => "Declares names for intermediate values; each has one equation.",
    }
}

/// What a name of this kind is, in a few words.
pub(super) const fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Action => "action",
        Kind::Param => "parameter",
        Kind::Const => "constant",
        Kind::Config => "configuration",
        Kind::Var => "variable",
    }
}

/// Names of the language with their values.
pub(super) const NUMBERS: [(&str, f64, &str); 2] = [
    ("pi", std::f64::consts::PI, "Half a turn in radians."),
    (
        "e",
        std::f64::consts::E,
        "The base of the natural logarithm.",
    ),
];

/// Units that are offered; the checker knows more.
pub(super) const UNITS: [&str; 12] = [
    "m", "cm", "mm", "s", "rad", "deg", "m/s", "rad/s", "m/s^2", "kg", "N", "1",
];

/// A model to begin with: label, what it is, text with places to fill in.
pub(super) const MODELS: [(&str, &str, &str); 2] = [
    (
        "BEGIN model",
        "A model with its sections",
        "BEGIN ${1:Name}\nACTION: ${2:v, omega};\nCONFIG: ${3:x, y, theta};\nd(x) = ${4:v * cos(theta)};\nd(y) = ${5:v * sin(theta)};\nd(theta) = ${6:omega};\nEND;\n$0",
    ),
    (
        "BEGIN differential drive",
        "A robot with two driven wheels",
        "/**\n * ${1:A robot with two driven wheels.}\n */\nBEGIN ${2:DifferentialDrive}\nACTION: u_l, u_r;\nPARAM: L, r;\nCONFIG: x, y, theta;\nd(x) = r / 2 * (u_l + u_r) * cos(theta);\nd(y) = r / 2 * (u_l + u_r) * sin(theta);\nd(theta) = (r / L) * (u_r - u_l);\nEND;\n$0",
    ),
];
