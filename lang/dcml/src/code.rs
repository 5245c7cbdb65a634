//! Every kind of finding: a stable name, what it means, and a text that has it.
//!
//! Owns the list; docs/dcml.md is generated from it, and a test sees that each example gives what it should.

use super::diagnostic::Severity;

macro_rules! codes {
    ($($(#[doc = $doc:literal])+ $code:ident, $name:literal, $severity:ident, $explanation:literal, $example:expr;)+) => {
        /// Which finding.
        #[derive(Clone, Copy, Debug, Eq, PartialEq, Hash, Ord, PartialOrd)]
        pub enum Code {
            $($(#[doc = $doc])+ $code,)+
        }

        impl Code {
            /// All, in the order of the documentation.
            pub const ALL: &'static [Self] = &[$(Self::$code),+];

            /// Its name, which never changes.
            pub const fn name(self) -> &'static str {
                match self { $(Self::$code => $name,)+ }
            }

            /// How bad it is.
            pub const fn severity(self) -> Severity {
                match self { $(Self::$code => Severity::$severity,)+ }
            }

            /// What it means, in sentences.
            pub const fn explanation(self) -> &'static str {
                match self { $(Self::$code => $explanation,)+ }
            }

            /// A text that has it; empty if such a text would be too long or no text.
            pub const fn example(self) -> &'static str {
                match self { $(Self::$code => $example,)+ }
            }
        }
    };
}

/// A model with one action, one parameter and one state, and something in it.
macro_rules! model {
    ($inside:literal) => {
        concat!(
            "BEGIN M ACTION: u; PARAM: k; CONFIG: x;\n",
            $inside,
            "\nEND;\n"
        )
    };
}

codes! {
    /// A sign that nothing begins with.
    UnknownSign, "unknown-sign", Error,
    "The text has a sign that means nothing in the language.", model!("d(x) = k # u;");
    /// A name with letters that are not Latin.
    ForeignName, "foreign-name", Error,
    "Names have Latin letters, digits and `_`; the name of this example is a Greek letter.", model!("VAR: \u{3b8}; \u{3b8} = k * u; d(x) = \u{3b8};");
    /// A comment without an end.
    OpenComment, "open-comment", Error,
    "A comment that begins with `/*` ends with `*/`.", model!("d(x) = k * u; /* a comment");
    /// Not a number.
    BadNumber, "bad-number", Error,
    "A number has digits, perhaps a point and an exponent, and nothing hangs on it.", model!("d(x) = 2k * u;");
    /// A number that is too large or too small.
    NumberRange, "number-range", Error,
    "A number is larger than 1.8e308, or so near to 0 that it would be 0.", model!("d(x) = 1e999 * k * u;");
    /// A reserved word instead of a name.
    ReservedName, "reserved-name", Error,
    "A reserved word is no name. Other spellings of it are: `Var`.", model!("VAR: END; d(x) = k * u;");
    /// Not what should stand here.
    Unexpected, "unexpected", Error,
    "Something else should stand here.", model!("d(x) = k * * u;");
    /// A statement without its end.
    MissingSemicolon, "missing-semicolon", Error,
    "Each section, each equation and `END` are followed by `;`.", model!("d(x) = k * u");
    /// Names without a comma between them.
    MissingComma, "missing-comma", Error,
    "Names of a section have commas between them.", model!("VAR: a b; a = k; b = a; d(x) = b * u;");
    /// A parenthesis or bracket without its partner.
    Unclosed, "unclosed", Error,
    "A parenthesis or a bracket is not closed.", model!("d(x) = (k * u;");
    /// A model without its end.
    MissingEnd, "missing-end", Error,
    "A model ends with `END;`.", "BEGIN M ACTION: u; CONFIG: x; d(x) = u;\n";
    /// Something that is in no model.
    OutsideModel, "outside-model", Error,
    "Between models stand comments only.", "d(y) = 1;\nBEGIN M ACTION: u; CONFIG: x; d(x) = u; END;\n";
    /// No model at all.
    NoModel, "no-model", Error,
    "A document has one model at least.", "/** Nothing. */\n";
    /// A section of a name that no section has.
    UnknownSection, "unknown-section", Error,
    "Sections are `PACKAGE`, `ACTION`, `PARAM`, `CONST`, `CONFIG` and `VAR`, in capitals.",
    model!("VARS: a; a = k; d(x) = a * u;");
    /// A second package.
    DuplicatePackage, "duplicate-package", Error,
    "A model is in one package.", model!("PACKAGE: a; PACKAGE: b; d(x) = k * u;");
    /// An expression that nests too deep.
    TooDeep, "too-deep", Error,
    "An expression nests deeper, or has more operators in a row, than 500. Name parts of it with `VAR`.", "";
    /// A text that is too long.
    TooLong, "too-long", Error,
    "A document has 32 MiB and four million words and signs at most.", "";
    /// A section that must be there.
    MissingSection, "missing-section", Error,
    "A model has `ACTION`, `CONFIG` and at least one equation.", "BEGIN M\nPARAM: k; CONFIG: x;\nd(x) = k;\nEND;\n";
    /// A name that nobody has declared.
    UndeclaredName, "undeclared-name", Error,
    "A name stands in no section of the model.", model!("d(x) = kk * u;");
    /// A name that is declared twice.
    DuplicateName, "duplicate-name", Error,
    "A name of a model means one thing.", model!("VAR: k; d(x) = k * u;");
    /// Two models of one name.
    DuplicateModel, "duplicate-model", Error,
    "Models of a document have different names.",
    "BEGIN M ACTION: u; CONFIG: x; d(x) = u; END;\nBEGIN M ACTION: u; CONFIG: x; d(x) = u; END;\n";
    /// A configuration or a variable that nothing gives.
    MissingEquation, "missing-equation", Error,
    "Each name of `CONFIG` and `VAR` has one equation.", model!("CONFIG: y; d(x) = k * u;");
    /// Two equations for one name.
    DuplicateEquation, "duplicate-equation", Error,
    "Each name of `CONFIG` and `VAR` has one equation, either of the value or of the derivative.",
    model!("d(x) = k * u;\nx = k;");
    /// An equation of something that has a value already.
    NotAssignable, "not-assignable", Error,
    "Actions, parameters and constants have no equations.", model!("d(x) = k * u;\nk = 2;");
    /// The derivative of what is no state.
    NotDerivable, "not-derivable", Error,
    "Only names of `CONFIG` have derivatives.", model!("VAR: a; d(a) = u; d(x) = k * a;");
    /// A function that does not exist.
    UnknownFunction, "unknown-function", Error,
    "There is no such function.", model!("d(x) = k * sine(u);");
    /// Too many or too few arguments.
    ArgumentCount, "argument-count", Error,
    "A function has another number of arguments.", model!("d(x) = k * atan2(u);");
    /// Values that need each other.
    AlgebraicLoop, "algebraic-loop", Error,
    "Values need each other in a circle, so that none can be the first. A derivative in the circle would open it.",
    model!("VAR: a, b; a = b + k; b = a * u; d(x) = b;");
    /// A division by 0.
    DivisionByZero, "division-by-zero", Error,
    "Something is divided by the number 0.", model!("d(x) = k * u / 0;");
    /// A constant without its number.
    MissingValue, "missing-value", Error,
    "A constant is declared with its number.", model!("CONST: g; d(x) = k * u * g;");
    /// A number for what is no constant.
    UnexpectedValue, "unexpected-value", Error,
    "Only constants are declared with a number.", model!("VAR: a = 3; a = k; d(x) = a * u;");
    /// A comparison outside a condition.
    MisplacedComparison, "misplaced-comparison", Error,
    "Comparisons are conditions of `piecewise`, and nothing else.", model!("d(x) = k * (u > 0);");
    /// A condition that compares nothing.
    NoCondition, "no-condition", Error,
    "`piecewise(condition, value, ..., otherwise)` has comparisons as its conditions.",
    model!("d(x) = piecewise(u, k, 0);");
    /// A range or circle where it means nothing.
    MisplacedDomain, "misplaced-domain", Error,
    "Only names of `CONFIG` are angles on a circle, and variables have no range.",
    model!("VAR: a in -1 .. 1; a = k; d(x) = a * u;");
    /// A range that nothing is in.
    BadRange, "bad-range", Error,
    "A range begins below its end, and a constant is in its own.", model!("PARAM: a in 2 .. -2; d(x) = a * k * u;");
    /// A unit that does not exist.
    UnknownUnit, "unknown-unit", Error,
    "A unit is not known.", model!("PARAM: a [furlong]; d(x) = a * k * u;");
    /// Quantities that do not fit.
    UnitMismatch, "unit-mismatch", Error,
    "Quantities are added, compared or assigned that are not of the same kind.",
    model!("PARAM: a [m], b [s]; d(x) = k * u * (a + b);");
    /// Units of one quantity that differ.
    UnitScale, "unit-scale", Error,
    "Values are added, compared or assigned that measure the same in different units.",
    model!("PARAM: a [m], b [cm]; d(x) = k * u * (a + b);");
    /// Something is declared and not used.
    Unused, "unused", Warning,
    "An action, a parameter, a constant or a variable changes nothing.", model!("VAR: a; a = k; d(x) = u;");
    /// A name that means something else already.
    Shadowing, "shadowing", Warning,
    "A name hides `pi` or `e`, or is that of a function.", model!("VAR: e; e = k; d(x) = e * u;");
    /// A division by a constant that is 0.
    ZeroConstant, "zero-constant", Warning,
    "Something is divided by a constant that is 0.", model!("CONST: c = 0; d(x) = k * u / c;");
    /// Not in the published language.
    Extension, "extension", Error,
    "The published language does not have this; only `--paper` tells it.",
    model!("d(x) = k * u; // a comment");
    /// More than is told.
    More, "more", Error,
    "There are more errors or warnings than are told.", "";
}
