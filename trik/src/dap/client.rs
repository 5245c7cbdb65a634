//! The other end of a talk: requests in, answers and events out.
//!
//! Owns numbers of messages and the thread that reads. Knows no request.

use crate::debug::target::words::told;
use crate::limits;
use crate::wire::{self, Frame, Frames};
use lang_text::problem::Locale;
use serde_json::{Map, Value, json};
use std::io::{BufReader, Read, Write};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::Duration;

/// A request.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Request {
    seq: u64,
    pub command: String,
    pub arguments: Value,
}

impl Request {
    /// As it came, for another adapter.
    pub fn whole(&self) -> Value {
        json!({
            "seq": self.seq,
            "type": "request",
            "command": self.command,
            "arguments": self.arguments,
        })
    }

    /// What the client calls it.
    pub fn seq(&self) -> u64 {
        self.seq
    }

    /// One of ours, for another adapter.
    pub fn own(seq: u64, command: &str) -> Self {
        Self {
            seq,
            command: command.to_owned(),
            arguments: Value::Null,
        }
    }

    /// One that nobody has sent.
    #[cfg(test)]
    pub fn of(command: &str, arguments: Value) -> Self {
        Self {
            seq: 1,
            command: command.to_owned(),
            arguments,
        }
    }

    /// An argument that is a text.
    pub fn text(&self, name: &str) -> Option<&str> {
        self.arguments.get(name)?.as_str()
    }

    /// An argument that is a whole number.
    pub fn number(&self, name: &str) -> Option<u64> {
        self.arguments.get(name)?.as_u64()
    }

    /// An argument that is a truth; false if it is not there.
    pub fn truth(&self, name: &str) -> bool {
        self.arguments.get(name).and_then(Value::as_bool) == Some(true)
    }

    /// The items of an argument that is a list.
    pub fn items(&self, name: &str) -> &[Value] {
        let items = self.arguments.get(name).and_then(Value::as_array);
        items.map_or(&[], Vec::as_slice)
    }
}

/// Why a request is not carried out, for a person.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(super) struct Refused(pub String);

impl Refused {
    /// In these words.
    pub fn new(why: impl Into<String>) -> Self {
        Self(why.into())
    }
}

/// What comes next.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Incoming {
    /// A request.
    Request(Request),
    /// Nothing in this time.
    Nothing,
    /// The client is gone.
    End,
}

/// What comes from the thread that reads.
enum Received {
    Request(Request),
    Bad(String),
}

/// A client.
pub(super) struct Client {
    from: Receiver<Received>,
    to: Box<dyn Write>,
    seq: u64,
    is_gone: bool,
    /// The language of the person at the editor.
    locale: Locale,
}

impl Client {
    /// Over any stream; a thread reads it and ends with it.
    pub fn new(from: impl Read + Send + 'static, to: Box<dyn Write>) -> Self {
        let (sender, receiver) = sync_channel(limits::DAP_WAITING);
        std::thread::spawn(move || {
            let mut frames = Frames::of(BufReader::new(from));
            while let Ok(Some(frame)) = frames.next() {
                let read = match frame {
                    Frame::Body(body) => request(&body),
                    Frame::Bad(why) => Received::Bad(why.to_string()),
                };
                if sender.send(read).is_err() {
                    return;
                }
            }
        });
        Self {
            from: receiver,
            to,
            seq: 0,
            is_gone: false,
            locale: Locale::default(),
        }
    }

    /// The person at the editor speaks the language of these arguments, if they name one: of a launch by `language`, of the
    /// greeting by `locale`, as `ru-RU`.
    pub fn hear_language(&mut self, request: &mut Request) {
        let locale_of = |name: &str| Locale::named(name.split(['-', '_']).next()?);
        let named = request.text("language").or(request.text("locale"));
        if let Some(locale) = named.and_then(locale_of) {
            self.locale = locale;
        }
        // One that is none stays, and is refused with the other keys.
        let given = request.arguments.get("language");
        let is_none = given.is_some_and(|given| given.as_str().and_then(locale_of).is_none());
        if request.command != "initialize" && request.arguments.is_object() && !is_none {
            request.arguments["language"] = self.locale.name().into();
        }
    }

    /// The next request, waiting at most so long.
    pub fn next(&mut self, wait: Duration) -> Incoming {
        loop {
            if self.is_gone {
                return Incoming::End;
            }
            match self.from.recv_timeout(wait) {
                Ok(Received::Request(request)) => return Incoming::Request(request),
                Ok(Received::Bad(why)) => self.event(
                    "output",
                    json!({"category": "important", "output": format!("trik dap: {why}\n")}),
                ),
                Err(RecvTimeoutError::Timeout) => return Incoming::Nothing,
                Err(RecvTimeoutError::Disconnected) => return Incoming::End,
            }
        }
    }

    /// Tells that something has happened.
    pub fn event(&mut self, event: &str, body: Value) {
        self.send(json!({"type": "event", "event": event, "body": body}));
    }

    /// Answers a request.
    pub fn answer(&mut self, request: &Request, answer: Result<Value, Refused>) {
        let mut message = json!({
            "type": "response",
            "request_seq": request.seq,
            "command": request.command,
            "success": answer.is_ok(),
        });
        match answer {
            Ok(Value::Null) => {}
            Ok(body) => message["body"] = body,
            Err(Refused(why)) => {
                let why = told(&why, self.locale);
                message["body"] = json!({"error": {"id": 1, "format": why, "showUser": true}});
                message["message"] = Value::String(why);
            }
        }
        self.send(message);
    }

    /// Passes on what another adapter says to this client.
    pub fn pass(&mut self, message: Value) {
        self.send(message);
    }

    fn send(&mut self, mut message: Value) {
        self.seq += 1;
        message["seq"] = json!(self.seq);
        // A client that does not listen any more is gone.
        self.is_gone |= wire::write(&mut self.to, &message).is_err();
    }
}

fn request(body: &[u8]) -> Received {
    let read: Result<Map<String, Value>, _> = serde_json::from_slice(body);
    let mut all = match read {
        Ok(all) => all,
        Err(why) => return Received::Bad(format!("this is no message: {why}")),
    };
    let seq = all.get("seq").and_then(Value::as_u64);
    match (seq, all.remove("command")) {
        (Some(seq), Some(Value::String(command))) => Received::Request(Request {
            seq,
            command,
            arguments: all.remove("arguments").unwrap_or(Value::Null),
        }),
        (None | Some(_), _) => Received::Bad("a request has a seq and a command".to_owned()),
    }
}
