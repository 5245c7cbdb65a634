//! An open document: its text as the editor has it, and what is known of it.
//!
//! Owns how changes are put in, and how places are counted: editors count lines and units of a line, in UTF-8, UTF-16 or
//! whole characters. Knows nothing of messages.

use crate::limits;
use lang_dcml::syntax::Span;
use lang_editor::Reading;
use ropey::Rope;
use std::cell::OnceCell;
use std::ops::Range;

/// How an editor counts columns.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Encoding {
    /// Bytes.
    Utf8,
    /// What every editor knows.
    #[default]
    Utf16,
    /// Characters.
    Utf32,
}

/// A place as editors say it, both from 0.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq, Ord, PartialOrd)]
pub struct Position {
    /// Line.
    pub line: usize,
    /// Units of the line before it.
    pub unit: usize,
}

/// A change as an editor says it.
#[derive(Clone, Debug, PartialEq)]
pub struct Change {
    /// What is replaced; nothing for all of the text.
    pub range: Option<(Position, Position)>,
    /// With what.
    pub text: String,
}

/// See the head of this file.
#[derive(Debug)]
pub struct Document {
    text: Rope,
    /// It became too long, and so it is not known any more.
    is_too_long: bool,
    reading: OnceCell<Reading>,
    /// What the editor calls this state of it.
    pub version: Option<i64>,
    /// It has changed since its diagnostics were told.
    pub is_new: bool,
}

impl Document {
    /// A document as it was opened.
    pub fn new(text: &str, version: Option<i64>) -> Self {
        let mut document = Self {
            text: Rope::new(),
            is_too_long: false,
            reading: OnceCell::new(),
            version,
            is_new: true,
        };
        document.replace(text);
        document
    }

    fn replace(&mut self, text: &str) {
        self.is_too_long = text.len() > limits::LSP_DOCUMENT_BYTES;
        self.text = if self.is_too_long {
            Rope::new()
        } else {
            Rope::from_str(text)
        };
    }

    /// Bytes of it that are kept.
    pub fn bytes(&self) -> usize {
        self.text.len_bytes()
    }

    /// Whether it is too long to be kept.
    pub fn is_too_long(&self) -> bool {
        self.is_too_long
    }

    /// Forgets the text, as if it were too long, until all of it comes again.
    pub fn forget(&mut self) {
        self.text = Rope::new();
        self.is_too_long = true;
        self.reading = OnceCell::new();
    }

    /// Puts a change in. Places after the end of a line or of the text are that end, those inside a character its
    /// beginning, and a range from back to front is turned round: so do editors.
    pub fn change(&mut self, change: &Change, encoding: Encoding) {
        (self.reading, self.is_new) = (OnceCell::new(), true);
        let Some((from, to)) = change.range else {
            return self.replace(&change.text);
        };
        if self.is_too_long {
            return;
        }
        let from = self.character(from, encoding);
        let to = self.character(to, encoding);
        let range = from.min(to)..from.max(to);
        if self.text.len_bytes() + change.text.len() > limits::LSP_DOCUMENT_BYTES {
            return self.forget();
        }
        self.text.remove(range.clone());
        self.text.insert(range.start, &change.text);
    }

    /// What is known of it; read when it is wanted first.
    pub fn reading(&self) -> &Reading {
        self.reading
            .get_or_init(|| Reading::of(self.text.to_string()))
    }

    /// The byte at a place.
    pub fn offset(&self, position: Position, encoding: Encoding) -> u32 {
        let byte = self.text.char_to_byte(self.character(position, encoding));
        u32::try_from(byte).unwrap_or(u32::MAX)
    }

    /// The bytes of a range.
    pub fn span(&self, (from, to): (Position, Position), encoding: Encoding) -> Span {
        let from = self.offset(from, encoding);
        let to = self.offset(to, encoding);
        Span {
            start: from.min(to),
            end: from.max(to),
        }
    }

    /// The place of a byte.
    pub fn position(&self, offset: u32, encoding: Encoding) -> Position {
        let text = &self.text;
        let byte = usize::try_from(offset)
            .unwrap_or(usize::MAX)
            .min(text.len_bytes());
        let at = text.byte_to_char(byte);
        let line = text.char_to_line(at);
        let start = text.line_to_char(line);
        let unit = match encoding {
            Encoding::Utf8 => text.char_to_byte(at) - text.line_to_byte(line),
            Encoding::Utf16 => text.char_to_utf16_cu(at) - text.char_to_utf16_cu(start),
            Encoding::Utf32 => at - start,
        };
        Position { line, unit }
    }

    /// The ends of a stretch.
    pub fn range(&self, span: Span, encoding: Encoding) -> (Position, Position) {
        (
            self.position(span.start, encoding),
            self.position(span.end, encoding),
        )
    }

    /// The parts of a stretch that stand on one line each, without the ends of lines.
    pub fn by_lines(&self, span: Span) -> impl Iterator<Item = Span> {
        let (start, end) = (byte(span.start), byte(span.end).min(self.text.len_bytes()));
        let lines = if start < end {
            self.text.byte_to_line(start)..self.text.byte_to_line(end) + 1
        } else {
            0..0
        };
        lines.filter_map(move |line| {
            let line = self.line(line);
            let from = self.text.char_to_byte(line.start).max(start);
            let to = self.text.char_to_byte(line.end).min(end);
            let small = |at: usize| u32::try_from(at).unwrap_or(u32::MAX);
            (from < to).then(|| Span {
                start: small(from),
                end: small(to),
            })
        })
    }

