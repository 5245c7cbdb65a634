//! A failure of a program, taken from the engine: what it says and where it was.
//!
//! Owns how an exception becomes the text that a person reads. `wording` has the words of the old dialect.

use super::machine::{OWN, PROGRAM};
use super::wording;
use crate::limits;
use rquickjs::{Coerced, Ctx, Error, Exception, FromJs, Value};
use std::fmt::Write;

/// One function that was being executed.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Frame {
    /// Its name; empty for the text of the program itself.
    pub function: String,
    /// The file, as it was named when it was evaluated.
    pub file: String,
    /// Line and column, from 1.
    pub line: u32,
    /// See `line`.
    pub column: u32,
}

/// What was thrown.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Failure {
    /// `TypeError`; empty for what is no error.
    name: String,
    message: String,
    /// The innermost first; without our own.
    frames: Vec<Frame>,
}

/// `    at name (file:3:10)`, `    at file:3:10`.
fn frame(line: &str) -> Option<Frame> {
    let line = line.trim().strip_prefix("at ")?;
    let (function, place) = match line
        .strip_suffix(')')
        .and_then(|line| line.rsplit_once(" ("))
    {
        Some((function, place)) => (function, place),
        None => ("", line),
    };
    let mut parts = place.rsplitn(3, ':');
    let column = parts.next()?.parse().ok()?;
    let line = parts.next()?.parse().ok()?;
    Some(Frame {
        function: match function {
            "<eval>" => String::new(),
            name => name.to_owned(),
        },
        file: parts.next()?.to_owned(),
        line,
        column,
    })
}

impl Failure {
    /// Of what was thrown.
    pub fn new<'js>(ctx: &Ctx<'js>, thrown: Value<'js>) -> Self {
        let text = |value: Value<'js>| {
            Coerced::<String>::from_js(ctx, value)
                .map(|text| text.0)
                .unwrap_or_else(|_| {
                    // Its own toString() throws; that exception is nobody's.
                    ctx.catch();
                    "something that has no text".to_owned()
                })
        };
        let exception = thrown
            .clone()
            .into_object()
            .and_then(Exception::from_object);
        let Some(exception) = exception else {
            return Self {
                name: String::new(),
                message: shortened(text(thrown)),
                frames: Vec::new(),
            };
        };
        let field = |name: &str| match exception.as_object().get::<_, Value<'js>>(name) {
            Ok(value) if !value.is_undefined() => text(value),
            Ok(_) => String::new(),
            Err(_) => {
                ctx.catch();
                String::new()
            }
        };
        let stack = field("stack");
        let frames = stack.lines().filter_map(frame);
        Self {
            name: shortened(field("name")),
            message: shortened(field("message")),
            frames: frames
                .filter(|frame| !frame.file.starts_with(OWN))
                .collect(),
        }
    }

    /// Of what a call into the engine gave.
    pub fn of(ctx: &Ctx<'_>, error: &Error) -> Self {
        if error.is_exception() {
            return Self::new(ctx, ctx.catch());
        }
        Self {
            name: "Error".to_owned(),
            message: error.to_string(),
            frames: Vec::new(),
        }
    }

    /// `ReferenceError: Can't find variable: foo`.
    fn exception(&self, text: &str) -> String {
        let place = self.frames.first().filter(|frame| frame.file == PROGRAM);
        let line = place.and_then(|place| {
            let line = text
                .lines()
                .nth(usize::try_from(place.line).ok()?.checked_sub(1)?)?;
            Some((line, usize::try_from(place.column).ok()?.checked_sub(1)?))
        });
        let message = wording::message(&self.name, &self.message, line);
        match (self.name.as_str(), message.as_str()) {
            ("", message) => message.to_owned(),
            (name, "") => name.to_owned(),
            (name, message) => format!("{name}: {message}"),
        }
    }

    /// As it is shown for a program: the line, the exception, the backtrace.
    pub fn of_program(&self, text: &str) -> String {
        let exception = self.exception(text);
        let Some(innermost) = self.frames.first() else {
            return exception;
        };
        let mut shown = match innermost.file.as_str() {
            PROGRAM => format!("Line {}: {exception}", innermost.line),
            file => format!("Line {} of {file}: {exception}", innermost.line),
        };
        for frame in self.frames.iter().take(limits::JS_FRAMES) {
            let name = match frame.function.as_str() {
                "" => "<global>",
                name => name,
            };
            let _ = match frame.file.as_str() {
                PROGRAM => write!(shown, "\n{name}() at {}", frame.line),
                file => write!(shown, "\n{name}() at {file}:{}", frame.line),
            };
        }
        if self.frames.len() > limits::JS_FRAMES {
            shown.push_str("\n...");
        }
        shown
    }

    /// As it is shown for a direct text: the exception alone.
    pub fn of_direct(&self, text: &str) -> String {
        self.exception(text)
    }
}

fn shortened(mut text: String) -> String {
    if let Some((at, _)) = text.char_indices().nth(limits::JS_ERROR_CHARACTERS) {
        text.truncate(at);
        text.push_str("...");
    }
    text
}
