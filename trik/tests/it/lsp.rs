//! `trik dcml lsp` as editors use it: the real program, real messages on its standard streams.

/// Frames and messages that no editor sends.
mod hostile;
/// How long changes of long documents take.
mod long;
/// A talk from beginning to end.
mod talk;

use crate::rig::TRIK;
use harness::wait::LIFE;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};

/// A robot with two wheels, without a mistake; its comment has signs of two and of four bytes.
const DRIVE: &str = "BEGIN Drive // \u{3b8} \u{1F600} turns
ACTION: u_l, u_r;
PARAM: L, r;
CONFIG: x, y, /** Heading \u{3b8}. */ theta in S1;
d(x) = r / 2 * (u_l + u_r) * cos(theta);
d(y) = r / 2 * (u_l + u_r) * sin(theta);
/* \u{1F600}\u{3b8} */ d(theta) = (r / L) * (u_r - u_l);
END;
";

const URI: &str = "file:///tmp/drive.dcml";

/// A server that runs. A thread reads what it sends, so that neither side waits for the other.
struct Server {
    process: Child,
    to: Option<ChildStdin>,
    from: Receiver<Value>,
    /// Messages that came and nobody has asked for yet.
    kept: Vec<Value>,
    last: i64,
}

impl Server {
    fn start() -> Self {
        let mut process = Command::new(TRIK)
            .args(["dcml", "lsp"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the server");
        let (put, from) = channel();
        let mut out = BufReader::new(process.stdout.take().expect("its output"));
        std::thread::spawn(move || {
            while let Some(message) = frame(&mut out) {
                if put.send(message).is_err() {
                    break;
                }
            }
        });
        Self {
            to: process.stdin.take(),
            process,
            from,
            kept: Vec::new(),
            last: 0,
        }
    }

    /// One that is ready for an editor with these capabilities.
    fn ready(capabilities: &Value) -> Self {
        let mut server = Self::start();
        let answer = server.ask(
            "initialize",
            &json!({"processId": null, "capabilities": capabilities}),
        );
        assert!(answer.get("result").is_some(), "{answer}");
        server.notify("initialized", &json!({}));
        server
    }

    /// One that has this text open as its version 1, and the diagnostics of that.
    fn with(text: &str, capabilities: &Value) -> (Self, Value) {
        let mut server = Self::ready(capabilities);
        server.open(text);
        let told = server.diagnostics(1);
        (server, told)
    }

    fn raw(&mut self, bytes: &[u8]) {
        let to = self.to.as_mut().expect("open");
        to.write_all(bytes)
            .and_then(|()| to.flush())
            .expect("it reads");
    }

    fn send(&mut self, message: &Value) {
        self.raw(&framed(message));
    }

    fn notify(&mut self, method: &str, params: &Value) {
        self.send(&json!({"jsonrpc": "2.0", "method": method, "params": params}));
    }

    /// Sends a request; gives its number.
    fn request(&mut self, method: &str, params: &Value) -> i64 {
        self.last += 1;
        let id = self.last;
        self.send(&json!({"jsonrpc": "2.0", "id": id, "method": method, "params": params}));
        id
    }

    /// The answer to a request.
    fn ask(&mut self, method: &str, params: &Value) -> Value {
        let id = self.request(method, params);
        self.answer(&json!(id))
    }

    /// The result of a request that must succeed.
    fn result(&mut self, method: &str, params: &Value) -> Value {
        let mut answer = self.ask(method, params);
        assert!(answer.get("error").is_none(), "{method}: {answer}");
        answer["result"].take()
    }

    fn answer(&mut self, id: &Value) -> Value {
        self.wait(|message| message.get("method").is_none() && &message["id"] == id)
    }

    fn open(&mut self, text: &str) {
        let document = json!({"uri": URI, "languageId": "dcml", "version": 1, "text": text});
        self.notify("textDocument/didOpen", &json!({ "textDocument": document }));
    }

    fn change(&mut self, version: i64, changes: &Value) {
        let document = json!({"uri": URI, "version": version});
        self.notify(
            "textDocument/didChange",
            &json!({"textDocument": document, "contentChanges": changes}),
        );
    }

    /// The diagnostics of a version.
    fn diagnostics(&mut self, version: i64) -> Value {
        let mut message = self.wait(|message| {
            message["method"] == "textDocument/publishDiagnostics"
                && message["params"]["version"] == version
        });
        message["params"]["diagnostics"].take()
    }

    /// The first message that is wanted, of those that came and that will come.
    fn wait(&mut self, is_wanted: impl Fn(&Value) -> bool) -> Value {
        if let Some(at) = self.kept.iter().position(&is_wanted) {
            return self.kept.remove(at);
        }
        loop {
            let message = self.from.recv_timeout(LIFE).expect("an answer in time");
            assert_eq!(message["jsonrpc"], "2.0", "{message}");
            if is_wanted(&message) {
                return message;
            }
            self.kept.push(message);
        }
    }

    /// Says goodbye as an editor does: the exit status is 0, and standard error has this.
    fn goodbye(mut self) -> String {
        assert_eq!(self.result("shutdown", &Value::Null), Value::Null);
        self.notify("exit", &Value::Null);
        let (code, said) = self.end();
        assert_eq!(code, Some(0), "{said}");
        said
    }

    /// Its exit status once it has ended by itself, and what it told a person.
    fn end(mut self) -> (Option<i32>, String) {
        drop(self.to.take());
        let mut said = String::new();
        let mut errors = self.process.stderr.take().expect("its complaints");
        errors.read_to_string(&mut said).expect("a text");
        let status = self.process.wait().expect("it ends");
        (status.code(), said)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn framed(message: &Value) -> Vec<u8> {
    let body = message.to_string();
    format!("Content-Length: {}\r\n\r\n{body}", body.len()).into_bytes()
}

/// The next message of a stream, whose frames must be as the protocol says.
fn frame(from: &mut impl BufRead) -> Option<Value> {
    let mut header = String::new();
    from.read_line(&mut header)
        .ok()
        .filter(|count| *count > 0)?;
    let length = header.strip_prefix("Content-Length: ").expect("a header");
    let length: usize = length.trim_end_matches("\r\n").parse().expect("a number");
    let mut empty = String::new();
    from.read_line(&mut empty).ok()?;
    assert_eq!(empty, "\r\n");
    let mut body = vec![0; length];
    from.read_exact(&mut body).ok()?;
    Some(serde_json::from_slice(&body).expect("a message"))
}

/// What a modern editor can do.
fn modern() -> Value {
    json!({
        "general": {"positionEncodings": ["utf-16"]},
        "workspace": {"workspaceEdit": {"documentChanges": true}},
        "textDocument": {
            "hover": {"contentFormat": ["markdown", "plaintext"]},
            "completion": {"completionItem": {"snippetSupport": true}},
            "documentSymbol": {"hierarchicalDocumentSymbolSupport": true},
            "codeAction": {"codeActionLiteralSupport": {"codeActionKind": {"valueSet": ["quickfix"]}}},
            "publishDiagnostics": {"relatedInformation": true, "tagSupport": {"valueSet": [1]}},
            "signatureHelp": {"signatureInformation": {"parameterInformation": {"labelOffsetSupport": true}}},
        },
    })
}

/// The parameters of a request about the nth place of a word, counted in units of UTF-16.
fn at(text: &str, word: &str, nth: usize) -> Value {
    let place = text.match_indices(word).nth(nth).expect("so often").0;
    json!({"textDocument": {"uri": URI}, "position": place_of(text, place)})
}

fn place_of(text: &str, place: usize) -> Value {
    let before = &text[..place];
    let line = before.matches('\n').count();
    let column = before
        .rsplit('\n')
        .next()
        .unwrap_or_default()
        .encode_utf16()
        .count();
    json!({"line": line, "character": column})
}

/// The text with edits put in, by units of UTF-16.
fn edited(text: &str, edits: &Value) -> String {
    let byte = |place: &Value| {
        let line = usize::try_from(place["line"].as_u64().expect("a line")).unwrap();
        let unit = usize::try_from(place["character"].as_u64().expect("a column")).unwrap();
        let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
        let mut units = 0;
        let mut at = start;
        for sign in text[start..].chars() {
            if units >= unit {
                break;
            }
            units += sign.len_utf16();
            at += sign.len_utf8();
        }
        at
    };
    let mut all: Vec<(usize, usize, &str)> = edits
        .as_array()
        .expect("edits")
        .iter()
        .map(|edit| {
            let range = &edit["range"];
            (
                byte(&range["start"]),
                byte(&range["end"]),
                edit["newText"].as_str().expect("a text"),
            )
        })
        .collect();
    all.sort_unstable();
    let mut changed = text.to_owned();
    for (start, end, put) in all.into_iter().rev() {
        changed.replace_range(start..end, put);
    }
    changed
}
