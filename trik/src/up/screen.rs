//! A few lines on a terminal that are drawn again and again in place, and messages above them.
//!
//! Owns the state of the terminal: typed characters are not shown and the cursor is hidden while the lines are there,
//! and both come back with `leave` or in Drop. Draws nothing while the program is in the background. What the lines say
//! is not its business.

use nix::sys::termios::{LocalFlags, SetArg, Termios, tcgetattr, tcsetattr};
use nix::unistd::{getpgrp, tcgetpgrp};
use std::io::{self, IsTerminal, Write};
use terminal_size::{Height, Width, terminal_size_of};

/// A terminal with lines at its end.
pub(super) struct Screen {
    /// The terminal as it was, while it is changed.
    saved: Option<Termios>,
    /// Keys are taken one by one, and not as lines.
    has_keys: bool,
    /// Lengths of the lines that are shown now.
    shown: Vec<usize>,
}

impl Screen {
    /// Nothing if standard output is not a terminal on which lines can be drawn anew.
    pub(super) fn new(has_keys: bool) -> Option<Self> {
        let can_move = std::env::var_os("TERM").is_some_and(|name| name != "dumb");
        (can_move && io::stdout().is_terminal()).then(|| Self {
            saved: None,
            has_keys,
            shown: Vec::new(),
        })
    }

    /// Shows these lines instead of the last ones, as much of them as there is room for.
    pub(super) fn draw(&mut self, lines: &[String]) {
        if !self.enter() {
            return;
        }
        let (width, height) = size();
        let (text, shown) = frame(&self.shown, lines, width, height);
        self.shown = shown;
        say(&text);
    }

    /// A line that stays, above the others, which come back with the next `draw`.
    pub(super) fn note(&mut self, line: &str) {
        let (width, height) = size();
        let (text, _) = frame(&self.shown, &[], width, height);
        self.shown.clear();
        say(&format!("{text}{line}\n"));
    }

    /// Whether the terminal is in our hands now, so that keys are typed for us.
    pub(super) fn is_ours(&self) -> bool {
        self.saved.is_some() && is_foreground()
    }

    /// Gives the terminal back as it was; the last lines stay on it.
    pub(super) fn leave(&mut self) {
        self.shown.clear();
        let Some(saved) = self.saved.take() else {
            return;
        };
        say("\x1b[?25h");
        // A process in the background has no terminal to give back, and would be stopped for trying.
        if is_foreground() {
            // Without what was typed meanwhile: nobody saw it, and a shell would run it.
            let _ = tcsetattr(io::stdout(), SetArg::TCSAFLUSH, &saved);
        }
    }

    /// True if the terminal is ours to draw on.
    fn enter(&mut self) -> bool {
        if !is_foreground() {
            return false;
        }
        if self.saved.is_none()
            && let Ok(found) = tcgetattr(io::stdout())
        {
            let mut quiet = found.clone();
            quiet.local_flags.remove(LocalFlags::ECHO);
            if self.has_keys {
                quiet.local_flags.remove(LocalFlags::ICANON);
            }
            let _ = tcsetattr(io::stdout(), SetArg::TCSADRAIN, &quiet);
            self.saved = Some(found);
            say("\x1b[?25l");
        }
        true
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        self.leave();
    }
}

fn is_foreground() -> bool {
    tcgetpgrp(io::stdout()).is_ok_and(|group| group == getpgrp())
}

/// Columns and rows.
fn size() -> (usize, usize) {
    match terminal_size_of(io::stdout()) {
        Some((Width(width), Height(height))) if width > 0 && height > 0 => {
            (width.into(), height.into())
        }
        _ => (80, 24),
    }
}

fn say(text: &str) {
    // A terminal that is gone tells so with SIGHUP.
    let mut out = io::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}

/// What to send so that `lines` stand where lines of the lengths `shown` stood, and the lengths of those that now do.
/// A terminal that has become narrower has broken the old ones into several rows.
fn frame(shown: &[usize], lines: &[String], width: usize, height: usize) -> (String, Vec<usize>) {
    let rows: usize = shown
        .iter()
        .map(|length| length.div_ceil(width).max(1))
        .sum();
    let mut text = String::new();
    match rows.min(height) {
        0 => {}
        up => text.push_str(&format!("\x1b[{up}A\r")),
    }
    let mut lengths = Vec::new();
    // One row is for the cursor after the last line.
    for line in lines.iter().take(height.saturating_sub(1)) {
        // The last column stays free: what a terminal does after it differs.
        let line: String = line.chars().take(width.saturating_sub(1)).collect();
        lengths.push(line.chars().count());
        text.push_str(&format!("{line}\x1b[K\n"));
    }
    if rows > 0 {
        text.push_str("\x1b[J");
    }
    (text, lengths)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(texts: &[&str]) -> Vec<String> {
        texts.iter().map(|text| (*text).to_owned()).collect()
    }

    #[test]
    fn lines_are_cut_to_the_terminal() {
        let (text, shown) = frame(&[], &lines(&["abcdef", "g", "h"]), 5, 3);
        assert_eq!(text, "abcd\x1b[K\ng\x1b[K\n");
        assert_eq!(shown, [4, 1]);
    }

    #[test]
    fn the_next_lines_stand_where_the_last_stood() {
        let (text, _) = frame(&[4, 1], &lines(&["x"]), 80, 24);
        assert_eq!(text, "\x1b[2A\rx\x1b[K\n\x1b[J");
        // 10 columns have become 4: rows of 4, 4, 2.
        let (text, _) = frame(&[10, 0], &lines(&["x"]), 4, 24);
        assert!(text.starts_with("\x1b[4A\r"), "{text:?}");
    }

    #[test]
    fn a_message_takes_the_lines_away() {
        assert_eq!(frame(&[4, 1], &[], 80, 24).0, "\x1b[2A\r\x1b[J");
        assert_eq!(frame(&[], &[], 80, 24).0, "");
    }
}
