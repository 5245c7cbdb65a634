//! Text to tokens: the longest that fits, with its place.
//!
//! What fits nothing is skipped up to the next space and told. Knows no grammar.

use super::words::{Fault, Reason};
use crate::limits;
use lang_text::problem::Position;
use std::ops::Range;

/// A kind of token; its text is in the source.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Token {
    /// A name that is no keyword.
    Name,
    /// Digits, decimal or with `0x`.
    Int,
    /// A number with a point or an exponent.
    Float,
    /// A text with its quotes.
    Text,
    /// A keyword or a sign, as it is written.
    Word(&'static str),
}

impl Token {
    /// How messages call it.
    pub fn shown(self) -> &'static str {
        match self {
            Self::Name => "identifier",
            Self::Int => "integer literal",
            Self::Float => "float literal",
            Self::Text => "string",
            Self::Word(word) => word,
        }
    }
}

/// A token in its place.
#[derive(Clone, Debug)]
pub struct Placed {
    /// What it is.
    pub token: Token,
    /// Bytes of the source.
    pub bytes: Range<usize>,
    /// Where it begins.
    pub at: Position,
}

/// Reserved words; most have no use in expressions.
const KEYWORDS: [&str; 22] = [
    "and", "break", "do", "else", "elseif", "end", "false", "for", "function", "goto", "if", "in",
    "local", "nil", "not", "or", "repeat", "return", "then", "true", "until", "while",
];

/// Signs, long ones first.
const SIGNS: [&str; 36] = [
    "...", "//", "==", "~=", "!=", "<=", ">=", "<<", ">>", "..", "::", "&&", "||", "+", "-", "*",
    "/", "%", "^", "#", "&", "~", "|", "<", ">", "=", "(", ")", "{", "}", "[", "]", ";", ":", ",",
    ".",
];

/// All tokens of a text, and what could not be read.
pub fn tokens(text: &str) -> (Vec<Placed>, Vec<Fault>) {
    let mut lexer = Lexer {
        text,
        offset: 0,
        at: Position { line: 1, column: 1 },
    };
    let mut found = Vec::new();
    let mut faults = Vec::new();
    if text.len() > limits::EXPRESSION_TEXT_MAX {
        let mut end = limits::EXPRESSION_TEXT_MAX;
        while !text.is_char_boundary(end) {
            end -= 1;
        }
        lexer.advance(end);
        faults.push(Fault::new(Reason::TextTooLong, lexer.at));
        return (found, faults);
    }
    while let Some(next) = lexer.rest().chars().next() {
        let at = lexer.at;
        let from = lexer.offset;
        if matches!(next, ' ' | '\t' | '\n') {
            lexer.advance(1);
        } else if lexer.rest().starts_with("--") {
            let length = lexer.rest().find('\n').unwrap_or(lexer.rest().len());
            lexer.advance(length);
        } else if let Some((token, length)) = lexer.match_one(next) {
            lexer.advance(length);
            found.push(Placed {
                token,
                bytes: from..lexer.offset,
                at,
            });
        } else {
            let rest = lexer.rest();
            let length = rest.find([' ', '\t', '\n']).unwrap_or(rest.len());
            let skipped = rest[..length].to_owned();
            lexer.advance(length);
            if faults.len() < limits::EXPRESSION_PROBLEMS_MAX {
                faults.push(Fault::new(Reason::UnknownSymbols(skipped), at));
            }
        }
    }
    (found, faults)
}

struct Lexer<'a> {
    text: &'a str,
    offset: usize,
    at: Position,
}

impl<'a> Lexer<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.offset..]
    }

    fn advance(&mut self, bytes: usize) {
        for passed in self.text[self.offset..self.offset + bytes].chars() {
            if passed == '\n' {
                self.at.line += 1;
                self.at.column = 1;
            } else {
                self.at.column += 1;
            }
        }
        self.offset += bytes;
    }

    fn match_one(&self, next: char) -> Option<(Token, usize)> {
        let rest = self.rest();
        if next == '_' || next.is_alphabetic() {
            let more = |c: char| c == '_' || c.is_alphabetic() || c.is_ascii_digit();
            let length = rest.find(|c| !more(c)).unwrap_or(rest.len());
            let word = KEYWORDS
                .iter()
                .find(|&&keyword| keyword == &rest[..length])
                .map_or(Token::Name, |&keyword| Token::Word(keyword));
            return Some((word, length));
        }
        if next.is_ascii_digit() {
            return Some(number(rest.as_bytes()));
        }
        if next == '"' || next == '\'' {
            return string(rest.as_bytes()).map(|length| (Token::Text, length));
        }
        let sign = SIGNS.iter().find(|&&sign| rest.starts_with(sign))?;
        Some((Token::Word(sign), sign.len()))
    }
}

/// How many bytes from `from` satisfy a condition.
fn run(bytes: &[u8], from: usize, good: fn(&u8) -> bool) -> usize {
    bytes
        .get(from..)
        .map_or(0, |rest| rest.iter().take_while(|byte| good(byte)).count())
}

/// An exponent at `from`: the letter, and digits that may be missing.
fn exponent(bytes: &[u8], from: usize, letter: u8, digit: fn(&u8) -> bool) -> usize {
    if !bytes
        .get(from)
        .is_some_and(|byte| byte.eq_ignore_ascii_case(&letter))
    {
        return 0;
    }
    if matches!(bytes.get(from + 1), Some(b'+' | b'-')) {
        let digits = run(bytes, from + 2, digit);
        return if digits > 0 { 2 + digits } else { 1 };
    }
    1 + run(bytes, from + 1, digit)
}

/// A number and its length; begins with a digit.
fn number(bytes: &[u8]) -> (Token, usize) {
    let is_hex = bytes[0] == b'0'
        && matches!(bytes.get(1), Some(b'x' | b'X'))
        && bytes.get(2).is_some_and(u8::is_ascii_hexdigit);
    let (digit, letter, from): (fn(&u8) -> bool, u8, usize) = if is_hex {
        (u8::is_ascii_hexdigit, b'p', 2)
    } else {
        (u8::is_ascii_digit, b'e', 0)
    };
    let whole = from + run(bytes, from, digit);
    let mut end = whole;
    if bytes.get(end) == Some(&b'.') {
        let decimals = run(bytes, end + 1, digit);
        if decimals > 0 {
            end += 1 + decimals;
        }
    }
    end += exponent(bytes, end, letter, digit);
    let token = if end == whole {
        Token::Int
    } else {
        Token::Float
    };
    (token, end)
}

/// The length of a quoted text, unless it has no end.
fn string(bytes: &[u8]) -> Option<usize> {
    let quote = bytes[0];
    let mut at = 1;
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'\\' => at += 2,
            _ if byte == quote => return Some(at + 1),
            _ => at += 1,
        }
    }
    None
}
