//! Whether a text is JSON (RFC 8259), for tests and fuzzers of what is written here.
//!
//! Owns the grammar. Makes no values of it.

use crate::limits;

/// Whether a text is one value of JSON and nothing else, not nested deeper than [`limits::JSON_DEPTH_MAX`].
pub fn is_json(text: &str) -> bool {
    let mut rest = Rest(text.as_bytes());
    rest.value(limits::JSON_DEPTH_MAX).is_some() && rest.peek().is_none()
}

/// What is not read yet.
struct Rest<'a>(&'a [u8]);

impl Rest<'_> {
    /// The next sign that is no space.
    fn peek(&mut self) -> Option<u8> {
        self.0 = self.0.trim_ascii_start();
        self.0.first().copied()
    }

    /// Passes a sign, behind spaces.
    fn sign(&mut self, wanted: u8) -> Option<()> {
        (self.peek() == Some(wanted)).then(|| self.pass(1))
    }

    fn pass(&mut self, count: usize) {
        self.0 = self.0.get(count..).unwrap_or_default();
    }

    fn value(&mut self, depth: usize) -> Option<()> {
        let depth = depth.checked_sub(1)?;
        match self.peek()? {
            b'{' => self.items(b'}', &mut |rest| {
                rest.peek()?;
                rest.string()?;
                rest.sign(b':')?;
                rest.value(depth)
            }),
            b'[' => self.items(b']', &mut |rest| rest.value(depth)),
            b'"' => self.string(),
            b'-' | b'0'..=b'9' => self.number(),
            _ => {
                let words: [&[u8]; 3] = [b"true", b"false", b"null"];
                let word = words.into_iter().find(|word| self.0.starts_with(word))?;
                self.pass(word.len());
                Some(())
            }
        }
    }

    /// Items with commas between them, up to the sign that ends them.
    fn items(&mut self, end: u8, item: &mut dyn FnMut(&mut Self) -> Option<()>) -> Option<()> {
        self.pass(1);
        if self.sign(end).is_some() {
            return Some(());
        }
        loop {
            item(self)?;
            if self.sign(end).is_some() {
                return Some(());
            }
            self.sign(b',')?;
        }
    }

    fn string(&mut self) -> Option<()> {
        let (b'"', rest) = self.0.split_first()? else {
            return None;
        };
        self.0 = rest;
        loop {
            let &first = self.0.first()?;
            self.pass(1);
            match first {
                b'"' => return Some(()),
                b'\\' => {
                    let &escaped = self.0.first()?;
                    self.pass(1);
                    match escaped {
                        b'u' => {
                            let digits = self.0.get(..4)?;
                            digits.iter().all(u8::is_ascii_hexdigit).then_some(())?;
                            self.pass(4);
                        }
                        other => b"\"\\/bfnrt".contains(&other).then_some(())?,
                    }
                }
                other => (other >= 0x20).then_some(())?,
            }
        }
    }

    fn number(&mut self) -> Option<()> {
        if self.0.first() == Some(&b'-') {
            self.pass(1);
        }
        match self.0.first()? {
            b'0' => self.pass(1),
            _ => self.digits()?,
        }
        if self.0.first() == Some(&b'.') {
            self.pass(1);
            self.digits()?;
        }
        if matches!(self.0.first(), Some(b'e' | b'E')) {
            self.pass(1);
            if matches!(self.0.first(), Some(b'+' | b'-')) {
                self.pass(1);
            }
            self.digits()?;
        }
        Some(())
    }

    fn digits(&mut self) -> Option<()> {
        let count = self.0.iter().take_while(|byte| byte.is_ascii_digit());
        let count = count.count();
        self.pass(count);
        (count > 0).then_some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_json_and_what_is_not() {
        for text in [
            "{}",
            " [ ] ",
            "{\"a\":[1,-0.5e+3,0],\"b\":{\"c\":null},\"d\":\"\\u00ff\\n\u{43f}\"}",
            "true",
            "\"\"",
        ] {
            assert!(is_json(text), "{text}");
        }
        for text in [
            "",
            "{",
            "{}{}",
            "{a:1}",
            "{\"a\" 1}",
            "{\"a\":1,}",
            "[1 2]",
            "[,1]",
            "01",
            "1.",
            "-",
            "1e",
            "NaN",
            "inf",
            "tru",
            "\"\n\"",
            "\"\\x\"",
            "\"\\u12g4\"",
            "\"",
        ] {
            assert!(!is_json(text), "{text}");
        }
        let deep = |depth: usize| "[".repeat(depth) + &"]".repeat(depth);
        assert!(is_json(&deep(limits::JSON_DEPTH_MAX)));
        assert!(!is_json(&deep(limits::JSON_DEPTH_MAX + 1)));
        assert!(!is_json(&deep(1_000_000)));
    }
}
