//! Messages that wait: filled by the one who reads, emptied by the one who answers.
//!
//! Owns what is known before its turn: that a request is not wanted any more, and that a document will change. Bounded, so
//! that a client that only talks waits like everybody.

use super::message::Message;
use crate::limits;
use serde_json::Value;
use std::collections::{HashMap, VecDeque};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// See the head of this file.
#[derive(Debug, Default)]
pub struct Inbox {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct State {
    waiting: VecDeque<Waiting>,
    bytes: usize,
    /// How many changes wait for each document.
    changes: HashMap<String, usize>,
    has_ended: bool,
}

#[derive(Debug)]
struct Waiting {
    message: Message,
    bytes: usize,
    is_cancelled: bool,
}

/// What [`Inbox::take`] gives.
#[derive(Debug)]
pub enum Taken {
    /// A message, and whether its sender does not want it answered any more.
    Message(Message, bool),
    /// None has come in this time.
    Nothing,
    /// None will come.
    End,
}

impl Inbox {
    /// Puts a message in; waits while there is too much. `bytes` is the size of its text. A request to cancel takes effect
    /// at once.
    pub fn put(&self, message: Message, bytes: usize) {
        let mut state = self.lock();
        if let Some(id) = cancels(&message) {
            let mut requests = state.waiting.iter_mut();
            let meant = requests
                .find(|one| matches!(&one.message, Message::Request { id: its, .. } if its == id));
            if let Some(meant) = meant {
                meant.is_cancelled = true;
            }
            return;
        }
        while state.is_full() {
            let woken = self.changed.wait(state);
            state = woken.unwrap_or_else(PoisonError::into_inner);
        }
        if let Some(document) = changes(&message) {
            *state.changes.entry(document.to_owned()).or_default() += 1;
        }
        state.bytes += bytes;
        state.waiting.push_back(Waiting {
            message,
            bytes,
            is_cancelled: false,
        });
        self.changed.notify_all();
    }

    /// Nothing will come any more.
    pub fn end(&self) {
        self.lock().has_ended = true;
        self.changed.notify_all();
    }

    /// Takes the next message, waiting at most so long for one.
    pub fn take(&self, at_most: Duration) -> Taken {
        let state = self.lock();
        let is_idle = |state: &mut State| state.waiting.is_empty() && !state.has_ended;
        let woken = self.changed.wait_timeout_while(state, at_most, is_idle);
        let (mut state, _) = woken.unwrap_or_else(PoisonError::into_inner);
        let Some(one) = state.waiting.pop_front() else {
            return if state.has_ended {
                Taken::End
            } else {
                Taken::Nothing
            };
        };
        state.bytes -= one.bytes;
        if let Some(document) = changes(&one.message)
            && let Some(count) = state.changes.get_mut(document)
        {
            *count -= 1;
            if *count == 0 {
                state.changes.remove(document);
            }
        }
        self.changed.notify_all();
        Taken::Message(one.message, one.is_cancelled)
    }

    /// Whether a document is about to change, or to be closed.
    pub fn will_change(&self, document: &str) -> bool {
        self.lock().changes.contains_key(document)
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn is_full(&self) -> bool {
        !self.waiting.is_empty()
            && (self.waiting.len() >= limits::LSP_WAITING
                || self.bytes >= limits::LSP_WAITING_BYTES)
    }
}

/// The request that a message takes back.
fn cancels(message: &Message) -> Option<&Value> {
    let Message::Notification { method, params } = message else {
        return None;
    };
    if method != "$/cancelRequest" {
        return None;
    }
    params.get("id")
}

/// The document that a message changes.
fn changes(message: &Message) -> Option<&str> {
    let Message::Notification { method, params } = message else {
        return None;
    };
    let is_change = matches!(
        method.as_str(),
        "textDocument/didChange" | "textDocument/didClose" | "textDocument/didOpen"
    );
    if !is_change {
        return None;
    }
    params.get("textDocument")?.get("uri")?.as_str()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn request(id: i32) -> Message {
        Message::Request {
            id: json!(id),
            method: "m".into(),
            params: Value::Null,
        }
    }

    fn news(method: &str, params: Value) -> Message {
        Message::Notification {
            method: method.into(),
            params,
        }
    }

    fn taken(inbox: &Inbox) -> (Message, bool) {
        match inbox.take(Duration::ZERO) {
            Taken::Message(message, is_cancelled) => (message, is_cancelled),
            other @ (Taken::Nothing | Taken::End) => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_request_that_waits_can_be_taken_back_and_no_other_is() {
        let inbox = Inbox::default();
        inbox.put(request(1), 1);
        inbox.put(request(2), 1);
        inbox.put(news("$/cancelRequest", json!({"id": 2})), 1);
        inbox.put(news("$/cancelRequest", json!({"id": 9})), 1);
        assert_eq!(taken(&inbox), (request(1), false));
        assert_eq!(taken(&inbox), (request(2), true));
        assert!(matches!(inbox.take(Duration::ZERO), Taken::Nothing));
        inbox.end();
        assert!(matches!(inbox.take(Duration::from_secs(60)), Taken::End));
    }

    #[test]
    fn changes_are_known_before_their_turn() {
        let inbox = Inbox::default();
        let change = news(
            "textDocument/didChange",
            json!({"textDocument": {"uri": "a"}}),
        );
        inbox.put(request(1), 1);
        inbox.put(change, 1);
        assert!(inbox.will_change("a") && !inbox.will_change("b"));
        taken(&inbox);
        taken(&inbox);
        assert!(!inbox.will_change("a"));
    }

    #[test]
    fn who_sends_too_much_waits_until_there_is_room() {
        let inbox = Inbox::default();
        std::thread::scope(|scope| {
            let sender = scope.spawn(|| {
                for id in 0..3 {
                    inbox.put(request(id), limits::LSP_WAITING_BYTES);
                }
                inbox.end();
            });
            let mut got = 0;
            while let Taken::Message(message, _) = inbox.take(Duration::from_secs(60)) {
                assert_eq!(message, request(got));
                assert!(inbox.lock().waiting.len() <= 1);
                got += 1;
            }
            assert_eq!(got, 3);
            sender.join().unwrap();
        });
    }
}
