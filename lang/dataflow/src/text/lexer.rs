//! The signs, words and values of a text, one after another, and how texts are written so that they come back.
//!
//! Owns what a word, a number and a text in quotes or backticks is. Knows no line.

use std::fmt::Write as _;

/// What a text is made of.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Token<'a> {
    Word(&'a str),
    Number(&'a str),
    /// Without its quotes or backticks.
    Text(String),
    Sign(Sign),
    /// The end of a line.
    Line,
    /// The end of the text.
    End,
    Wrong(Wrong),
}

#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Sign {
    Colon,
    Comma,
    Semicolon,
    Equals,
    Dot,
    Arrow,
    Open,
    Close,
}

impl Sign {
    /// As it is written.
    pub fn text(self) -> &'static str {
        match self {
            Self::Colon => ":",
            Self::Comma => ",",
            Self::Semicolon => ";",
            Self::Equals => "=",
            Self::Dot => ".",
            Self::Arrow => "->",
            Self::Open => "(",
            Self::Close => ")",
        }
    }
}

/// What is no token.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Wrong {
    /// A sign that means nothing.
    Stray(char),
    /// Quotes without an end in their line.
    Quotes,
    /// Backticks without an end.
    Backticks,
    /// A backslash before something else than an escape.
    Escape,
}

/// A token with where it begins.
#[derive(Clone, Debug)]
pub(super) struct Lexed<'a> {
    pub at: usize,
    pub token: Token<'a>,
}

pub(super) struct Lexer<'a> {
    text: &'a str,
    at: usize,
}

impl<'a> Lexer<'a> {
    pub fn new(text: &'a str) -> Self {
        Self { text, at: 0 }
    }

    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    /// Goes on as far as letters are of a kind; gives what it has passed.
    fn pass(&mut self, is_part: impl Fn(char) -> bool) -> &'a str {
        let rest = self.rest();
        let end = rest.find(|c| !is_part(c)).unwrap_or(rest.len());
        self.at += end;
        &rest[..end]
    }

    /// The next token; after the end, the end again.
    pub fn next(&mut self) -> Lexed<'a> {
        self.pass(|c| c.is_whitespace() && c != '\n');
        if self.rest().starts_with('#') {
            self.pass(|c| c != '\n');
        }
        let at = self.at;
        let token = match self.rest().chars().next() {
            None => Token::End,
            Some(first) => self.token(first),
        };
        Lexed { at, token }
    }

    fn token(&mut self, first: char) -> Token<'a> {
        if is_first(first) {
            return Token::Word(self.pass(is_further));
        }
        let length = number(self.rest());
        if length > 0 {
            let text = &self.rest()[..length];
            self.at += length;
            return Token::Number(text);
        }
        if self.rest().starts_with("->") {
            self.at += 2;
            return Token::Sign(Sign::Arrow);
        }
        self.at += first.len_utf8();
        match first {
            '\n' => Token::Line,
            ':' => Token::Sign(Sign::Colon),
            ',' => Token::Sign(Sign::Comma),
            ';' => Token::Sign(Sign::Semicolon),
            '=' => Token::Sign(Sign::Equals),
            '.' => Token::Sign(Sign::Dot),
            '\u{2192}' => Token::Sign(Sign::Arrow),
            '(' => Token::Sign(Sign::Open),
            ')' => Token::Sign(Sign::Close),
            '"' => self.quotes(),
            '`' => self.backticks(),
            other => Token::Wrong(Wrong::Stray(other)),
        }
    }

    fn backticks(&mut self) -> Token<'a> {
        let text = self.pass(|c| c != '`');
        if self.rest().is_empty() {
            return Token::Wrong(Wrong::Backticks);
        }
        self.at += 1;
        // Lines are those of the program, whatever the editor of this file ends its own with.
        Token::Text(text.replace("\r\n", "\n"))
    }

    fn quotes(&mut self) -> Token<'a> {
        let mut text = String::new();
        loop {
            text.push_str(self.pass(|c| !matches!(c, '"' | '\\' | '\n')));
            let rest = self.rest();
            if rest.starts_with('"') {
                self.at += 1;
                return Token::Text(text);
            }
            if !rest.starts_with('\\') {
                return Token::Wrong(Wrong::Quotes);
            }
            match escape(&rest[1..]) {
                Some((letter, length)) => {
                    text.push(letter);
                    self.at += 1 + length;
                }
                None => {
                    // What follows is part of the text that is wrong.
                    self.pass(|c| c != '\n');
                    return Token::Wrong(Wrong::Escape);
                }
            }
        }
    }
}

/// What stands after a backslash, and how many bytes of it.
fn escape(text: &str) -> Option<(char, usize)> {
    let plain = match text.chars().next()? {
        '"' => '"',
        '\\' => '\\',
        'n' => '\n',
        'r' => '\r',
        't' => '\t',
        _ => {
            let digits = text.strip_prefix("u{")?;
            let digits = &digits[..digits.find('}')?];
            let is_hex = digits.len() <= 6 && digits.bytes().all(|c| c.is_ascii_hexdigit());
            let number = u32::from_str_radix(digits, 16).ok().filter(|_| is_hex)?;
            return Some((char::from_u32(number)?, digits.len() + 3));
        }
    };
    Some((plain, 1))
}

fn is_first(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

fn is_further(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// How many bytes at the beginning are a number.
fn number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        let rest = bytes.get(from..).unwrap_or_default();
        rest.iter().take_while(|c| c.is_ascii_digit()).count()
    };
    let sign = usize::from(text.starts_with('-'));
    if sign == 1 && text[1..].starts_with("inf") {
        return 4;
    }
    let mut end = sign + digits(sign);
    if end == sign {
        return 0;
    }
    if bytes.get(end) == Some(&b'.') && digits(end + 1) > 0 {
        end += 1 + digits(end + 1);
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let count = digits(end + 1 + sign);
        if count > 0 {
            end += 1 + sign + count;
        }
    }
    end
}

/// Whether a text is a word as it stands.
pub(super) fn is_word(text: &str) -> bool {
    text.starts_with(is_first) && text.chars().all(is_further)
}

/// Whether a letter cannot be seen, or changes how its neighbours are seen.
fn is_hidden(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{ad}' | '\u{61c}' | '\u{180e}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{feff}' | '\u{fff9}'..='\u{ffff}' | '\u{e0000}'..='\u{e007f}')
}

/// A text in quotes.
pub(super) fn quoted(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\r' => out.push_str("\\r"),
            '\t' => out.push_str("\\t"),
            c if is_hidden(c) => {
                let _ = write!(out, "\\u{{{:x}}}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// A text as a name: as a word, or in quotes.
pub(super) fn named(text: &str) -> String {
    match is_word(text) {
        true => text.to_owned(),
        false => quoted(text),
    }
}

/// A text as a value: as it stands, in backticks if it is code or has quotes of its own, or in quotes.
pub(super) fn value(text: &str, is_code: bool) -> String {
    if is_word(text) || (!text.is_empty() && number(text) == text.len()) {
        return text.to_owned();
    }
    // Blanks at line ends are lost too easily.
    let is_plain = |line: &str| {
        !line.contains(|c| is_hidden(c) || c == '`') && !line.ends_with(char::is_whitespace)
    };
    let is_readable = is_code || text.contains(['"', '\\']);
    match is_readable && !text.is_empty() && text.split('\n').all(is_plain) {
        true => format!("`{text}`"),
        false => quoted(text),
    }
}

/// A number of the canvas, so that exactly it comes back.
pub(super) fn coordinate(number: f64) -> String {
    let text = format!("{number:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}
