//! The `log`: what converters and the filesystem itself have to say, as lines that can be followed.
//!
//! Owns the bytes kept (the newest [`limits::LOG_BYTES`]) and their positions, which count from the mount on and
//! never go back, so that `tail -f` works.

use crate::clock::Stamp;
use crate::events::{Ready, lock};
use crate::limits;
use std::collections::VecDeque;
use std::sync::{Mutex, Weak};

/// The lines of one mount.
pub struct Log {
    start: Stamp,
    kept: Mutex<Kept>,
    readers: Mutex<Vec<Weak<dyn Ready>>>,
}

#[derive(Default)]
struct Kept {
    bytes: VecDeque<u8>,
    /// Position of the first byte kept.
    first: u64,
}

impl Log {
    /// An empty log; its times count from here.
    pub fn new() -> Self {
        Self {
            start: Stamp::now(),
            kept: Mutex::default(),
            readers: Mutex::default(),
        }
    }

    /// Adds one line, with the seconds since the mount in front. Control characters become spaces.
    pub fn line(&self, text: &str) {
        let ms = self.start.age_ns() / 1_000_000;
        let mut line = format!("[{:6}.{:03}] ", ms / 1000, ms % 1000);
        let visible = text.chars().map(|c| if c.is_control() { ' ' } else { c });
        let room = config::limits::LOG_LINE_BYTES_MAX;
        line.extend(visible.take(room));
        line.push('\n');
        {
            let mut kept = lock(&self.kept);
            kept.bytes.extend(line.as_bytes());
            while kept.bytes.len() > limits::LOG_BYTES {
                // Whole lines go, so that what is kept begins with one.
                let end = kept
                    .bytes
                    .iter()
                    .position(|&byte| byte == b'\n')
                    .map_or(kept.bytes.len(), |at| at + 1);
                kept.bytes.drain(..end);
                kept.first += end as u64;
            }
        }
        let readers: Vec<_> = lock(&self.readers)
            .iter()
            .filter_map(Weak::upgrade)
            .collect();
        for reader in readers {
            reader.ready();
        }
    }

    /// Calls a reader at every line, for as long as it lives.
    pub fn follow(&self, reader: Weak<dyn Ready>) {
        let mut readers = lock(&self.readers);
        readers.retain(|other| other.strong_count() > 0);
        readers.push(reader);
    }

    /// Bytes written so far, dropped ones included.
    pub fn end(&self) -> u64 {
        let kept = lock(&self.kept);
        kept.first + kept.bytes.len() as u64
    }

    /// Copies from a position; one that was dropped already becomes the first that is kept.
    /// Returns the position really read from and the number of bytes.
    pub fn read_at(&self, position: u64, out: &mut [u8]) -> (u64, usize) {
        let kept = lock(&self.kept);
        let from = position.max(kept.first);
        let skip = usize::try_from(from - kept.first)
            .unwrap_or(usize::MAX)
            .min(kept.bytes.len());
        let n = out.len().min(kept.bytes.len() - skip);
        for (to, byte) in out.iter_mut().zip(kept.bytes.range(skip..skip + n)) {
            *to = *byte;
        }
        (from, n)
    }
}

impl Default for Log {
    fn default() -> Self {
        Self::new()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn old_lines_go_whole_and_positions_stay() {
        let log = Log::new();
        for number in 0..5000 {
            log.line(&format!("line {number}"));
        }
        let mut out = vec![0; limits::LOG_BYTES];
        let (from, n) = log.read_at(0, &mut out);
        assert_eq!(from + n as u64, log.end());
        assert_eq!(out[0], b'[');
        let text = std::str::from_utf8(&out[..n]).unwrap();
        assert!(text.ends_with("line 4999\n"));
        assert_eq!(log.read_at(log.end(), &mut out).1, 0);
    }

    #[test]
    fn a_line_stays_one_line() {
        let log = Log::new();
        log.line("a\nb\u{1b}[31m");
        let mut out = [0; 64];
        let (_, n) = log.read_at(0, &mut out);
        assert!(
            std::str::from_utf8(&out[..n])
                .unwrap()
                .ends_with("a b [31m\n")
        );
    }
}
