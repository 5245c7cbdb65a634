//! Lines for the person who looks after the robot, on standard error.
//!
//! Owns their form and the limit of how many there are: a hostile client must not fill a disk.

use crate::limits;
use std::cell::Cell;
use std::io::Write;
use std::time::{Duration, Instant};

/// Where lines go.
#[derive(Debug)]
pub struct Log {
    start: Instant,
    window: Cell<(Instant, u32)>,
}

impl Default for Log {
    fn default() -> Self {
        let now = Instant::now();
        Self {
            start: now,
            window: Cell::new((now, 0)),
        }
    }
}

impl Log {
    /// Writes one line with the seconds since the start; too many in a second are left out, and the last one says so.
    pub fn line(&self, text: impl std::fmt::Display) {
        let now = Instant::now();
        let (mut since, mut count) = self.window.get();
        if now.duration_since(since) >= Duration::from_secs(1) {
            (since, count) = (now, 0);
        }
        count = count.saturating_add(1);
        self.window.set((since, count));
        let time = self.start.elapsed().as_secs_f64();
        if count < limits::LOG_LINES_PER_SECOND {
            // Nobody may be listening.
            let _ = writeln!(
                std::io::stderr(),
                "trikd: {time:.3}: {}",
                printable(&text.to_string())
            );
        } else if count == limits::LOG_LINES_PER_SECOND {
            let _ = writeln!(
                std::io::stderr(),
                "trikd: {time:.3}: more lines in this second are left out"
            );
        }
    }
}

/// One line outside of any log. Nobody may be listening.
pub fn tell(text: impl std::fmt::Display) {
    let _ = writeln!(std::io::stderr(), "trikd: {text}");
}

/// Text of strangers on one line and of a bearable length.
pub fn printable(text: &str) -> String {
    let mut short: String = text.chars().take(limits::LOG_LINE_CHARACTERS).collect();
    if short.len() < text.len() {
        short.push_str("...");
    }
    short
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect()
}
