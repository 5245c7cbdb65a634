//! Writes JSON (RFC 8259) for programs, on robots too, where no library for it is.
//!
//! Owns how texts and objects are written. Knows nothing of reading it but whether a text is JSON.

mod grammar;

pub use grammar::is_json;

use std::fmt::{Display, Write};

/// A JSON string, cut after so many characters.
pub fn quoted(text: &str, characters_max: usize) -> String {
    let mut quoted = "\"".to_owned();
    for letter in text.chars().take(characters_max) {
        match letter {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            letter if u32::from(letter) < 0x20 => {
                let _ = write!(quoted, "\\u{:04x}", u32::from(letter));
            }
            letter => quoted.push(letter),
        }
    }
    quoted.push('"');
    quoted
}

/// An object that grows member by member.
#[derive(Clone, Debug)]
pub struct Object {
    text: String,
    characters_max: usize,
}

impl Object {
    /// Without members; texts in it are cut after so many characters.
    pub fn new(characters_max: usize) -> Self {
        Self {
            text: "{".to_owned(),
            characters_max,
        }
    }

    fn name(&mut self, name: &str) {
        if self.text.len() > 1 {
            self.text.push(',');
        }
        self.text.push_str(&quoted(name, self.characters_max));
        self.text.push(':');
    }

    /// With one more member, a text.
    #[must_use]
    pub fn text(mut self, name: &str, text: &str) -> Self {
        self.name(name);
        self.text.push_str(&quoted(text, self.characters_max));
        self
    }

    /// With one more member that is JSON as it is written: a number, a truth, an object.
    #[must_use]
    pub fn plain(mut self, name: &str, json: impl Display) -> Self {
        self.name(name);
        let _ = write!(self.text, "{json}");
        self
    }

    /// With one more member, a list of what is JSON as it is written.
    #[must_use]
    pub fn list(mut self, name: &str, items: impl IntoIterator<Item = String>) -> Self {
        self.name(name);
        self.text.push('[');
        for (index, item) in items.into_iter().enumerate() {
            if index > 0 {
                self.text.push(',');
            }
            self.text.push_str(&item);
        }
        self.text.push(']');
        self
    }

    /// The whole object.
    #[must_use]
    pub fn done(mut self) -> String {
        self.text.push('}');
        self.text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn objects_are_json_whatever_they_hold() {
        let inner = Object::new(10).done();
        let text = Object::new(10)
            .text("a\"b", "\\\n\u{1}\u{43f}")
            .plain("n", 1.5)
            .list("l", [inner, quoted("0123456789abc", 10)])
            .done();
        assert_eq!(
            text,
            "{\"a\\\"b\":\"\\\\\\n\\u0001\u{43f}\",\"n\":1.5,\"l\":[{},\"0123456789\"]}"
        );
        assert!(is_json(&text));
    }
}
