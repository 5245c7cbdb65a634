//! The person at a terminal who answers the questions of a diagram that runs on a robot.
//!
//! Owns the question that is open. Standard input is not read before the first question: what else is typed there belongs to
//! the program that started this one.

use super::output::harmless;
use crate::limits;
use serde_json::Value;
use std::io::{self, BufRead, Read, Write};
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};

/// A person, who may have been asked something.
#[derive(Debug, Default)]
pub(super) struct Person {
    open: Option<Open>,
    lines: Option<Receiver<String>>,
}

#[derive(Debug)]
struct Open {
    number: u64,
    /// What an empty line means.
    default: String,
}

impl Person {
    /// Shows a question.
    pub(super) fn ask(&mut self, json: &str) {
        let question: Value = serde_json::from_str(json).unwrap_or_default();
        let Some(number) = question.get("number").and_then(Value::as_u64) else {
            return;
        };
        let text = |name: &str| {
            let text = question.get(name).and_then(Value::as_str);
            text.unwrap_or_default().to_owned()
        };
        let default = text("default");
        let shown = question_of(&text("variable"), &text("question"), &default);
        let shown = with_reason(&text("wrong"), shown);
        let mut err = io::stderr().lock();
        let _ = err.write_all(shown.as_bytes()).and_then(|()| err.flush());
        self.open = Some(Open { number, default });
        self.lines.get_or_insert_with(lines);
    }

    /// The request with what was answered, once there is an answer.
    pub(super) fn answer(&mut self) -> Option<Vec<u8>> {
        let open = self.open.as_ref()?;
        let request = match self.lines.as_ref()?.try_recv() {
            Ok(line) if line.is_empty() => format!("answer:{}:{}", open.number, open.default),
            Ok(line) => format!("answer:{}:{line}", open.number),
            Err(TryRecvError::Empty) => return None,
            // Nobody types any more.
            Err(TryRecvError::Disconnected) => format!("answer:{}", open.number),
        };
        self.open = None;
        Some(request.into_bytes())
    }
}

/// A question after what was wrong with the last answer to it, if anything was.
pub(crate) fn with_reason(wrong: &str, shown: String) -> String {
    match wrong {
        "" => shown,
        wrong => format!("{}\n{shown}", harmless(wrong).trim_end()),
    }
}

/// How a question is shown, with a blank behind it for the answer.
pub(crate) fn question_of(variable: &str, prompt: &str, default: &str) -> String {
    let said = match prompt {
        "" => format!("{variable} ="),
        prompt => prompt.to_owned(),
    };
    let said = harmless(&said).trim_end().to_owned();
    match default {
        "" => format!("{said} "),
        default => format!("{said} [{}] ", harmless(default).trim_end()),
    }
}

/// Lines of standard input, read one ahead.
fn lines() -> Receiver<String> {
    let (sender, receiver) = sync_channel(0);
    std::thread::spawn(move || {
        let mut input = io::stdin().lock();
        loop {
            let mut line = Vec::new();
            let most = limits::DEBUG_LINE_BYTES as u64;
            match (&mut input).take(most).read_until(b'\n', &mut line) {
                Ok(0) | Err(_) => return,
                Ok(_) => {}
            }
            let line = String::from_utf8_lossy(&line);
            let line = line.trim_end_matches(['\n', '\r']).to_owned();
            if sender.send(line).is_err() {
                return;
            }
        }
    });
    receiver
}
