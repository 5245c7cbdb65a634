//! What a run is told to people: entries of the report, a verdict, and why a task is failed.
//!
//! Owns these, and how seconds and values are written in them.

use super::value::{Value, shown};
use lang_text::json::quoted;

/// How a message of the report is meant.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Level {
    /// Worth knowing; so is success.
    Info,
    /// Something is strange, and the run goes on.
    Warning,
    /// The task is failed.
    Error,
    /// The constraints themselves are wrong.
    Critical,
    /// For the author's log.
    Log,
    /// The variables at the end, as JSON: `{"variables":[{"name":"total_score","value":0}]}`.
    Variables,
}

/// A line of the report.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Entry {
    /// How it is meant.
    pub level: Level,
    /// When, in milliseconds of model time.
    pub at_ms: u64,
    /// Where, for people, as the diagram and block of an error; empty for what has no place. The original tells none.
    pub place: String,
    /// What.
    pub text: String,
}

impl Entry {
    /// Place and text, as a person reads them.
    pub fn line(&self) -> String {
        format!("{}{}", self.place, self.text)
    }
}

/// What a run has come to. A run that is decided is to be stopped.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Verdict {
    /// Nothing yet.
    Open,
    /// The task is done, after so many milliseconds of model time since the start.
    Accomplished {
        /// Milliseconds since the start.
        after_ms: u64,
    },
    /// It is not; the report says why.
    Failed {
        /// Milliseconds since the start.
        after_ms: u64,
    },
}

/// Why a task is failed.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Failure {
    /// A rule says so.
    Rule,
    /// The time limit of the rules is over.
    TimeOver,
    /// The program has ended, and no rule had said that the task is done.
    Unfinished,
}

/// Seconds as the original tells them: at most six digits, and no more than needed.
pub(super) fn seconds(ms: u64) -> String {
    #[allow(clippy::cast_precision_loss)] // A run of 2^53 ms is no run.
    let seconds = ms as f64 / 1000.0;
    let rounded = format!("{seconds:.5e}").parse().unwrap_or(seconds);
    shown(rounded)
}

/// A value as JSON.
pub(super) fn json(value: &Value) -> String {
    match value {
        Value::Bool(_) | Value::Int(_) => value.to_text(),
        Value::Double(number) if number.is_finite() => value.to_text(),
        // A report holds texts whole.
        Value::Text(text) => quoted(text, usize::MAX),
        Value::Null
        | Value::Double(_)
        | Value::NoText
        | Value::Point(_)
        | Value::Place(_)
        | Value::Rect(_)
        | Value::Colour(_)
        | Value::Opaque
        | Value::List(_)
        | Value::Record(_)
        | Value::Object(_) => "null".to_owned(),
    }
}
