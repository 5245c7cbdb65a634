//! Where in the text of a configuration a key of a table stands, for messages.
//!
//! A configuration is a program, so the place of a value cannot be known for certain; this reads the text as nested
//! table constructors and remembers every `name =` with the names around it. What is not found so is not an error: the
//! message then points at the nearest enclosing key. Pure.

use crate::limits::{KEY_DEPTH_MAX, KEYS_MAX};

/// Keys of one text.
#[derive(Clone, Debug, Default)]
pub(crate) struct Lines {
    /// Names from the outside in, and the line from 1.
    keys: Vec<(Vec<String>, u32)>,
}

impl Lines {
    /// Reads a text. Anything is a text: what makes no sense is passed over.
    pub(crate) fn read(source: &[u8]) -> Self {
        let mut reader = Reader {
            source,
            at: 0,
            line: 1,
        };
        let mut lines = Self::default();
        // For each open bracket the number of names before it.
        let mut brackets: Vec<usize> = Vec::new();
        let mut names: Vec<String> = Vec::new();
        // Names that may become a key if `=` follows, and where they began.
        let mut candidate: Vec<String> = Vec::new();
        let mut line = 1;
        let mut joins = false;
        while let Some(token) = reader.next() {
            match token {
                Token::Name(name) if joins => {
                    candidate.push(name);
                    joins = false;
                }
                Token::Name(name) => {
                    candidate = vec![name];
                    line = reader.line;
                }
                Token::Dot => joins = !candidate.is_empty(),
                Token::Key(name) => {
                    // `['name']` after a name continues it, elsewhere it begins a key.
                    if candidate.is_empty() {
                        line = reader.line;
                    }
                    candidate.push(name);
                }
                Token::Assign => {
                    if !candidate.is_empty()
                        && lines.keys.len() < KEYS_MAX
                        && names.len() < KEY_DEPTH_MAX
                    {
                        let depth = names.len();
                        names.append(&mut candidate);
                        lines.keys.push((names.clone(), line));
                        if reader.peek() == Some(b'{') || reader.peek() == Some(b'(') {
                            reader.next();
                            brackets.push(depth);
                        } else if reader.constructor() {
                            brackets.push(depth);
                        } else {
                            names.truncate(depth);
                        }
                    }
                    candidate.clear();
                }
                Token::Open => {
                    brackets.push(names.len());
                    candidate.clear();
                }
                Token::Close => {
                    names.truncate(brackets.pop().unwrap_or(0));
                    candidate.clear();
                }
                Token::Other => candidate.clear(),
            }
        }
        lines
    }

    /// The line of a key, given the names that lead to it from outside in. The longest end of the path that stands in
    /// the text wins. Gives the line and how many names fitted.
    pub(crate) fn find(&self, path: &[&str]) -> Option<(u32, usize)> {
        let mut best: Option<(u32, usize)> = None;
        for (names, line) in &self.keys {
            let fits = names
                .iter()
                .rev()
                .zip(path.iter().rev())
                .take_while(|(a, b)| a == b)
                .count();
            if fits > 0 && best.is_none_or(|(_, most)| fits > most) {
                best = Some((*line, fits));
            }
        }
        best
    }
}

/// The line of the first byte of `text` in `source`, if it stands there as it is.
pub(crate) fn line_of(source: &[u8], text: &[u8]) -> Option<u32> {
    if text.is_empty() || text.len() > source.len() {
        return None;
    }
    // Texts are searched by their first line, which in a program is nearly unique.
    let head = text
        .split(|byte| *byte == b'\n')
        .find(|line| !line.is_empty())
        .unwrap_or(text);
    let skipped = text
        .split(|byte| *byte == b'\n')
        .take_while(|line| line.is_empty())
        .count();
    let at = source
        .windows(head.len())
        .position(|window| window == head)?;
    let line = source
        .get(..at)?
        .iter()
        .filter(|byte| **byte == b'\n')
        .count()
        + 1;
    u32::try_from(line - skipped.min(line - 1)).ok()
}

enum Token {
    Name(String),
    /// `['name']`
    Key(String),
    Dot,
    Assign,
    Open,
    Close,
    Other,
}

struct Reader<'a> {
    source: &'a [u8],
    at: usize,
    line: u32,
}

