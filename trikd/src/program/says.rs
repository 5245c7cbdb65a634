//! What the running program says, on its way to all clients.
//!
//! Owns what is held back, cut and dropped of it, and what counts of a program that is dead. `output` has the measures.

use super::{Current, Supervisor};
use crate::limits;
use crate::protocol::program::FromProgram;
use journal::standard::Level;
use journal::write::Story;
use std::time::Instant;

impl Supervisor {
    /// Shows something that the program said, unless it says too much.
    pub(super) fn show(&mut self, kind: &str, text: &str) {
        let Some(current) = &mut self.current else {
            return;
        };
        let now = Instant::now();
        let mut end = text.len().min(limits::MESSAGE_BYTES);
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        let message = format!("{kind}: {}", &text[..end]);
        let shown = current.meter.offer(message, now);
        self.show_held();
        if let Some(message) = shown {
            self.say(&message);
        }
    }

    /// Something that a program said, for all who hear.
    fn say(&self, message: &str) {
        self.broadcast(message);
        if self.around.record.is_heard() {
            let name = self.current.as_ref().map_or("", |current| &current.name);
            let level = match message.starts_with("error: ") {
                true => Level::Error,
                false => Level::Info,
            };
            (self.around.record).level(Story::Output, level, name, message);
        }
    }

    /// Shows what was held back and may be shown by now.
    pub(super) fn show_held(&mut self) {
        let Some(current) = &mut self.current else {
            return;
        };
        let now = Instant::now();
        let dropped = current.meter.take_dropped(now, false);
        let held: Vec<_> = std::iter::from_fn(|| current.meter.release(now, false)).collect();
        self.report_dropped(dropped);
        for message in held {
            self.say(&message);
        }
    }

    pub(super) fn report_dropped(&self, dropped: Option<u32>) {
        if let Some(count) = dropped {
            self.broadcast(&format!("info: {count} messages of the program were left out: it says more than {} a second", limits::OUTPUT_MESSAGES_PER_SECOND));
        }
    }

    /// Of a program that is dead only what it wanted to show counts.
    pub(super) fn hear_last(&self, current: &mut Current, frame: &str) {
        match FromProgram::parse(frame) {
            Some(FromProgram::Print(text)) => self.show_last(current, "print", text),
            Some(FromProgram::Info(text)) => self.show_last(current, "info", text),
            Some(FromProgram::Error(text)) => {
                current.has_reported_error = true;
                self.show_last(current, "error", text);
            }
            Some(
                FromProgram::Events
                | FromProgram::Mailbox(_)
                | FromProgram::Web(_)
                | FromProgram::Watch { .. }
                | FromProgram::Changed { .. }
                | FromProgram::Debug { .. }
                | FromProgram::DebugLog(_)
                | FromProgram::Question { .. },
            )
            | None => {}
        }
    }

    pub(super) fn show_last(&self, current: &mut Current, kind: &str, text: &str) {
        if text.len() <= limits::MESSAGE_BYTES {
            let shown = current
                .meter
                .offer(format!("{kind}: {text}"), Instant::now());
            if let Some(message) = shown {
                self.say(&message);
            }
        }
    }
}
