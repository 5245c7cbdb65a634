//! What the running program says, on its way to all clients.
//!
//! Owns what is held back, cut and dropped of it, what counts of a program that is dead, and what is reported of its rest.
//! `output` has the measures.

use super::output::{Manner, Message};
use super::rest;
use super::{Current, Supervisor};
use crate::protocol::program::FromProgram;
use crate::{limits, log};
use journal::write::Story;
use std::time::Instant;

impl Supervisor {
    /// Shows something that the program said, unless it says too much.
    pub(super) fn show(&mut self, manner: Manner, text: &str) {
        let Some(current) = &mut self.current else {
            return;
        };
        let now = Instant::now();
        let shown = current.meter.offer(Message::new(manner, cut(text)), now);
        self.show_held();
        if let Some(said) = shown {
            self.say(&said);
        }
    }

    /// Something that the program of now said, for all who hear.
    fn say(&self, said: &Message) {
        let name = self.current.as_ref().map_or("", |current| &current.name);
        self.report_output(said, name);
    }

    /// Something that the program with this name said.
    pub(super) fn report_output(&self, said: &Message, name: &str) {
        self.broadcast(&said.text);
        let record = &self.around.record;
        if record.is_heard() {
            record.level(Story::Output, said.manner.level(), name, &said.text);
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
        for said in held {
            self.say(&said);
        }
    }

    pub(super) fn report_dropped(&self, dropped: Option<u32>) {
        if let Some(count) = dropped {
            self.broadcast(&format!("info: {count} messages of the program were left out: it says more than {} a second", limits::OUTPUT_MESSAGES_PER_SECOND));
        }
    }

    /// How long the order to rest took, and what does not.
    pub(super) fn report_rest(&self, rested: Result<(), rest::Failure>, rest_us: u128) {
        let mut shown = self.around.programs.shown.borrow_mut();
        if shown.rests_us.len() >= limits::RESTS_SHOWN {
            shown.rests_us.pop_front();
        }
        shown.rests_us.push_back(rest_us);
        tracing::debug!(target: log::TREE, "at rest after {rest_us} us");
        if let Err(why) = rested {
            tracing::error!(target: log::TREE, "{why}");
            self.broadcast(&format!("error: {why}"));
        }
    }

    /// Where a debugger has stopped the program of now, for the status.
    pub(super) fn note_place(&self, place: Option<(u32, &str)>) {
        let place = place.map(|(line, file)| {
            let end = file.floor_char_boundary(limits::PLACE_BYTES);
            let name = file[..end].replace(char::is_control, " ");
            format!("{name} line {line}")
        });
        self.around.programs.shown.borrow_mut().place = place;
    }

    /// Of a program that is dead only what it wanted to show counts.
    pub(super) fn hear_last(&self, current: &mut Current, frame: &str) {
        match FromProgram::parse(frame) {
            Some(FromProgram::Print(text)) => self.show_last(current, Manner::Print, text),
            Some(FromProgram::Info(text)) => self.show_last(current, Manner::Info, text),
            Some(FromProgram::Error(text)) => {
                current.has_reported_error = true;
                if !text.is_empty() {
                    self.show_last(current, Manner::Error, text);
                }
            }
            Some(
                FromProgram::Events
                | FromProgram::Mailbox(_)
                | FromProgram::Web(_)
                | FromProgram::Watch { .. }
                | FromProgram::Changed { .. }
                | FromProgram::Debug { .. }
                | FromProgram::DebugLog(_)
                | FromProgram::Question { .. }
                | FromProgram::Stopped(_),
            )
            | None => {}
        }
    }

    pub(super) fn show_last(&self, current: &mut Current, manner: Manner, text: &str) {
        if text.len() <= limits::MESSAGE_BYTES {
            let said = Message::new(manner, text);
            if let Some(said) = current.meter.offer(said, Instant::now()) {
                self.report_output(&said, &current.name);
            }
        }
    }
}

/// The beginning of a text that is longer than a message may be.
pub(super) fn cut(text: &str) -> &str {
    &text[..text.floor_char_boundary(limits::MESSAGE_BYTES)]
}