impl Reader<'_> {
    fn byte(&self, ahead: usize) -> Option<u8> {
        self.source.get(self.at + ahead).copied()
    }

    fn skip(&mut self, count: usize) {
        for _ in 0..count {
            if self.byte(0) == Some(b'\n') {
                self.line += 1;
            }
            self.at += 1;
        }
    }

    /// Passes over white space and comments.
    fn blank(&mut self) {
        loop {
            match (self.byte(0), self.byte(1)) {
                (Some(b' ' | b'\t' | b'\r' | b'\n' | 0x0b | 0x0c), _) => self.skip(1),
                (Some(b'-'), Some(b'-')) => {
                    self.skip(2);
                    if !self.long_bracket() {
                        while self.byte(0).is_some_and(|byte| byte != b'\n') {
                            self.skip(1);
                        }
                    }
                }
                _ => return,
            }
        }
    }

    /// The next byte that means something.
    fn peek(&mut self) -> Option<u8> {
        self.blank();
        self.byte(0)
    }

    /// Passes over `[[...]]`, `[=[...]=]`; false if there is none.
    fn long_bracket(&mut self) -> bool {
        if self.byte(0) != Some(b'[') {
            return false;
        }
        let level = (1..).take_while(|i| self.byte(*i) == Some(b'=')).count();
        if self.byte(level + 1) != Some(b'[') {
            return false;
        }
        self.skip(level + 2);
        while let Some(byte) = self.byte(0) {
            let closes = byte == b']'
                && (1..=level).all(|i| self.byte(i) == Some(b'='))
                && self.byte(level + 1) == Some(b']');
            self.skip(if closes { level + 2 } else { 1 });
            if closes {
                break;
            }
        }
        true
    }

    /// Passes over a quoted string and gives its text without escapes, or None if it has some.
    fn quoted(&mut self, quote: u8) -> Option<String> {
        self.skip(1);
        let start = self.at;
        let mut plain = true;
        while let Some(byte) = self.byte(0) {
            match byte {
                b'\\' => {
                    plain = false;
                    self.skip(2);
                }
                b'\n' => break,
                _ if byte == quote => {
                    let text = self.source.get(start..self.at)?;
                    self.skip(1);
                    return String::from_utf8(text.to_vec()).ok().filter(|_| plain);
                }
                _ => self.skip(1),
            }
        }
        None
    }

    fn name(&mut self) -> String {
        let start = self.at;
        while self
            .byte(0)
            .is_some_and(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
        {
            self.at += 1;
        }
        let bytes = self.source.get(start..self.at).unwrap_or_default();
        String::from_utf8_lossy(bytes).into_owned()
    }

    /// After `=`: passes over `word {`, `word{` or `word(`, the call of a constructor; false leaves all as it is.
    fn constructor(&mut self) -> bool {
        let (at, line) = (self.at, self.line);
        if self
            .peek()
            .is_some_and(|byte| byte.is_ascii_alphabetic() || byte == b'_')
            && self.name() != "function"
        {
            while self.peek() == Some(b'.') {
                self.skip(1);
                self.blank();
                self.name();
            }
            if matches!(self.peek(), Some(b'{' | b'(')) {
                self.skip(1);
                return true;
            }
        }
        (self.at, self.line) = (at, line);
        false
    }

    fn next(&mut self) -> Option<Token> {
        let byte = self.peek()?;
        Some(match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => Token::Name(self.name()),
            b'"' | b'\'' => {
                self.quoted(byte);
                Token::Other
            }
            b'[' => self.bracket(),
            b'{' | b'(' => {
                self.skip(1);
                Token::Open
            }
            b'}' | b')' => {
                self.skip(1);
                Token::Close
            }
            b'=' if self.byte(1) == Some(b'=') => {
                self.skip(2);
                Token::Other
            }
            b'=' => {
                self.skip(1);
                Token::Assign
            }
            b'.' if self.byte(1) != Some(b'.') => {
                self.skip(1);
                Token::Dot
            }
            _ => {
                self.skip(1);
                Token::Other
            }
        })
    }

    /// `[[long]]`, `['key']`, or the bracket alone.
    fn bracket(&mut self) -> Token {
        if self.long_bracket() {
            return Token::Other;
        }
        self.skip(1);
        if let Some(quote @ (b'"' | b'\'')) = self.peek()
            && let Some(name) = self.quoted(quote)
            && self.peek() == Some(b']')
        {
            self.skip(1);
            return Token::Key(name);
        }
        Token::Other
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(source: &str, path: &[&str]) -> Option<u32> {
        Lines::read(source.as_bytes())
            .find(path)
            .map(|(line, _)| line)
    }

    const SOURCE: &str = "-- motors = {\n\
        trikfs = {\n\
        motors = {\n\
        left = { src = '/dev/a = {',\n\
        units = 'mm' },\n\
        ['right'] = {\n\
        src = fifo { '/dev/b' }, units = [[\n}]],\n\
        converter = function(a_s, a, b_s, b) local x = { left = 1 } end,\n\
        poll_ms = 5 },\n\
        } }\n\
        trikfs.motors.third = {\n\
        units = 'x' }\n\
        trikfs['fourth'] = { units = 1 }\n";

    #[test]
    fn a_key_is_found_by_the_names_around_it() {
        assert_eq!(line(SOURCE, &["trikfs", "motors", "left"]), Some(4));
        assert_eq!(
            line(SOURCE, &["trikfs", "motors", "left", "units"]),
            Some(5)
        );
        assert_eq!(
            line(SOURCE, &["trikfs", "motors", "right", "units"]),
            Some(7)
        );
        assert_eq!(
            line(SOURCE, &["trikfs", "motors", "right", "poll_ms"]),
            Some(10)
        );
        assert_eq!(
            line(SOURCE, &["trikfs", "motors", "third", "units"]),
            Some(13)
        );
        assert_eq!(line(SOURCE, &["trikfs", "fourth"]), Some(14));
    }

    #[test]
    fn a_key_that_is_made_by_code_is_not_found() {
        assert_eq!(line(SOURCE, &["trikfs", "made"]), None);
        assert_eq!(line("", &["x"]), None);
    }

    #[test]
    fn any_bytes_can_be_read() {
        for source in [
            "}}}}",
            "= = =",
            "['",
            "a.b.",
            "[==[",
            "--[[",
            "'",
            "x = y {",
            "\u{0}\u{1}{(",
            "[=",
            "a = ",
        ] {
            Lines::read(source.as_bytes());
        }
    }

    #[test]
    fn the_line_of_a_text_is_that_of_its_first_line() {
        let source = b"a\nb = [[\n\nint x;\nint y;\n]]";
        assert_eq!(line_of(source, b"\nint x;\nint y;\n"), Some(3));
        assert_eq!(line_of(source, b"int x;\nint y;\n"), Some(4));
        assert_eq!(line_of(source, b"int z;"), None);
        assert_eq!(line_of(source, b""), None);
    }
}
