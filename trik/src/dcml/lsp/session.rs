//! One talk with an editor, from `initialize` to `exit`.
//!
//! Owns which documents are open and what may be said when. Messages in, messages out: it knows no stream and no thread.

use super::answers;
use super::document::{Document, Encoding};
use super::message::{
    CANCELLED, CONTENT_MODIFIED, INVALID_PARAMS, INVALID_REQUEST, METHOD_NOT_FOUND, Message,
    NOT_INITIALIZED, Refusal, answer, notification,
};
use super::params;
use crate::limits;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// What an editor can do, as far as answers depend on it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Client {
    /// How it counts columns.
    pub encoding: Encoding,
    /// It shows Markdown.
    pub has_markdown: bool,
    /// It puts in texts with places to fill in.
    pub has_snippets: bool,
    /// It shows an outline as a tree.
    pub has_tree: bool,
    /// It takes edits for one version of a document.
    pub has_versions: bool,
    /// It takes edits that mend something.
    pub has_fixes: bool,
    /// It takes the places of arguments instead of their names.
    pub has_label_places: bool,
    /// It shows other places of a diagnostic.
    pub has_related: bool,
    /// It shows words that nobody needs as such.
    pub has_tags: bool,
}

#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
enum Phase {
    #[default]
    Fresh,
    Ready,
    Down,
}

/// See the head of this file.
#[derive(Debug, Default)]
pub struct Session {
    phase: Phase,
    client: Client,
    documents: BTreeMap<String, Document>,
    parent: Option<i32>,
}

/// Whether a document will change by what waits already.
pub type WillChange<'a> = &'a dyn Fn(&str) -> bool;

impl Session {
    /// The process of the editor, if it has said which.
    pub fn parent(&self) -> Option<i32> {
        self.parent
    }

    /// The exit status when the editor says `exit`, or is gone: 0 after `shutdown`, else 1.
    pub fn exit_status(&self) -> u8 {
        u8::from(self.phase != Phase::Down)
    }

    /// Takes a message; puts what is to be sent into `out`, and what a person may want to know into `log`. True if the
    /// talk is over.
    pub fn receive(
        &mut self,
        message: Message,
        is_cancelled: bool,
        will_change: WillChange<'_>,
        out: &mut Vec<Value>,
        log: &mut Vec<String>,
    ) -> bool {
        match message {
            Message::Answer => {}
            Message::Bad(id, refusal) => {
                log.push(format!("a bad message: {}", refusal.reason));
                out.push(answer(&id, Err(refusal)));
            }
            Message::Request { id, .. } if is_cancelled => {
                let refusal = Refusal::new(CANCELLED, "the request was taken back");
                out.push(answer(&id, Err(refusal)));
            }
            Message::Request { id, method, params } => {
                let result = self.request(&method, &params, will_change);
                if let Err(refusal) = &result
                    && refusal.code == INVALID_PARAMS
                {
                    log.push(format!("{}: {}", short(&method), refusal.reason));
                }
                out.push(answer(&id, result));
            }
            Message::Notification { method, .. } if method == "exit" => return true,
            Message::Notification { method, mut params } => {
                if self.phase == Phase::Ready
                    && let Err(refusal) = self.notice(&method, &mut params, out)
                {
                    log.push(format!("{}: {}", short(&method), refusal.reason));
                }
            }
        }
        false
    }

    /// Tells the diagnostics of documents that have changed and will not at once change again.
    pub fn settle(&mut self, will_change: WillChange<'_>, out: &mut Vec<Value>) {
        let mut last = None;
        for (uri, document) in &mut self.documents {
            if document.is_new && !will_change(uri) {
                document.is_new = false;
                let mut params = json!({"uri": uri, "diagnostics": answers::diagnostics(uri, document, &self.client)});
                if let Some(version) = document.version {
                    params["version"] = json!(version);
                }
                out.push(notification("textDocument/publishDiagnostics", params));
                last = Some(uri.clone());
            }
        }
        if let Some(uri) = last {
            self.rest_others(&uri);
        }
    }

    fn request(
        &mut self,
        method: &str,
        params: &Value,
        will_change: WillChange<'_>,
    ) -> Result<Value, Refusal> {
        match (self.phase, method) {
            (Phase::Fresh, "initialize") => Ok(self.initialize(params)),
            (Phase::Fresh, _) => Err(Refusal::new(NOT_INITIALIZED, "initialize comes first")),
            (Phase::Down, _) => Err(Refusal::new(INVALID_REQUEST, "this server was shut down")),
            (Phase::Ready, "initialize") => {
                Err(Refusal::new(INVALID_REQUEST, "initialize comes only once"))
            }
            (Phase::Ready, "shutdown") => {
                self.phase = Phase::Down;
                self.documents.clear();
                Ok(Value::Null)
            }
            (Phase::Ready, _) => {
                let Some(kind) = answers::kind(method) else {
                    let why = format!("this server has no method '{}'", short(method));
                    return Err(Refusal::new(METHOD_NOT_FOUND, why));
                };
                let uri = params::document(params)?;
                self.rest_others(uri);
                let document = self.documents.get(uri);

                let document = document.ok_or_else(|| not_open(uri))?;
                if kind == answers::Of::All && will_change(uri) {
                    return Err(Refusal::new(
                        CONTENT_MODIFIED,
                        "the document has changed since",
                    ));
                }
                if document.is_too_long() {
                    return Ok(Value::Null);
                }
                answers::answer(method, uri, document, params, &self.client)
            }
        }
    }

