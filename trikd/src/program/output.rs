//! What a program says, line by line, and not more of it than clients and network can take.
//!
//! Owns the splitting and the meter. Knows no processes.

use crate::limits;
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

/// Lets so many messages and bytes through in a second, and counts the others.
#[derive(Debug)]
pub struct Meter {
    messages: f64,
    bytes: f64,
    at: Instant,
    dropped: u32,
    dropped_since: Option<Instant>,
}

impl Default for Meter {
    fn default() -> Self {
        Self {
            messages: limits::OUTPUT_MESSAGES_PER_SECOND,
            bytes: limits::OUTPUT_BYTES_PER_SECOND,
            at: Instant::now(),
            dropped: 0,
            dropped_since: None,
        }
    }
}

impl Meter {
    /// Whether a message of this size may pass now.
    pub fn admits(&mut self, size: usize, now: Instant) -> bool {
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
        } else {
            self.dropped = self.dropped.saturating_add(1);
            self.dropped_since.get_or_insert(now);
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

    #[test]
    fn a_flood_is_cut_and_counted() {
        let mut meter = Meter::default();
        let start = Instant::now();
        let passed = (0..10_000).filter(|_| meter.admits(10, start)).count();
        assert_eq!(
            f64::from(u32::try_from(passed).unwrap()),
            limits::OUTPUT_MESSAGES_PER_SECOND
        );
        assert_eq!(meter.take_dropped(start, false), None);
        let later = start + Duration::from_secs(2);
        assert!(meter.admits(10, later));
        assert_eq!(
            meter.take_dropped(later, false),
            Some(10_000 - u32::try_from(passed).unwrap())
        );
        assert_eq!(meter.take_dropped(later, true), None);
    }
}