    /// Lets go what is known of it; it is found out again when it is wanted.
    pub fn rest(&mut self) {
        self.reading = OnceCell::new();
    }

    /// Whether something is known of it that takes memory.
    pub fn is_read(&self) -> bool {
        self.reading.get().is_some()
    }

    /// The characters of a line without what ends it.
    fn line(&self, line: usize) -> Range<usize> {
        let start = self.text.line_to_char(line);
        let mut end = start + self.text.line(line).len_chars();
        while end > start && matches!(self.text.char(end - 1), '\r' | '\n') {
            end -= 1;
        }
        start..end
    }

    fn character(&self, position: Position, encoding: Encoding) -> usize {
        let text = &self.text;
        if position.line >= text.len_lines() {
            return text.len_chars();
        }
        let line = self.line(position.line);
        match encoding {
            Encoding::Utf8 => {
                let (start, end) = (text.char_to_byte(line.start), text.char_to_byte(line.end));
                text.byte_to_char(start.saturating_add(position.unit).min(end))
            }
            Encoding::Utf16 => {
                let (start, end) = (
                    text.char_to_utf16_cu(line.start),
                    text.char_to_utf16_cu(line.end),
                );
                text.utf16_cu_to_char(start.saturating_add(position.unit).min(end))
            }
            Encoding::Utf32 => line.start.saturating_add(position.unit).min(line.end),
        }
    }
}

fn byte(offset: u32) -> usize {
    usize::try_from(offset).unwrap_or(usize::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use Encoding::{Utf8, Utf16, Utf32};

    fn at(line: usize, unit: usize) -> Position {
        Position { line, unit }
    }

    fn edited(text: &str, from: Position, to: Position, put: &str, encoding: Encoding) -> String {
        let mut document = Document::new(text, None);
        let change = Change {
            range: Some((from, to)),
            text: put.to_owned(),
        };
        document.change(&change, encoding);
        document.reading().text().to_owned()
    }

    #[test]
    fn columns_are_counted_as_the_editor_counts() {
        let text = "a\n// \u{3b8}\u{1F600}b\r\nc";
        let document = Document::new(text, None);
        let b = u32::try_from(text.find('b').unwrap()).unwrap();
        for (encoding, unit) in [(Utf8, 9), (Utf16, 6), (Utf32, 5)] {
            assert_eq!(document.position(b, encoding), at(1, unit));
            assert_eq!(document.offset(at(1, unit), encoding), b);
            assert_eq!(document.offset(at(1, 99), encoding), b + 1);
            assert_eq!(document.offset(at(9, 0), encoding), b + 4);
        }
        // Inside a surrogate pair, and inside the bytes of a character.
        assert_eq!(document.offset(at(1, 5), Utf16), b - 4);
        assert_eq!(document.offset(at(1, 6), Utf8), b - 4);
        assert_eq!(document.position(b - 1, Utf16), at(1, 4));
    }

    #[test]
    fn changes_from_nowhere_to_nowhere_harm_nobody() {
        assert_eq!(edited("ab\ncd", at(0, 1), at(1, 1), "X", Utf16), "aXd");
        assert_eq!(edited("ab\ncd", at(1, 1), at(0, 1), "X", Utf16), "aXd");
        assert_eq!(edited("ab\ncd", at(7, 7), at(9, 9), "X", Utf16), "ab\ncdX");
        assert_eq!(
            edited("\u{1F600}", at(0, 1), at(0, 1), "X", Utf16),
            "X\u{1F600}"
        );
        assert_eq!(
            edited("", at(0, 0), at(usize::MAX, usize::MAX), "", Utf8),
            ""
        );
        assert_eq!(edited("a\rb", at(1, 0), at(1, 1), "X", Utf16), "a\rX");
    }

    #[test]
    fn a_text_that_becomes_too_long_is_forgotten_until_all_of_it_comes() {
        let mut document = Document::new("a", Some(1));
        let long = "x".repeat(limits::LSP_DOCUMENT_BYTES);
        let mut change = Change {
            range: Some((at(0, 0), at(0, 0))),
            text: long,
        };
        document.change(&change, Utf16);
        assert!(document.is_too_long() && document.bytes() == 0);
        (change.range, change.text) = (None, "b".to_owned());
        document.change(&change, Utf16);
        assert!(!document.is_too_long());
        assert_eq!(document.reading().text(), "b");
    }

    #[test]
    fn a_stretch_over_lines_has_a_part_on_each() {
        let text = "/* a\r\n\n b */ c";
        let document = Document::new(text, None);
        let parts = document.by_lines(Span { start: 0, end: 12 });
        let parts: Vec<&str> = parts
            .map(|one| &text[byte(one.start)..byte(one.end)])
            .collect();
        assert_eq!(parts, ["/* a", " b */"]);
    }
}
