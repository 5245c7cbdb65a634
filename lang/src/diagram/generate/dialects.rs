//! The languages, one file for each: words, reserved names, helpers.
//!
//! Owns what they share.

pub(super) mod javascript;
pub(super) mod python;

use super::code::Kind;

/// What a variable has before it gets a value: of numbers, truths, texts, tables, anything.
pub(super) fn start_value<'a>(kind: Option<&Kind>, values: [&'a str; 5]) -> &'a str {
    match kind {
        Some(Kind::Int | Kind::Float) => values[0],
        Some(Kind::Bool) => values[1],
        Some(Kind::Text) => values[2],
        Some(Kind::List(_)) => values[3],
        Some(Kind::Any) | None => values[4],
    }
}
