//! Why a model does not move a robot.
//!
//! Owns the reasons and their words. The person who named the model, its numbers and its ports can change all of them.

use lang_dcml::{lower, solve};
use std::fmt;

/// What names the port of an action in its documentation.
pub(super) const TAG: &str = "@port";

/// One reason.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// A word that is no port.
    NoPort(String),
    /// Words with a `*` and no number after it.
    NoFactor(String),
    /// What the documentation of an action says of its port: its name and what is wrong.
    Documented(String, Box<Refusal>),
    /// The equations.
    Equations(lower::Refused),
    /// The steps of time.
    Steps(solve::Failure),
    /// The place at the start is not finite.
    NoPlaceToStart,
    /// Numbers that nobody has given: the option for them, and the names.
    Missing(&'static str, Vec<String>),
    /// A name that the model has not: what it would be, the name, those that there are.
    Stray(&'static str, String, Vec<String>),
    /// The model has no actions.
    NoActions,
    /// Nothing drives this action.
    Idle(String),
    /// The configuration of this model has no place on the map.
    NoPlace(String),
    /// No model of this name is shipped.
    NotShipped(&'static str),
}

impl fmt::Display for Refusal {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoPort(word) => write!(out, "'{word}' is no port: M1 to M4 or S1 to S6"),
            Self::NoFactor(words) => {
                write!(out, "'{words}': a number other than 0 belongs after *")
            }
            Self::Documented(name, why) => write!(out, "{TAG} of the action '{name}': {why}"),
            Self::Equations(why) => write!(out, "{why}"),
            Self::Steps(why) => write!(out, "{why}"),
            Self::NoPlaceToStart => out
                .write_str("the model has no finite place where it begins: say where with --start"),
            Self::Missing(option, names) => {
                let all: Vec<_> = names.iter().map(|name| format!("{name}=...")).collect();
                write!(out, "the model needs numbers: {option} {}", all.join(","))
            }
            Self::Stray(what, name, there) => {
                write!(out, "the model has no {what} '{name}'; it has ")?;
                match there.as_slice() {
                    [] => out.write_str("none"),
                    there => out.write_str(&there.join(", ")),
                }
            }
            Self::NoActions => out.write_str("the model has no actions: no motor moves it"),
            Self::Idle(name) => write!(
                out,
                "nothing drives the action '{name}': say --drive {name}=M3, or write {TAG} M3 into its documentation"
            ),
            Self::NoPlace(name) => write!(
                out,
                "the model '{name}' must have x, y and theta in its CONFIG: they are the place on the map"
            ),
            Self::NotShipped(name) => write!(out, "{name} is no shipped model"),
        }
    }
}

impl std::error::Error for Refusal {}
