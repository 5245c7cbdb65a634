//! What a program says, line by line, and not more of it than clients and network can take.
//!
//! Owns the splitting, the meter, and which messages of a burst are left out: those in its middle. Knows no processes.

use crate::limits;
use journal::standard::Level;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Bytes of a pipe on their way to lines.
#[derive(Debug, Default)]
pub struct Lines {
    rest: Vec<u8>,
}

impl Lines {
    /// Takes the next bytes and hands over the lines that are whole, with their newline; longer ones come in pieces.
    pub fn feed(&mut self, bytes: &[u8], mut take: impl FnMut(&str)) {
        for mut piece in bytes.split_inclusive(|byte| *byte == b'\n') {
            while !piece.is_empty() {
                let (part, left) =
                    piece.split_at(piece.len().min(limits::LINE_BYTES - self.rest.len()));
                piece = left;
                self.rest.extend_from_slice(part);
                if part.ends_with(b"\n") || self.rest.len() == limits::LINE_BYTES {
                    let end = self.cut();
                    take(&String::from_utf8_lossy(&self.rest[..end]));
                    self.rest.drain(..end);
                }
            }
        }
    }

    /// Not within a character, if that can be.
    fn cut(&self) -> usize {
        let end = self.rest.len();
        let begins = |byte: &u8| byte & 0xc0 != 0x80;
        match self.rest.iter().rev().take(4).position(begins) {
            Some(back) if self.rest[end - 1 - back] >= 0xc0 && end > back + 1 => {
                let size = match self.rest[end - 1 - back] {
                    0xc0..=0xdf => 2,
                    0xe0..=0xef => 3,
                    _ => 4,
                };
                if back + 1 < size { end - 1 - back } else { end }
            }
            _ => end,
        }
    }

    /// What is left when nothing more comes.
    pub fn finish(&mut self, mut take: impl FnMut(&str)) {
        if !self.rest.is_empty() {
            take(&String::from_utf8_lossy(&self.rest));
            self.rest.clear();
        }
    }
}

/// How a program says something.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Manner {
    /// It prints a line.
    Print,
    /// It tells clients something.
    Info,
    /// It tells them what went wrong.
    Error,
}

impl Manner {
    /// What the message begins with.
    fn word(self) -> &'static str {
        match self {
            Self::Print => "print",
            Self::Info => "info",
            Self::Error => "error",
        }
    }

    /// What it is in a recording.
    pub fn level(self) -> Level {
        match self {
            Self::Print | Self::Info => Level::Info,
            Self::Error => Level::Error,
        }
    }
}

/// One message of a program for all clients.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// How it is said.
    pub manner: Manner,
    /// What clients get.
    pub text: String,
}

impl Message {
    /// This text, with the word in front that clients know it by.
    pub fn new(manner: Manner, text: &str) -> Self {
        let text = format!("{}: {text}", manner.word());
        Self { manner, text }
    }
}

/// Lets so many messages and bytes through in a second, holds the newest of the others, and counts those that are lost.
#[derive(Debug)]
pub struct Meter {
    messages: f64,
    bytes: f64,
    at: Instant,
    held: VecDeque<Message>,
    held_bytes: usize,
    dropped: u32,
    dropped_since: Option<Instant>,
}

impl Default for Meter {
    fn default() -> Self {
        Self {
            messages: limits::OUTPUT_MESSAGES_PER_SECOND,
            bytes: limits::OUTPUT_BYTES_PER_SECOND,
            at: Instant::now(),
            held: VecDeque::new(),
            held_bytes: 0,
            dropped: 0,
            dropped_since: None,
        }
    }
}

impl Meter {
    /// Takes a message: gives it back if it may pass now, else holds it until [`Meter::release`].
    pub fn offer(&mut self, said: Message, now: Instant) -> Option<Message> {
        let size = said.text.len();
        if self.held.is_empty() && self.admits(size, now) {
            return Some(said);
        }
        self.held_bytes += size;
        self.held.push_back(said);
        while self.held.len() > limits::OUTPUT_HELD_MESSAGES
            || self.held_bytes > limits::OUTPUT_HELD_BYTES
        {
            let Some(oldest) = self.held.pop_front() else {
                break;
            };
            self.held_bytes -= oldest.text.len();
            self.dropped = self.dropped.saturating_add(1);
            self.dropped_since.get_or_insert(now);
        }
        None
    }

    /// The next message that was held, if it may pass now or nothing more comes. What was lost before it is told first:
    /// until [`Meter::take_dropped`] has said how much that was, it waits.
    pub fn release(&mut self, now: Instant, is_over: bool) -> Option<Message> {
        let size = self.held.front()?.text.len();
        if !is_over && (self.dropped_since.is_some() || !self.admits(size, now)) {
            return None;
        }
        self.held_bytes -= size;
        self.held.pop_front()
    }

