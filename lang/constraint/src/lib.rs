//! The language in which a field says what a task is: constraints, events, conditions and triggers of TRIK Studio.
//!
//! Owns the border: [`read()`] makes [`Rules`] of the element `constraints`, a [`Checker`] holds one run against them, and a
//! [`Scene`] is what it sees of a world. Knows no world: code that simulates or replays one implements [`Scene`].
//!
//! Semantics are those of the original, to the order in which events are checked: by id, descending, as its sort by
//! UTF-16 does; an event without an id has a random one in braces there, and stands here where a brace stands, among its
//! like in the order of the text. `init` has the empty id, and so comes last.

// A kind of value or comparison that is forgotten must not compile.
#![deny(clippy::wildcard_enum_match_arm)]
// Problems are rare, and their size costs nothing where none is.
#![allow(clippy::result_large_err)]

mod asked;
mod check;
mod expand;
mod explain;
mod former;
pub mod fuzz;
mod library;
pub mod limits;
mod lint;
mod operand;
mod read;
mod report;
mod rules;
mod scene;
mod spell;
mod value;
mod words;

pub use asked::{Asked, Wish, asked};
pub use check::Checker;
pub use explain::{Explained, Explanation, Near, Seen, Standing, Unit};
pub use lint::{Catalogue, lint};
pub use read::{read, read_with_templates};
pub use report::{Entry, Failure, Level, Verdict};
pub use rules::{Kind, Rules};
pub use scene::{Missing, Object, ObjectPoint, Scene, Unfit};
pub use value::{Point, Rect, Value};
pub use words::unread;

#[cfg(test)]
mod tests;
