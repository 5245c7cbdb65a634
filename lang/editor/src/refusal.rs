//! Why an edit is refused.
//!
//! Owns the reasons and their words, which an editor shows to the person who asked.

use crate::limits::{DCML_EDITOR_NAME_BYTES, DCML_EDITOR_PLACES};
use std::fmt;

/// One reason.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Refusal {
    /// Nothing that has a name is here.
    NoName,
    /// A constant or function of the language.
    OfLanguage(String),
    /// A keyword.
    Keyword(String),
    /// A name without a declaration.
    Undeclared(String),
    /// A name of a function that there is not.
    NoFunction(String),
    /// A unit.
    Unit,
    /// A package.
    Package,
    /// The new name is the name of another model.
    ModelTaken(String),
    /// The new name is the name of a function.
    Function(String),
    /// The place is in no model.
    NoModel,
    /// The new name is declared in the same model.
    Declared(String),
    /// The new name is used in the same model.
    Used(String),
    /// The name is used in more than [`DCML_EDITOR_PLACES`] places.
    TooManyPlaces,
    /// The new name has more than [`DCML_EDITOR_NAME_BYTES`] bytes.
    TooLong,
    /// The new name is none.
    Unfit(String),
    /// A text with mistakes has no layout: the first mistake.
    Mistakes(String),
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoName => f.write_str("there is no name here"),
            Self::OfLanguage(name) => write!(f, "`{name}` belongs to the language"),
            Self::Keyword(word) => write!(f, "`{word}` is a word of the language"),
            Self::Undeclared(name) => write!(f, "`{name}` is not declared: declare it first"),
            Self::NoFunction(name) => write!(f, "there is no function `{name}`"),
            Self::Unit => f.write_str("units cannot be renamed"),
            Self::Package => f.write_str("packages cannot be renamed"),
            Self::ModelTaken(name) => write!(f, "there is a model `{name}` already"),
            Self::Function(name) => write!(f, "`{name}` is a function of the language"),
            Self::NoModel => f.write_str("it stands in no model"),
            Self::Declared(name) => write!(f, "`{name}` is declared in this model already"),
            Self::Used(name) => write!(f, "`{name}` is used in this model already"),
            Self::TooManyPlaces => {
                write!(f, "it is used in more than {DCML_EDITOR_PLACES} places")
            }
            Self::TooLong => write!(
                f,
                "a name that is put in has at most {DCML_EDITOR_NAME_BYTES} letters"
            ),
            Self::Unfit(word) => {
                let short: String = word.chars().take(40).collect();
                write!(
                    f,
                    "`{short}` is no name: a name has Latin letters, digits and _, and no digit first"
                )
            }
            Self::Mistakes(first) => write!(f, "not while there are mistakes: {first}"),
        }
    }
}

impl std::error::Error for Refusal {}
