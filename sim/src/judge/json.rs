//! JSON as reports, trajectories and recorded runs have it: `serde_json` within limits, and numbers as TRIK Studio writes them.
//!
//! Owns how numbers and texts are written, and the limits of a text that comes from outside. Knows nothing of what is
//! said in it.

use crate::limits;
use serde_core::de::{Deserializer as _, Error as _, SeqAccess, Visitor};
use std::fmt::{self, Write as _};

pub use serde_json::Value;

/// Writes a value. What a page of HTML could take for a tag is escaped.
pub fn write(into: &mut String, value: &Value) {
    for c in value.to_string().chars() {
        match c {
            // These stand in texts only, where an escape means the same.
            '<' | '\u{2028}' | '\u{2029}' | '\u{7f}' => {
                let _ = write!(into, "\\u{:04x}", c as u32);
            }
            c => into.push(c),
        }
    }
}

/// Writes a text with quotes, as [`write`] does.
pub fn text(into: &mut String, text: &str) {
    write(into, &text.into());
}

/// Writes a number so that it is the same when it is read; what JSON cannot hold becomes `null`.
pub fn number(into: &mut String, number: f64) {
    if number.is_finite() {
        // Minus zero is what an original never writes, nor `.0`.
        let number = if number == 0.0 { 0.0 } else { number };
        let _ = write!(into, "{number}");
    } else {
        into.push_str("null");
    }
}

/// Why a text is refused. Its author can change that.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Refusal {
    /// It has more values than [`limits::JSON_VALUES`].
    TooMany,
    /// What is wrong, and where that was noticed.
    At {
        /// From 1.
        line: usize,
        /// From 1.
        column: usize,
        /// In the words of the reader, or of the code that uses what is read.
        why: String,
    },
}

impl fmt::Display for Refusal {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooMany => out.write_str("there are too many values"),
            Self::At { line, column, why } => write!(out, "line {line}, column {column}: {why}"),
        }
    }
}

impl std::error::Error for Refusal {}

/// Reads one value and nothing after it.
///
/// # Errors
/// The line and column, and what is wrong there; also more values than [`limits::JSON_VALUES`] and deep nesting.
pub fn read(text: &str) -> Result<Value, Refusal> {
    bounded(text)?;
    serde_json::from_str(text).map_err(|error| place(&error))
}

/// Reads a list value by value, so that a long one needs no memory at once.
///
/// # Errors
/// As [`read`], and what `use_one` says of a value.
pub fn read_list(
    text: &str,
    use_one: impl FnMut(Value) -> Result<(), &'static str>,
) -> Result<(), Refusal> {
    bounded(text)?;
    let mut reader = serde_json::Deserializer::from_str(text);
    reader
        .deserialize_seq(Each(use_one))
        .and_then(|()| reader.end())
        .map_err(|error| place(&error))
}

/// Refuses a text with too many values before memory is spent on them.
fn bounded(text: &str) -> Result<(), Refusal> {
    let starts = |byte: &&u8| matches!(byte, b',' | b'[' | b'{');
    if text.as_bytes().iter().filter(starts).count() > limits::JSON_VALUES {
        return Err(Refusal::TooMany);
    }
    Ok(())
}

/// What is wrong, after the place where it was noticed.
fn place(error: &serde_json::Error) -> Refusal {
    let (line, column) = (error.line(), error.column());
    let all = error.to_string();
    let why = all.strip_suffix(&format!(" at line {line} column {column}"));
    Refusal::At {
        line,
        // What is wrong with the first byte is told before it was taken.
        column: column.max(1),
        why: why.unwrap_or(&all).to_owned(),
    }
}

/// Gives each value of a list to a function.
struct Each<F>(F);

impl<'de, F: FnMut(Value) -> Result<(), &'static str>> Visitor<'de> for Each<F> {
    type Value = ();

    fn expecting(&self, into: &mut fmt::Formatter<'_>) -> fmt::Result {
        into.write_str("a list")
    }

    fn visit_seq<A: SeqAccess<'de>>(mut self, mut list: A) -> Result<(), A::Error> {
        while let Some(value) = list.next_element()? {
            (self.0)(value).map_err(A::Error::custom)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_again() {
        let source = "a\"b\\c\n</script>\u{2028}\u{1f600}\u{7}";
        let mut json = String::new();
        text(&mut json, source);
        assert!(!json.contains('<') && json.is_ascii() != json.contains('\u{1f600}'));
        assert_eq!(read(&json), Ok(source.into()));
        for value in [0.1, -0.0, 1e300, -304.290027188038, 5.0] {
            let mut json = String::new();
            number(&mut json, value);
            assert_eq!(read(&json).unwrap().as_f64(), Some(value));
        }
        let mut json = String::new();
        number(&mut json, f64::NAN);
        assert_eq!(json, "null");
        let nested = r#"{"a":[1,true,null,{}],"b":""}"#;
        let mut again = String::new();
        write(&mut again, &read(nested).unwrap());
        assert_eq!(again, nested);
    }

    /// Half a pair used to be put together with whatever escape came after it.
    #[test]
    fn a_surrogate_pair_is_one_character_and_half_a_pair_is_refused() {
        assert_eq!(read(r#""\ud83d\ude00""#), Ok("\u{1f600}".into()));
        for json in [r#""\ud83d\u0041""#, r#""\ud83d""#, r#""\ude00""#] {
            let why = read(json).unwrap_err().to_string();
            assert!(
                why.contains("surrogate") || why.contains("hex escape"),
                "{why}"
            );
        }
    }

    #[test]
    fn what_is_wrong_is_told_with_its_place() {
        for (json, place) in [
            ("", "line 1, column 1: EOF while parsing a value"),
            ("[1,\n x]", "line 2, column 2: expected value"),
            ("{\"a\" 1}", "line 1, column 6: expected `:`"),
            ("[1] 2", "line 1, column 5: trailing characters"),
            ("\"abc", "line 1, column 4: EOF while parsing a string"),
            ("1e999", "line 1, column 5: number out of range"),
            ("\"\\q\"", "line 1, column 3: invalid escape"),
            ("\u{44f}", "line 1, column 1: expected value"),
        ] {
            assert_eq!(read(json).unwrap_err().to_string(), place, "{json}");
        }
        let deep = "[".repeat(100_000);
        let why = read(&deep).unwrap_err().to_string();
        assert!(why.contains("recursion limit"), "{why}");
        let many = format!("[{}]", "0,".repeat(limits::JSON_VALUES));
        assert_eq!(read(&many), Err(Refusal::TooMany));
    }
}
