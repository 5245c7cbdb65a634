//! Parameters of requests out of their JSON, and places back into it.
//!
//! Owns the names of their parts, and what is said of parts that are missing.

use super::document::{Change, Document, Encoding, Position};
use super::message::{INVALID_PARAMS, Refusal};
use lang_dcml::syntax::Span;
use serde_json::{Value, json};

/// What is said of a part that is missing or wrong.
fn wrong(name: &str, what: &str) -> Refusal {
    Refusal::new(INVALID_PARAMS, format!("{name} must be {what}"))
}

/// The document that a message is about.
pub fn document(params: &Value) -> Result<&str, Refusal> {
    let uri = params.pointer("/textDocument/uri").and_then(Value::as_str);
    uri.ok_or_else(|| wrong("textDocument.uri", "a text"))
}

/// The place that a request is about.
pub fn position(params: &Value) -> Result<Position, Refusal> {
    place(params.get("position"), "position")
}

/// The range that a request is about.
pub fn range(params: &Value) -> Result<(Position, Position), Refusal> {
    let range = params.get("range").ok_or_else(|| wrong("range", "there"))?;
    range_of(range, "range")
}

/// A text among the parameters.
pub fn text<'a>(params: &'a Value, name: &str) -> Result<&'a str, Refusal> {
    let found = params.get(name).and_then(Value::as_str);
    found.ok_or_else(|| wrong(name, "a text"))
}

/// The changes of a document, one after another.
pub fn changes(params: &mut Value) -> Result<Vec<Change>, Refusal> {
    let all = params
        .get_mut("contentChanges")
        .and_then(Value::as_array_mut);
    let all = all.ok_or_else(|| wrong("contentChanges", "an array"))?;
    all.iter_mut().map(change).collect()
}

fn change(value: &mut Value) -> Result<Change, Refusal> {
    let range = match value.get("range") {
        None | Some(Value::Null) => None,
        Some(range) => Some(range_of(range, "contentChanges.range")?),
    };
    match value.get_mut("text").map(Value::take) {
        Some(Value::String(text)) => Ok(Change { range, text }),
        _ => Err(wrong("contentChanges.text", "a text")),
    }
}

fn range_of(value: &Value, name: &str) -> Result<(Position, Position), Refusal> {
    Ok((
        place(value.get("start"), name)?,
        place(value.get("end"), name)?,
    ))
}

fn place(value: Option<&Value>, name: &str) -> Result<Position, Refusal> {
    let part = |part: &str| {
        let number = value
            .and_then(|value| value.get(part))
            .and_then(Value::as_u64);
        let number =
            number.ok_or_else(|| wrong(&format!("{name}.{part}"), "a whole number from 0"))?;
        Ok(usize::try_from(number).unwrap_or(usize::MAX))
    };
    Ok(Position {
        line: part("line")?,
        unit: part("character")?,
    })
}

/// A place as JSON.
pub fn place_json(at: Position) -> Value {
    json!({"line": at.line, "character": at.unit})
}

/// A stretch of a document as JSON.
pub fn range_json(document: &Document, span: Span, encoding: Encoding) -> Value {
    let (from, to) = document.range(span, encoding);
    json!({"start": place_json(from), "end": place_json(to)})
}
