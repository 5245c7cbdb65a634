//! What a terminal may be shown: names and texts from files without characters that it would obey.
//!
//! Owns which characters those are, and how much of a text is shown.

use crate::limits;
use std::path::Path;

/// A path for people.
pub(crate) fn named(path: &Path) -> String {
    harmless(&path.to_string_lossy())
}

/// One line that no terminal obeys: without control characters and those that turn the direction of writing.
pub(crate) fn harmless(text: &str) -> String {
    let is_turn = |c: char| matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    let mut shown = String::new();
    for (count, c) in text.trim_end().chars().enumerate() {
        if count == limits::SHOWN_CHARS_MAX {
            shown.push_str("...");
            break;
        }
        match c {
            '\n' | '\r' | '\t' => shown.push(' '),
            c if c.is_control() || is_turn(c) => shown.push('\u{fffd}'),
            c => shown.push(c),
        }
    }
    shown
}

/// The same of each line of a text.
pub(crate) fn harmless_lines(text: &str) -> String {
    text.lines().map(harmless).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_a_terminal_would_obey_are_shown_and_not_obeyed() {
        assert_eq!(
            harmless("a\x1b[2Jb\nc\u{202e}d"),
            "a\u{fffd}[2Jb c\u{fffd}d"
        );
        let long = harmless(&"x".repeat(10_000));
        assert_eq!(long.len(), limits::SHOWN_CHARS_MAX + 3);
        assert_eq!(harmless("ends\n"), "ends");
    }
}
