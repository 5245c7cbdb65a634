//! Places in a text, between bytes and the UTF-16 units in which JavaScript counts.
//!
//! Owns the table of letters that take more than one byte; a text without any needs none.

use lang_dcml::syntax::Span;
use serde_json::{Value, json};

/// Places of one text.
#[derive(Clone, Debug, Default)]
pub struct Units {
    long: Vec<Letter>,
    bytes: u32,
}

/// A letter of more than one byte: where it begins and ends, in both counts.
#[derive(Clone, Copy, Debug)]
struct Letter {
    from: Ends,
    to: Ends,
}

/// A place in both counts.
#[derive(Clone, Copy, Debug, Default)]
struct Ends {
    byte: u32,
    unit: u32,
}

impl Units {
    /// Those of a text, which is no longer than 4 GiB.
    pub fn of(text: &str) -> Self {
        let mut at = Ends::default();
        let mut long = Vec::new();
        for letter in text.chars() {
            let to = Ends {
                byte: at.byte + letter.len_utf8() as u32,
                unit: at.unit + letter.len_utf16() as u32,
            };
            if !letter.is_ascii() {
                long.push(Letter { from: at, to });
            }
            at = to;
        }
        Self {
            long,
            bytes: at.byte,
        }
    }

    /// The end of the last long letter before a place, of which `is_before` knows.
    fn begin(&self, is_before: impl Fn(&Letter) -> bool) -> (usize, Ends) {
        let at = self.long.partition_point(is_before);
        let begin = at.checked_sub(1).map(|before| self.long[before].to);
        (at, begin.unwrap_or_default())
    }

    /// The unit before which a byte stands.
    pub fn unit(&self, byte: u32) -> u32 {
        let (_, begin) = self.begin(|letter| letter.to.byte <= byte);
        begin.unit + (byte - begin.byte)
    }

    /// The byte of a unit; the end of the letter for one inside of it, and that of the text for one beyond.
    pub fn byte(&self, unit: u32) -> u32 {
        let (at, begin) = self.begin(|letter| letter.to.unit <= unit);
        match self.long.get(at) {
            Some(letter) if letter.from.unit < unit => letter.to.byte,
            Some(_) | None => begin.byte.saturating_add(unit - begin.unit).min(self.bytes),
        }
    }

    /// A place as an array of both ends.
    pub fn place(&self, span: Span) -> Value {
        json!([self.unit(span.start), self.unit(span.end)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_those_of_the_text_in_units_of_two_bytes() {
        let text = "a\u{e9}b\u{1f916}\u{20ac}c";
        let units = Units::of(text);
        let wide: Vec<u16> = text.encode_utf16().collect();
        for (byte, _) in text.char_indices().chain([(text.len(), ' ')]) {
            let unit = text[..byte].encode_utf16().count() as u32;
            assert_eq!(units.unit(byte as u32), unit, "{byte}");
            assert_eq!(units.byte(unit), byte as u32, "{unit}");
        }
        // Between both halves of the robot, and far away.
        assert_eq!(units.byte(4), 8);
        assert_eq!(units.byte(wide.len() as u32 + 1), text.len() as u32);
        assert_eq!(units.byte(u32::MAX), text.len() as u32);
        assert_eq!(Units::of("plain").byte(3), 3);
    }
}
