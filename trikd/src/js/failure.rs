//! A failure of a program, taken from the engine: what it says and where it was.
//!
//! Owns how an exception becomes the text that a person reads. `wording` has the words of the old dialect.

use super::debug::Frame;
use super::machine::{OWN, PROGRAM};
use super::wording;
use crate::limits;
use rquickjs::{Coerced, Ctx, Error, Exception, FromJs, Value};
use std::fmt::Write;

/// How the engine names a text that is in no file.
const INPUT: &str = "<input>";

/// What was thrown.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Failure {
    /// `ReferenceError: Can't find variable: foo`.
    exception: String,
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

/// The value of `a.b` in the global scope as a text, unless it is a function or cannot be known.
fn global_value(ctx: &Ctx<'_>, path: &str) -> Option<String> {
    let mut is_first = true;
    let mut value = ctx.globals().into_value();
    for name in path.split('.') {
        let object = value.into_object()?;
        // What is no property may be a variable of a function.
        if is_first && !object.contains_key(name).ok()? {
            return None;
        }
        is_first = false;
        value = object.get(name).ok()?;
    }
    (!value.is_function()).then(|| text(ctx, value))
}

fn text<'js>(ctx: &Ctx<'js>, value: Value<'js>) -> String {
    let text = Coerced::<String>::from_js(ctx, value);
    text.map(|text| shortened(text.0)).unwrap_or_else(|_| {
        // Its own toString() throws; that exception is nobody's.
        ctx.catch();
        "something that has no text".to_owned()
    })
}

/// The line of the program that a frame names, and the place in it.
fn place<'a>(frame: &Frame, program: &'a str) -> Option<wording::Place<'a>> {
    let from_zero = |number: u32| usize::try_from(number).ok()?.checked_sub(1);
    (frame.file == PROGRAM).then_some(())?;
    Some(wording::Place {
        line: program.lines().nth(from_zero(frame.line)?)?,
        column: from_zero(frame.column).unwrap_or(0),
    })
}

/// The calls of the program that have led to a function of the host, the innermost first. It calls nothing, so that a
/// program runs the same whether somebody asks or not.
pub fn calls(ctx: &Ctx<'_>) -> Vec<Frame> {
    // Only an error has a backtrace, and that of a text that cannot be parsed has it at once.
    let _ = ctx.json_parse("");
    let thrown = ctx.catch().into_object();
    let stack = thrown.and_then(Exception::from_object);
    let stack = stack.and_then(|thrown| thrown.stack()).unwrap_or_default();
    let frames = stack.lines().filter_map(frame);
    let own = |frame: &Frame| frame.file != INPUT && !frame.file.starts_with(OWN);
    frames.filter(own).take(limits::JS_FRAMES).collect()
}

/// Where in the program's text a function of the host was called from: the file, empty for the program itself, and the
/// line.
pub fn call_site(ctx: &Ctx<'_>) -> Option<(String, u32)> {
    let innermost = calls(ctx).into_iter().next()?;
    let file = match innermost.file.as_str() {
        PROGRAM => String::new(),
        _ => innermost.file,
    };
    Some((file, innermost.line))
}

impl Failure {
    /// Of what was thrown while this text was evaluated, or functions that it has made.
    pub fn new<'js>(ctx: &Ctx<'js>, thrown: Value<'js>, program: &str) -> Self {
        let exception = thrown
            .clone()
            .into_object()
            .and_then(Exception::from_object);
        let Some(exception) = exception else {
            return Self {
                exception: text(ctx, thrown),
                frames: Vec::new(),
            };
        };
        let field = |name: &str| match exception.as_object().get::<_, Value<'js>>(name) {
            Ok(value) if !value.is_undefined() => text(ctx, value),
            Ok(_) => String::new(),
            Err(_) => {
                ctx.catch();
                String::new()
            }
        };
        let (name, message) = (field("name"), field("message"));
        let stack = exception.stack().unwrap_or_default();
        let mut frames: Vec<_> = stack
            .lines()
            .filter_map(frame)
            .filter(|frame| !frame.file.starts_with(OWN))
            .collect();
        // The text that JSON.parse() or eval() was given is no file.
        if frames.len() > 1 && frames[0].file == INPUT {
            frames.remove(0);
        }
        let place = frames.first().and_then(|frame| place(frame, program));
        let message = wording::message(&name, &message, place, |path| global_value(ctx, path));
        Self {
            exception: match (name.as_str(), message.as_str()) {
                ("", message) => message.to_owned(),
                (name, "") => name.to_owned(),
                (name, message) => format!("{name}: {message}"),
            },
            frames,
        }
    }

    /// Of what a call into the engine gave.
    pub fn of(ctx: &Ctx<'_>, error: &Error, program: &str) -> Self {
        if error.is_exception() {
            return Self::new(ctx, ctx.catch(), program);
        }
        Self {
            exception: format!("Error: {error}"),
            frames: Vec::new(),
        }
    }

    /// The calls that have led there, the innermost first.
    pub fn frames(&self) -> &[Frame] {
        &self.frames
    }

    /// As it is shown for a program: the line, the exception, the backtrace.
    pub fn of_program(&self) -> String {
        let exception = &self.exception;
        let Some(innermost) = self.frames.first() else {
            return exception.clone();
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
    pub fn of_direct(&self) -> String {
        self.exception.clone()
    }
}

fn shortened(mut text: String) -> String {
    if let Some((at, _)) = text.char_indices().nth(limits::JS_ERROR_CHARACTERS) {
        text.truncate(at);
        text.push_str("...");
    }
    text
}
