//! What is shown or offered at a place: texts about words, words to put in, edits that mend.
//!
//! Owns their shapes, and the marks of Markdown.

use super::super::document::Document;
use super::super::params::range_json;
use super::super::session::Client;
use super::workspace_edit;
use lang_dcml::syntax::{Kind, Span};
use lang_editor::{Completion, Hover, Item};
use serde_json::{Value, json};

/// What is shown of a word.
pub fn hover(document: &Document, offset: u32, client: &Client) -> Value {
    let Some(hover) = document.reading().hover(offset) else {
        return Value::Null;
    };
    let contents = if client.has_markdown {
        json!({"kind": "markdown", "value": markdown(&hover)})
    } else {
        json!({"kind": "plaintext", "value": plain(&hover)})
    };
    json!({"contents": contents, "range": range_json(document, hover.span, client.encoding)})
}

fn markdown(hover: &Hover) -> String {
    let code = |text: &str| {
        // A fence longer than any row of back quotes in the text.
        let rows = text
            .split(|sign| sign != '`')
            .map(str::len)
            .max()
            .unwrap_or_default();
        let fence = "`".repeat(rows.max(2) + 1);
        format!("{fence}dcml\n{text}\n{fence}")
    };
    let mut parts = vec![code(&hover.code)];
    parts.extend(
        [&hover.what, &hover.said]
            .into_iter()
            .filter(|text| !text.is_empty())
            .cloned(),
    );
    if !hover.more.is_empty() {
        parts.push(code(&hover.more));
    }
    parts.join("\n\n")
}

fn plain(hover: &Hover) -> String {
    let parts = [&hover.code, &hover.what, &hover.said, &hover.more];
    let parts: Vec<&str> = parts
        .into_iter()
        .filter(|text| !text.is_empty())
        .map(String::as_str)
        .collect();
    parts.join("\n\n")
}

/// What may be written at a place.
pub fn completion(document: &Document, offset: u32, client: &Client) -> Value {
    let (all, is_whole) = document.reading().complete(offset);
    let entries = all.iter().enumerate();
    let items: Vec<Value> = entries
        .map(|(at, one)| offer(document, at, one, client))
        .collect();
    json!({"isIncomplete": !is_whole, "items": items})
}

fn offer(document: &Document, at: usize, one: &Completion, client: &Client) -> Value {
    // The numbers of the protocol.
    let kind = match one.item {
        Item::Function => 3,
        Item::Name(Kind::Param) => 5,
        Item::Name(Kind::Action | Kind::Var) => 6,
        Item::Name(Kind::Config) => 10,
        Item::Unit => 11,
        Item::Keyword => 14,
        Item::Snippet => 15,
        Item::Name(Kind::Const) | Item::Number => 21,
    };
    let snippet = one.snippet.as_ref().filter(|_| client.has_snippets);
    let mut entry = json!({
        "label": one.label,
        "kind": kind,
        // In the order in which they come.
        "sortText": format!("{at:05}"),
        "insertTextFormat": if snippet.is_some() { 2 } else { 1 },
        "textEdit": {
            "range": range_json(document, one.span, client.encoding),
            "newText": snippet.unwrap_or(&one.insert),
        },
    });
    if !one.detail.is_empty() {
        entry["detail"] = json!(one.detail);
    }
    if !one.said.is_empty() {
        entry["documentation"] = json!(one.said);
    }
    entry
}

/// The function whose arguments are written.
pub fn signature(document: &Document, offset: u32, client: &Client) -> Value {
    let Some(found) = document.reading().signature(offset) else {
        return Value::Null;
    };
    let arguments = found.arguments.iter().map(|one| {
        let name = found.code.get(one.start as usize..one.end as usize);
        // All of it is ASCII: bytes are units of any encoding.
        let label = if client.has_label_places {
            json!([one.start, one.end])
        } else {
            json!(name)
        };
        json!({ "label": label })
    });
    let signature = json!({
        "label": found.code,
        "documentation": found.said,
        "parameters": arguments.collect::<Vec<_>>(),
    });
    json!({"signatures": [signature], "activeSignature": 0, "activeParameter": found.active})
}

/// Edits that mend what is told of a stretch.
pub fn fixes(uri: &str, document: &Document, span: Span, params: &Value, client: &Client) -> Value {
    let only = params.pointer("/context/only").and_then(Value::as_array);
    let is_wanted =
        only.is_none_or(|only| only.iter().any(|kind| kind == "quickfix" || kind == ""));
    if !is_wanted || !client.has_fixes {
        return json!([]);
    }
    let reading = document.reading();
    let all = reading.fixes(span).into_iter().map(|fix| {
        let found = reading.diagnostics().get(fix.of);
        let diagnostics: Vec<Value> = found
            .map(|one| super::diagnostic(uri, document, one, client))
            .into_iter()
            .collect();
        json!({
            "title": fix.title,
            "kind": "quickfix",
            "diagnostics": diagnostics,
            "isPreferred": fix.is_preferred,
            "edit": workspace_edit(uri, document, &fix.edits, client),
        })
    });
    all.collect()
}