    /// Whether a message of this size may pass now.
    fn admits(&mut self, size: usize, now: Instant) -> bool {
        let passed = now.saturating_duration_since(self.at).as_secs_f64();
        self.at = now;
        let refill = |left: f64, per_second: f64| (left + passed * per_second).min(per_second);
        self.messages = refill(self.messages, limits::OUTPUT_MESSAGES_PER_SECOND);
        self.bytes = refill(self.bytes, limits::OUTPUT_BYTES_PER_SECOND);
        let size = u32::try_from(size).map_or(f64::INFINITY, f64::from);
        // A long message passes when the bucket is full, and leaves a debt.
        let passes =
            self.messages >= 1.0 && self.bytes >= size.min(limits::OUTPUT_BYTES_PER_SECOND);
        if passes {
            self.messages -= 1.0;
            self.bytes -= size;
        }
        passes
    }

    /// How many were dropped, if that is some time ago or nothing more comes.
    pub fn take_dropped(&mut self, now: Instant, is_over: bool) -> Option<u32> {
        let since = self.dropped_since?;
        if !is_over && now.saturating_duration_since(since) < Duration::from_secs(1) {
            return None;
        }
        self.dropped_since = None;
        Some(std::mem::take(&mut self.dropped))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(pieces: &[&[u8]]) -> Vec<String> {
        let mut lines = Lines::default();
        let mut got = Vec::new();
        for piece in pieces {
            lines.feed(piece, |line| got.push(line.to_owned()));
        }
        lines.finish(|line| got.push(line.to_owned()));
        got
    }

    #[test]
    fn lines_come_whole_and_the_last_one_too() {
        assert_eq!(
            lines(&[b"a\nb", b"c\n\n", b"d"]),
            ["a\n", "bc\n", "\n", "d"]
        );
        assert_eq!(lines(&[b"\xd0", b"\xb0\n"]), ["\u{430}\n"]);
        assert_eq!(lines(&[b"\xff\n"]), ["\u{fffd}\n"]);
    }

    #[test]
    fn a_line_without_an_end_comes_in_pieces_of_whole_characters() {
        let text = "\u{430}".repeat(limits::LINE_BYTES);
        let got = lines(&[&b"x"[..], text.as_bytes()]);
        assert_eq!(got.concat(), format!("x{text}"));
        assert!(got.iter().all(|line| line.len() <= limits::LINE_BYTES));
    }

    /// All that comes out now.
    fn released(meter: &mut Meter, now: Instant, is_over: bool) -> Vec<String> {
        let all = std::iter::from_fn(|| meter.release(now, is_over));
        all.map(|said| said.text).collect()
    }

    /// What comes of a printed text.
    fn offered(meter: &mut Meter, text: &str, now: Instant) -> Option<String> {
        let passed = meter.offer(Message::new(Manner::Print, text), now);
        passed.map(|said| said.text)
    }

    #[test]
    fn only_an_error_is_one_whatever_its_text_is() {
        let said = Message::new(Manner::Print, "error: 5");
        assert_eq!(said.text, "print: error: 5");
        assert_eq!(said.manner.level(), Level::Info);
        assert_eq!(Manner::Error.level(), Level::Error);
    }

    #[test]
    fn a_flood_loses_its_middle_which_is_counted() {
        let mut meter = Meter::default();
        let start = Instant::now();
        let all = (0..10_000).filter_map(|number| offered(&mut meter, &number.to_string(), start));
        let passed: Vec<_> = all.collect();
        let count = limits::OUTPUT_MESSAGES_PER_SECOND as usize;
        assert_eq!((passed.len(), &*passed[count - 1]), (count, "print: 999"));
        assert_eq!(meter.take_dropped(start, false), None);
        assert!(released(&mut meter, start, false).is_empty());
        let soon = start + Duration::from_millis(900);
        assert!(
            released(&mut meter, soon, false).is_empty(),
            "before the count"
        );
        let later = start + Duration::from_secs(2);
        let lost = 10_000 - count - limits::OUTPUT_HELD_MESSAGES;
        assert_eq!(meter.take_dropped(later, false), u32::try_from(lost).ok());
        let last = released(&mut meter, later, false);
        assert_eq!(last.len(), limits::OUTPUT_HELD_MESSAGES);
        assert_eq!(last.last().map(String::as_str), Some("print: 9999"));
        assert_eq!(meter.take_dropped(later, true), None);
        assert_eq!(
            offered(&mut meter, "next", later).as_deref(),
            Some("print: next")
        );
    }

    #[test]
    fn at_the_end_all_that_is_held_comes_and_long_messages_are_held_by_their_bytes() {
        let mut meter = Meter::default();
        let start = Instant::now();
        while offered(&mut meter, &"x".repeat(60_000), start).is_some() {}
        assert_eq!(offered(&mut meter, &"y".repeat(60_000), start), None);
        let last = released(&mut meter, start, true);
        assert_eq!(last.len(), 1);
        assert!(last[0].starts_with("print: y"));
        assert_eq!(meter.take_dropped(start, true), Some(1));
    }
}
