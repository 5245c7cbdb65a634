//! What is wrong with a line that a person writes into a file of `control`.
//!
//! Owns the kinds of mistakes and their words. Knows no files.

use crate::limits::{MAX_LINE_BYTES, PULSES_HZ_MAX};
use std::fmt;

/// One mistake; a person has to write another line.
#[derive(Debug, PartialEq, Eq)]
pub enum Mistake {
    /// It is no line of a person's.
    Unprintable,
    /// It does not say what happens to a key.
    Verb(String),
    /// It does not name a key of these.
    Key(String, Vec<&'static str>),
    /// It gives no pulses.
    Pulses(String),
}

impl fmt::Display for Mistake {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unprintable => {
                write!(
                    f,
                    "a line is printable and has at most {MAX_LINE_BYTES} bytes"
                )
            }
            Self::Verb(line) => {
                write!(f, "'{line}' does not begin with press, release or click")
            }
            Self::Key(line, keys) => {
                write!(
                    f,
                    "'{line}' does not name one of the keys {}",
                    keys.join(", ")
                )
            }
            Self::Pulses(line) => write!(
                f,
                "'{line}' is not a frequency from 1 to {PULSES_HZ_MAX} Hz and a duty from 0 to 100 %, as in '50 7', or 0"
            ),
        }
    }
}