    fn initialize(&mut self, params: &Value) -> Value {
        self.phase = Phase::Ready;
        let process = params.get("processId").and_then(Value::as_i64);
        self.parent = process
            .and_then(|id| i32::try_from(id).ok())
            .filter(|id| *id > 0);
        let has = |path: &str| params.pointer(path).and_then(Value::as_bool) == Some(true);
        let lists = |path: &str, word: &str| {
            let list = params.pointer(path).and_then(Value::as_array);
            list.is_some_and(|list| list.iter().any(|one| one == word))
        };
        let encodings = "/capabilities/general/positionEncodings";
        let encoding = match () {
            () if lists(encodings, "utf-8") => Encoding::Utf8,
            () if lists(encodings, "utf-32") && !lists(encodings, "utf-16") => Encoding::Utf32,
            () => Encoding::Utf16,
        };
        let of_text = "/capabilities/textDocument";
        self.client = Client {
            encoding,
            has_markdown: lists(&format!("{of_text}/hover/contentFormat"), "markdown"),
            has_snippets: has(&format!(
                "{of_text}/completion/completionItem/snippetSupport"
            )),
            has_tree: has(&format!(
                "{of_text}/documentSymbol/hierarchicalDocumentSymbolSupport"
            )),
            has_versions: has("/capabilities/workspace/workspaceEdit/documentChanges"),
            has_fixes: params
                .pointer(&format!("{of_text}/codeAction/codeActionLiteralSupport"))
                .is_some(),
            has_label_places: has(&format!(
                "{of_text}/signatureHelp/signatureInformation/parameterInformation/labelOffsetSupport"
            )),
            has_related: has(&format!("{of_text}/publishDiagnostics/relatedInformation")),
            has_tags: params
                .pointer(&format!("{of_text}/publishDiagnostics/tagSupport"))
                .is_some(),
        };
        answers::capabilities(encoding)
    }

    fn notice(
        &mut self,
        method: &str,
        params: &mut Value,
        out: &mut Vec<Value>,
    ) -> Result<(), Refusal> {
        match method {
            "textDocument/didOpen" => self.open(params),
            "textDocument/didChange" => self.change(params),
            "textDocument/didClose" => {
                let uri = params::document(params)?;
                if self.documents.remove(uri).is_none() {
                    return Err(not_open(uri));
                }
                let nothing = json!({"uri": uri, "diagnostics": []});
                out.push(notification("textDocument/publishDiagnostics", nothing));
                Ok(())
            }
            // What is not known is nothing that this server could do.
            _ => Ok(()),
        }
    }

    fn open(&mut self, params: &Value) -> Result<(), Refusal> {
        let uri = params::document(params)?;
        if uri.len() > limits::LSP_URI_BYTES {
            return Err(Refusal::new(
                INVALID_PARAMS,
                "the name of the document is too long",
            ));
        }
        if self.documents.len() >= limits::LSP_DOCUMENTS && !self.documents.contains_key(uri) {
            let why = format!("{} documents are open already", limits::LSP_DOCUMENTS);
            return Err(Refusal::new(INVALID_PARAMS, why));
        }
        let document = params.get("textDocument").unwrap_or(&Value::Null);
        let text = params::text(document, "text")?;
        let version = document.get("version").and_then(Value::as_i64);
        self.documents
            .insert(uri.to_owned(), Document::new(text, version));
        self.keep_within(uri);
        Ok(())
    }

    fn change(&mut self, params: &mut Value) -> Result<(), Refusal> {
        let version = params
            .pointer("/textDocument/version")
            .and_then(Value::as_i64);
        let changes = params::changes(params);
        let uri = params::document(params)?;
        let document = self.documents.get_mut(uri).ok_or_else(|| not_open(uri))?;
        document.version = version;
        match changes {
            Ok(changes) => {
                for change in &changes {
                    document.change(change, self.client.encoding);
                }
            }
            Err(refusal) => {
                // What the editor shows is not known any more; better nothing is said than something wrong.
                document.forget();
                document.is_new = true;
                return Err(refusal);
            }
        }
        self.keep_within(uri);
        Ok(())
    }

    /// Lets go what is known of other documents if that is much.
    fn rest_others(&mut self, uri: &str) {
        let mut bytes = 0;
        for (_, document) in self.documents.iter_mut().filter(|(other, _)| *other != uri) {
            bytes += if document.is_read() {
                document.bytes()
            } else {
                0
            };
            if bytes > limits::LSP_READ_BYTES {
                document.rest();
            }
        }
    }

    /// Forgets the text of a document if all together are too long.
    fn keep_within(&mut self, uri: &str) {
        let bytes: usize = self.documents.values().map(Document::bytes).sum();
        if bytes > limits::LSP_TEXT_BYTES
            && let Some(document) = self.documents.get_mut(uri)
        {
            document.forget();
        }
    }
}

fn not_open(uri: &str) -> Refusal {
    Refusal::new(
        INVALID_PARAMS,
        format!("the document {} is not open", short(uri)),
    )
}

/// A word of a stranger as far as anybody wants to read it.
fn short(text: &str) -> String {
    text.chars().take(100).collect()
}
