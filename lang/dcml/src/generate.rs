//! A model as source text of another language, for programs of robots in that language.
//!
//! Owns the choice of the language and what all of them share. Computes nothing: what is printed is the straight-line code
//! of `lower`, with the names of the model and the same floating-point operations in the same order, so that every
//! language gives what [`super::tape::Tape::reference`] gives as far as its functions are those of the C library.

// A function that a language lacks must not compile.
#![deny(clippy::wildcard_enum_match_arm)]

mod about;
mod c;
mod graph;
mod java;
mod javascript;
mod latex;
mod lua;
mod names;
mod plan;
mod python;
mod row;
mod rust;

use super::lower;
use super::model::Model;
use super::syntax::Kind;
use super::tape::Lowered;
use graph::Scene;
use row::Row;
use std::fmt;

/// Makes the type of all languages with what is known of each, so that none is missing in a list.
macro_rules! targets {
    ($($(#[$what:meta])* $target:ident: $row:expr,)+) => {
        /// A language that a model can be written in.
        #[derive(Clone, Copy, Debug, Eq, PartialEq, Hash)]
        pub enum Target {
            $($(#[$what])* $target,)+
        }

        impl Target {
            /// All, in the order of the documentation.
            pub const ALL: [Self; [$(stringify!($target)),+].len()] = [$(Self::$target),+];

            /// What is known of it.
            const fn row(self) -> &'static Row {
                match self {
                    $(Self::$target => &$row,)+
                }
            }
        }
    };
}

targets! {
    /// Rust without allocation: one module.
    Rust: rust::ROW,
    /// C99 and C++ without allocation: one header.
    C: c::ROW,
    /// Java: a class for the solvers of Commons Math 3.
    Java: java::ROW,
    /// Java: a class for the solvers of Hipparchus.
    JavaHipparchus: java::ROW_HIPPARCHUS,
    /// Python: functions over NumPy arrays, for the solvers of SciPy.
    Python: python::ROW,
    /// Lua 5.1 and later: a module, for converters too.
    Lua: lua::ROW,
    /// JavaScript of ECMAScript 5: a module.
    JavaScript: javascript::ROW,
    /// LaTeX: equations to be read by people.
    Latex: latex::ROW,
}

impl Target {
    /// Its name on the command line.
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// The target of this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|one| one.name() == name)
    }

    /// How the names of its files end, without a dot.
    pub const fn ending(self) -> &'static str {
        self.row().ending
    }
}

/// The interface that all classes of Java implement: where the file stands below the folder of sources, and its text.
pub const JAVA_INTERFACE: (&str, &str) = ("trik/dcml/RobotModel.java", java::INTERFACE);

/// What may be chosen.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Options {
    /// Whether the Jacobians df/dx and df/du are written too.
    pub jacobian: bool,
}

/// Why a model cannot be written in a language.
#[derive(Clone, Debug, PartialEq)]
pub enum Refused {
    /// It has no code at all.
    Model(lower::Refused),
    /// It has more values than this many, which a function of this language can hold.
    TooLarge(Target, usize, usize),
}

impl fmt::Display for Refused {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Model(why) => why.fmt(out),
            Self::TooLarge(target, values, limit) => {
                let name = target.name();
                write!(
                    out,
                    "the model computes {values} values, and a function in {name} holds {limit}: take another target"
                )
            }
        }
    }
}

impl std::error::Error for Refused {}

/// Writes a model in a language. The same model gives the same text.
///
/// # Errors
/// The model is too large, for any code or for this language.
pub fn generate(model: &Model, target: Target, options: &Options) -> Result<String, Refused> {
    let lowered = if options.jacobian {
        lower::lower(model).map_err(Refused::Model)?
    } else {
        let equations = lower::equations(model).map_err(Refused::Model)?;
        Lowered {
            derivative: equations.derivative,
            outputs: equations.outputs,
            ..Lowered::default()
        }
    };
    // A variable that is asked for like an output shows which value is its own.
    let mut open = model.clone();
    for symbol in &mut open.symbols {
        if symbol.kind == Kind::Var {
            symbol.kind = Kind::Config;
        }
    }
    let named = lower::equations(&open).map_err(Refused::Model)?.outputs;
    let scene = Scene::new(model, &lowered, &named, options.jacobian);
    let values = scene.graph.operations.len() + scene.results();
    let row = target.row();
    if values > row.values_max {
        return Err(Refused::TooLarge(target, values, row.values_max));
    }
    Ok((row.print)(&scene))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_are_found_by_their_names() {
        for target in Target::ALL {
            assert_eq!(Target::named(target.name()), Some(target));
        }
        assert_eq!(Target::named("fortran"), None);
    }
}
