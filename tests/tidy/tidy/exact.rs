//! Numbers that are the same on every machine: in a browser, on a PC and on the controller.
//!
//! Owns the list of crates that promise it, and of the functions whose last bits each system's library chooses by itself.
//! IEEE 754 fixes those of `+ - * /`, `sqrt` and of rounding, so these are free; for the others there is the crate `libm`.

use super::{Source, none, sources};

/// What the package for browsers is made of.
const EXACT: [&str; 12] = [
    "lang/constraint",
    "lang/dataflow",
    "lang/dcml",
    "lang/diagram",
    "lang/expr",
    "lang/plan",
    "lang/text",
    "screen",
    "sim",
    "studio",
    "web",
    "web/dcml",
];
/// Functions of `f64` and `f32`.
const INEXACT: [&str; 25] = [
    "acos", "acosh", "asin", "asinh", "atan", "atan2", "atanh", "cbrt", "cos", "cosh", "exp",
    "exp2", "exp_m1", "hypot", "ln", "ln_1p", "log", "log10", "log2", "powf", "sin", "sin_cos",
    "sinh", "tan", "tanh",
];

/// The function of the standard library that a line calls or names, if its last bits are not fixed.
fn inexact(line: &str) -> Option<&'static str> {
    INEXACT.into_iter().find(|name| {
        let called = format!(".{name}(");
        let named = ["f64", "f32"].map(|of| format!("{of}::{name}"));
        let is_named = |path: &String| {
            let after = line.split(path.as_str()).nth(1);
            after.is_some_and(|rest| {
                !rest.starts_with(|c: char| c.is_ascii_alphanumeric() || c == '_')
            })
        };
        // A call without an argument of this name on something else is none of them: `log()` of a journal.
        let is_other = *name == "log" && line.contains(".log()");
        line.contains(&called) && !is_other || named.iter().any(is_named)
    })
}

#[test]
fn what_is_not_exact_is_told_from_what_is() {
    for line in [
        "x.sin()",
        "one.powf(other)",
        "map(f64::atan2)",
        "f32::exp(x)",
    ] {
        assert!(inexact(line).is_some(), "{line}");
    }
    for line in [
        "x.sqrt()",
        "libm::sin(x)",
        "self.log().into_iter()",
        "f64::powi",
        "f64::sinc",
    ] {
        assert_eq!(inexact(line), None, "{line}");
    }
}

#[test]
fn numbers_are_the_same_on_every_machine() {
    let mut complaints = Vec::new();
    // What is written into programs of other languages stands in the folders of generators.
    let of_them = |source: &&Source| {
        let is_in = |name: &str| source.path.starts_with(&format!("{name}/src/"));
        EXACT.iter().any(|name| is_in(name)) && !source.path.contains("/generate/")
    };
    for source in sources()
        .iter()
        .filter(of_them)
        .filter(|source| !source.is_test())
    {
        let count = source.product().lines().count();
        for (number, line) in source.code().take_while(|(number, _)| *number <= count) {
            if let Some(name) = inexact(line) {
                let place = format!("{}:{number}", source.path);
                complaints.push(format!(
                    "{place}: '{name}' differs between systems; libm has one that does not"
                ));
            }
        }
    }
    none(&complaints);
}
