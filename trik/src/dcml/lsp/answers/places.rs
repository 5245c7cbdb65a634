//! Places in a document: where names stand, the outline, what can be folded.
//!
//! Owns their shapes.

use super::super::document::{Document, Encoding};
use super::super::params::range_json;
use super::super::session::Client;
use crate::limits;
use lang_dcml::syntax::{Kind, Span};
use lang_editor::{Symbol, SymbolKind};
use serde_json::{Value, json};

fn location(uri: &str, document: &Document, span: Span, encoding: Encoding) -> Value {
    json!({"uri": uri, "range": range_json(document, span, encoding)})
}

/// How many places an answer has, each with the name of the document.
fn most(uri: &str) -> usize {
    limits::LSP_ANSWER_BYTES / (uri.len() + 200)
}

/// Where a name is declared.
pub fn definition(uri: &str, document: &Document, offset: u32, encoding: Encoding) -> Value {
    let found = document.reading().definition(offset);
    found.map_or(Value::Null, |span| location(uri, document, span, encoding))
}

/// Where a name stands.
pub fn references(
    uri: &str,
    document: &Document,
    offset: u32,
    with_declaration: bool,
    encoding: Encoding,
) -> Value {
    let all = document.reading().references(offset).into_iter();
    let wanted = all.filter(|(_, is_declaration)| with_declaration || !is_declaration);
    wanted
        .take(most(uri))
        .map(|(span, _)| location(uri, document, span, encoding))
        .collect()
}

/// The same in one document, and whether the name gets its value there.
pub fn highlights(document: &Document, offset: u32, encoding: Encoding) -> Value {
    let writes = document.reading().writes(offset);
    let all = document.reading().references(offset).into_iter();
    all.map(|(span, _)| {
        // 3 writes, 2 reads.
        let kind = if writes.binary_search(&span).is_ok() {
            3
        } else {
            2
        };
        json!({"range": range_json(document, span, encoding), "kind": kind})
    })
    .collect()
}

/// The outline, as a tree or as a list.
pub fn symbols(uri: &str, document: &Document, client: &Client) -> Value {
    let symbols = document.reading().symbols();
    if client.has_tree {
        return symbols
            .iter()
            .map(|one| tree(document, one, client.encoding))
            .collect();
    }
    let flat = |one: &Symbol, container: Option<&str>| {
        let mut entry = json!({
            "name": one.name,
            "kind": number(one.kind),
            "location": location(uri, document, one.span, client.encoding),
        });
        if let Some(container) = container {
            entry["containerName"] = json!(container);
        }
        entry
    };
    let mut all = Vec::new();
    for model in &symbols {
        all.push(flat(model, None));
        all.extend(model.inside.iter().map(|one| flat(one, Some(&model.name))));
    }
    all.truncate(most(uri));
    Value::Array(all)
}

fn tree(document: &Document, one: &Symbol, encoding: Encoding) -> Value {
    let children: Vec<Value> = one
        .inside
        .iter()
        .map(|one| tree(document, one, encoding))
        .collect();
    json!({
        "name": one.name,
        "detail": one.detail,
        "kind": number(one.kind),
        "range": range_json(document, one.span, encoding),
        "selectionRange": range_json(document, one.selection, encoding),
        "children": children,
    })
}

/// The protocol has no kinds for robots; these have pictures that tell them apart.
fn number(kind: SymbolKind) -> u8 {
    match kind {
        // Class.
        SymbolKind::Model => 5,
        // Event, field, constant, property, variable.
        SymbolKind::Name(Kind::Action) => 24,
        SymbolKind::Name(Kind::Param) => 8,
        SymbolKind::Name(Kind::Const) => 14,
        SymbolKind::Name(Kind::Config) => 7,
        SymbolKind::Name(Kind::Var) => 13,
        // Operator.
        SymbolKind::Equation => 25,
    }
}

/// What can be folded, in whole lines.
pub fn folds(document: &Document, encoding: Encoding) -> Value {
    let reading = document.reading();
    let all = reading.folds().into_iter().filter_map(|fold| {
        let (from, to) = document.range(fold.span, encoding);
        if from.line >= to.line {
            return None;
        }
        let mut entry = json!({"startLine": from.line, "endLine": to.line});
        if fold.is_comment {
            entry["kind"] = json!("comment");
        }
        Some(entry)
    });
    all.collect()
}
