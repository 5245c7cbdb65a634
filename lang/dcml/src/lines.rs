//! Bytes of a text to lines and columns, and back.
//!
//! Owns the counting. A line ends with a line feed; columns count characters, for people, or units of UTF-16, for editors.

use super::syntax::Span;

/// Where something stands, as people count: from 1.
#[derive(Clone, Copy, Debug, Eq, PartialEq, Ord, PartialOrd)]
pub struct Place {
    /// Line.
    pub line: usize,
    /// Characters from the beginning of the line.
    pub column: usize,
}

/// The beginnings of all lines of a text.
#[derive(Clone, Debug)]
pub struct Lines<'a> {
    text: &'a str,
    starts: Vec<u32>,
}

impl<'a> Lines<'a> {
    /// Of a text no longer than [`crate::limits::DCML_TEXT_MAX`].
    pub fn of(text: &'a str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n');
        let next = ends.map(|(at, _)| u32::try_from(at + 1).unwrap_or(u32::MAX));
        Self {
            text,
            starts: std::iter::once(0).chain(next).collect(),
        }
    }

    /// How many lines; the last one may be empty.
    pub fn count(&self) -> usize {
        self.starts.len()
    }

    /// The line of a byte, from 0. Behind the end it is the last one.
    pub fn line(&self, offset: u32) -> usize {
        self.starts.partition_point(|start| *start <= offset) - 1
    }

    /// Where a line stands, from 0, without what ends it.
    pub fn span(&self, line: usize) -> Span {
        let end_of_text = u32::try_from(self.text.len()).unwrap_or(u32::MAX);
        let start = self.starts.get(line).copied().unwrap_or(end_of_text);
        let next = self.starts.get(line + 1).copied();
        let end = next.map_or(end_of_text, |next| next - 1);
        let is_return = end > start && self.text.as_bytes().get(end as usize - 1) == Some(&b'\r');
        let end = if is_return && next.is_some() {
            end - 1
        } else {
            end
        };
        Span { start, end }
    }

    /// The place of a byte.
    pub fn place(&self, offset: u32) -> Place {
        let line = self.line(offset);
        Place {
            line: line + 1,
            column: self.before(line, offset).chars().count() + 1,
        }
    }

    /// The place of a byte as editors count: line and units of UTF-16, both from 0.
    pub fn utf16(&self, offset: u32) -> (usize, usize) {
        let line = self.line(offset);
        let units = self.before(line, offset).chars().map(char::len_utf16);
        (line, units.sum())
    }

    /// The byte of such a place: after the end of a line it is that end, after the last line the end of the text.
    pub fn offset(&self, line: usize, unit: usize) -> u32 {
        let span = self.span(line);
        let text = super::lexer::slice(self.text, span);
        let mut left = unit;
        let mut at = span.start;
        for sign in text.chars() {
            if left < sign.len_utf16() {
                break;
            }
            left -= sign.len_utf16();
            at += u32::try_from(sign.len_utf8()).unwrap_or_default();
        }
        at
    }

    /// The line before a byte of it. A byte inside a character counts as that character's first.
    fn before(&self, line: usize, offset: u32) -> &str {
        let start = self.starts.get(line).copied().unwrap_or_default() as usize;
        let mut end = (offset as usize).min(self.text.len());
        while !self.text.is_char_boundary(end) {
            end -= 1;
        }
        self.text.get(start..end).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_found_and_found_back() {
        let text = "a\r\n\u{3b8}\u{1F600}b\n";
        let lines = Lines::of(text);
        assert_eq!(lines.count(), 3);
        assert_eq!(lines.place(0), Place { line: 1, column: 1 });
        assert_eq!(lines.place(9), Place { line: 2, column: 3 });
        // Inside the second character.
        assert_eq!(lines.place(6), Place { line: 2, column: 2 });
        assert_eq!(lines.utf16(9), (1, 3));
        assert_eq!(lines.span(0), Span { start: 0, end: 1 });
        for (at, _) in text.char_indices().filter(|(_, sign)| !sign.is_control()) {
            let at = u32::try_from(at).unwrap();
            let (line, unit) = lines.utf16(at);
            assert_eq!(lines.offset(line, unit), at);
        }
        assert_eq!(lines.offset(0, 99), 1);
        assert_eq!(lines.offset(9, 0), u32::try_from(text.len()).unwrap());
        assert_eq!(lines.place(99), Place { line: 3, column: 1 });
    }
}
