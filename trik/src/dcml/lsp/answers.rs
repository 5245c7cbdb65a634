//! What is answered about one document: the shapes of the protocol around what `lang` knows.
//!
//! Owns these shapes and the list of methods. Knows no life of a session.

mod marks;
mod offers;
mod places;

use super::document::{Document, Encoding};
use super::message::{FAILED, METHOD_NOT_FOUND, Refusal};
use super::params::{self, range_json};
use super::session::Client;
use lang_dcml::diagnostic::{Code, Diagnostic, Severity};
use lang_dcml::syntax::Span;
use lang_editor::Edit;
use serde_json::{Value, json};

/// What a method is about.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Of {
    /// A place of a document.
    Place,
    /// All of it, or edits: of no use when it has changed since.
    All,
}

/// What a method is about; nothing for methods that are not known.
pub fn kind(method: &str) -> Option<Of> {
    match method.strip_prefix("textDocument/")? {
        "hover" | "completion" | "signatureHelp" | "definition" | "references"
        | "documentHighlight" | "prepareRename" => Some(Of::Place),
        "rename"
        | "documentSymbol"
        | "foldingRange"
        | "formatting"
        | "codeAction"
        | "semanticTokens/full"
        | "semanticTokens/range" => Some(Of::All),
        _ => None,
    }
}

/// The answer to a request about a document.
pub fn answer(
    method: &str,
    uri: &str,
    document: &Document,
    params: &Value,
    client: &Client,
) -> Result<Value, Refusal> {
    let encoding = client.encoding;
    let offset = || Ok(document.offset(params::position(params)?, encoding));
    let span = || Ok(document.span(params::range(params)?, encoding));
    let reading = document.reading();
    Ok(match method.trim_start_matches("textDocument/") {
        "hover" => offers::hover(document, offset()?, client),
        "completion" => offers::completion(document, offset()?, client),
        "signatureHelp" => offers::signature(document, offset()?, client),
        "definition" => places::definition(uri, document, offset()?, encoding),
        "references" => {
            let with_declaration =
                params.pointer("/context/includeDeclaration") != Some(&json!(false));
            places::references(uri, document, offset()?, with_declaration, encoding)
        }
        "documentHighlight" => places::highlights(document, offset()?, encoding),
        "prepareRename" => {
            let span = reading.renamable(offset()?).map_err(failed)?;
            range_json(document, span, encoding)
        }
        "rename" => {
            let name = params::text(params, "newName")?;
            let edits = reading.rename(offset()?, name).map_err(failed)?;
            workspace_edit(uri, document, &edits, client)
        }
        "documentSymbol" => places::symbols(uri, document, client),
        "foldingRange" => places::folds(document, encoding),
        "formatting" => {
            let edit = reading.formatted().map_err(failed)?;
            edits_json(document, edit.as_slice(), encoding)
        }
        "codeAction" => offers::fixes(uri, document, span()?, params, client),
        "semanticTokens/full" => {
            let end = u32::try_from(reading.text().len()).unwrap_or(u32::MAX);
            marks::tokens(document, Span { start: 0, end }, encoding)
        }
        "semanticTokens/range" => marks::tokens(document, span()?, encoding),
        _ => {
            return Err(Refusal::new(
                METHOD_NOT_FOUND,
                "this server has no such method",
            ));
        }
    })
}

fn failed(reason: lang_editor::Refusal) -> Refusal {
    Refusal::new(FAILED, reason.to_string())
}

/// What this server can do, as the answer to `initialize`.
pub fn capabilities(encoding: Encoding) -> Value {
    json!({
        "capabilities": {
            "positionEncoding": match encoding {
                Encoding::Utf8 => "utf-8",
                Encoding::Utf16 => "utf-16",
                Encoding::Utf32 => "utf-32",
            },
            "textDocumentSync": {"openClose": true, "change": 2},
            "hoverProvider": true,
            "completionProvider": {"triggerCharacters": ["(", "["]},
            "signatureHelpProvider": {"triggerCharacters": ["(", ","]},
            "definitionProvider": true,
            "referencesProvider": true,
            "documentHighlightProvider": true,
            "documentSymbolProvider": true,
            "foldingRangeProvider": true,
            "documentFormattingProvider": true,
            "renameProvider": {"prepareProvider": true},
            "codeActionProvider": {"codeActionKinds": ["quickfix"]},
            "semanticTokensProvider": {"legend": marks::legend(), "full": true, "range": true},
        },
        "serverInfo": {"name": "trik dcml lsp", "version": env!("CARGO_PKG_VERSION")},
    })
}

/// The diagnostics of a document.
pub fn diagnostics(uri: &str, document: &Document, client: &Client) -> Value {
    if document.is_too_long() {
        let message = "this document is too long, or a change of it was not understood: close it and open it again";
        return json!([{
            "range": range_json(document, Span::default(), client.encoding),
            "severity": 1,
            "code": Code::TooLong.name(),
            "source": "dcml",
            "message": message,
        }]);
    }
    let all = document.reading().diagnostics().iter();
    Value::Array(
        all.map(|one| diagnostic(uri, document, one, client))
            .collect(),
    )
}

fn diagnostic(uri: &str, document: &Document, one: &Diagnostic, client: &Client) -> Value {
    let hint = one.hint.as_ref().map(|hint| format!("\n{hint}"));
    let mut found = json!({
        "range": range_json(document, one.span, client.encoding),
        "severity": match one.severity {
            Severity::Error => 1,
            Severity::Warning => 2,
        },
        "code": one.code.name(),
        "source": "dcml",
        "message": format!("{}{}", one.message, hint.unwrap_or_default()),
    });
    if client.has_related && !one.notes.is_empty() {
        let notes = one.notes.iter().map(|(span, text)| {
            json!({"location": {"uri": uri, "range": range_json(document, *span, client.encoding)}, "message": text})
        });
        found["relatedInformation"] = notes.collect();
    }
    if client.has_tags && one.code == Code::Unused {
        // Unnecessary.
        found["tags"] = json!([1]);
    }
    found
}

fn edits_json(document: &Document, edits: &[Edit], encoding: Encoding) -> Value {
    let edits = edits.iter();
    edits
        .map(|one| json!({"range": range_json(document, one.span, encoding), "newText": one.text}))
        .collect()
}

fn workspace_edit(uri: &str, document: &Document, edits: &[Edit], client: &Client) -> Value {
    let edits = edits_json(document, edits, client.encoding);
    if client.has_versions {
        let document = json!({"uri": uri, "version": document.version});
        return json!({"documentChanges": [{"textDocument": document, "edits": edits}]});
    }
    let mut changes = serde_json::Map::new();
    changes.insert(uri.to_owned(), edits);
    json!({ "changes": changes })
}
