//! Text to tokens: every sign of a document with its place, comments too.
//!
//! Owns what a name, a number and a comment look like. Never fails: what is no token is one that says so, and between
//! tokens stands white space alone. Knows no grammar; what is wrong with a token is told by `parser`.

use super::syntax::{Kind, Span};

/// A token with its place.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Token {
    /// What.
    pub kind: TokenKind,
    /// Where.
    pub span: Span,
}

/// A word that no name may be.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Keyword {
    /// `BEGIN`
    Begin,
    /// `END`
    End,
    /// `PACKAGE`
    Package,
    /// What opens a section of declarations.
    Section(Kind),
}

/// What a token is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum TokenKind {
    /// A name: a Latin letter or `_`, then such and digits.
    Word,
    /// A reserved word.
    Keyword(Keyword),
    /// Digits, perhaps with a point and an exponent.
    Number,
    /// `;`
    Semicolon,
    /// `,`
    Comma,
    /// `:`
    Colon,
    /// `=`
    Equals,
    /// `(`
    Open,
    /// `)`
    Close,
    /// `[`
    OpenBracket,
    /// `]`
    CloseBracket,
    /// `+`
    Plus,
    /// `-`
    Minus,
    /// `*`
    Star,
    /// `/`
    Slash,
    /// `^`: only in units.
    Caret,
    /// `.`
    Dot,
    /// `..`
    DotDot,
    /// `<`
    Less,
    /// `<=`
    LessOrEqual,
    /// `>`
    Greater,
    /// `>=`
    GreaterOrEqual,
    /// From `//` to the end of the line, without that.
    LineComment,
    /// `/* */`
    BlockComment,
    /// `/** */`: documentation.
    DocComment,
    /// A comment that has no end.
    OpenComment,
    /// A word with letters that are not Latin.
    ForeignWord,
    /// Begins as a number and is none: `2x`, `1e`, `1.2.3`.
    BadNumber,
    /// Signs that nothing begins with.
    Unknown,
    /// Behind the last token; only `parser` makes it.
    EndOfText,
}

impl TokenKind {
    /// Whether it is a comment of any kind.
    pub const fn is_comment(self) -> bool {
        matches!(
            self,
            Self::LineComment | Self::BlockComment | Self::DocComment | Self::OpenComment
        )
    }
}

impl Keyword {
    /// All reserved words.
    pub const ALL: [Self; 8] = [
        Self::Begin,
        Self::End,
        Self::Package,
        Self::Section(Kind::Action),
        Self::Section(Kind::Param),
        Self::Section(Kind::Const),
        Self::Section(Kind::Config),
        Self::Section(Kind::Var),
    ];

    /// The word.
    pub const fn text(self) -> &'static str {
        match self {
            Self::Begin => "BEGIN",
            Self::End => "END",
            Self::Package => "PACKAGE",
            Self::Section(kind) => kind.keyword(),
        }
    }

    /// The reserved word that is written so.
    pub fn named(word: &str) -> Option<Self> {
        // Most words are names, and few of those have capitals only.
        if !word.as_bytes().first().is_some_and(u8::is_ascii_uppercase) {
            return None;
        }
        Self::ALL.into_iter().find(|one| one.text() == word)
    }
}

/// All tokens of a text, in order; a mark of byte order at its beginning is none. The text is no longer than
/// [`crate::limits::DCML_TEXT_MAX`].
pub fn tokens(text: &str) -> Tokens<'_> {
    let at = if text.starts_with('\u{feff}') { 3 } else { 0 };
    Tokens { text, at }
}

/// The part of a text at a place; nothing if the place is not of this text.
pub fn slice(text: &str, span: Span) -> &str {
    text.get(span.start as usize..span.end as usize)
        .unwrap_or_default()
}

/// See [`tokens`].
#[derive(Clone, Debug)]
pub struct Tokens<'a> {
    text: &'a str,
    at: usize,
}

impl Iterator for Tokens<'_> {
    type Item = Token;

    fn next(&mut self) -> Option<Token> {
        let bytes = self.text.as_bytes();
        let white = bytes[self.at..].iter().position(|byte| !is_white(*byte));
        let start = self.at + white.unwrap_or(bytes.len() - self.at);
        let first = *bytes.get(start)?;
        let (kind, length) = token(&self.text[start..], first);
        self.at = start + length;
        let span = Span {
            start: u32::try_from(start).unwrap_or(u32::MAX),
            end: u32::try_from(self.at).unwrap_or(u32::MAX),
        };
        Some(Token { kind, span })
    }
}

/// What stands between tokens and means nothing.
pub(super) const fn is_white(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\r' | b'\n' | 0x0c)
}

/// The kind and the length of the token with which the text begins.
fn token(rest: &str, first: u8) -> (TokenKind, usize) {
    let bytes = rest.as_bytes();
    let second = bytes.get(1).copied().unwrap_or_default();
    match (first, second) {
        (b'/', b'/') => (TokenKind::LineComment, line_comment(bytes)),
        (b'/', b'*') => block_comment(rest),
        (b'a'..=b'z' | b'A'..=b'Z' | b'_', _) => word(rest),
        (b'0'..=b'9', _) => number(rest),
        (b'.', b'0'..=b'9') => number(rest),
        (b'.', b'.') => (TokenKind::DotDot, 2),
        (b'<', b'=') => (TokenKind::LessOrEqual, 2),
        (b'>', b'=') => (TokenKind::GreaterOrEqual, 2),
        (b';', _) => (TokenKind::Semicolon, 1),
        (b',', _) => (TokenKind::Comma, 1),
        (b':', _) => (TokenKind::Colon, 1),
        (b'=', _) => (TokenKind::Equals, 1),
        (b'(', _) => (TokenKind::Open, 1),
        (b')', _) => (TokenKind::Close, 1),
        (b'[', _) => (TokenKind::OpenBracket, 1),
        (b']', _) => (TokenKind::CloseBracket, 1),
        (b'+', _) => (TokenKind::Plus, 1),
        (b'-', _) => (TokenKind::Minus, 1),
        (b'*', _) => (TokenKind::Star, 1),
        (b'/', _) => (TokenKind::Slash, 1),
        (b'^', _) => (TokenKind::Caret, 1),
        (b'.', _) => (TokenKind::Dot, 1),
        (b'<', _) => (TokenKind::Less, 1),
        (b'>', _) => (TokenKind::Greater, 1),
        _ if rest.chars().next().is_some_and(char::is_alphabetic) => word(rest),
        _ => (TokenKind::Unknown, unknown(rest)),
    }
}

/// Without the end of the line, which may have a carriage return.
fn line_comment(bytes: &[u8]) -> usize {
    let end = bytes.iter().position(|byte| *byte == b'\n');
    let end = end.unwrap_or(bytes.len());
    match bytes[..end].last() {
        Some(b'\r') => end - 1,
        _ => end,
    }
}

fn block_comment(rest: &str) -> (TokenKind, usize) {
    match rest[2..].find("*/") {
        None => (TokenKind::OpenComment, rest.len()),
        Some(at) => {
            let length = 2 + at + 2;
            // `/**/` is empty and says nothing; so is a frame of stars.
            let is_doc = length > 4 && rest[2..].starts_with('*') && !rest[3..].starts_with('*');
            let kind = if is_doc {
                TokenKind::DocComment
            } else {
                TokenKind::BlockComment
            };
            (kind, length)
        }
    }
}

fn is_of_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || byte == b'_'
}

/// A name, or what wants to be one.
fn word(rest: &str) -> (TokenKind, usize) {
    let bytes = rest.as_bytes();
    let plain = bytes.iter().position(|byte| !is_of_word(*byte));
    let plain = plain.unwrap_or(bytes.len());
    if bytes.get(plain).is_none_or(u8::is_ascii) {
        let kind = Keyword::named(&rest[..plain]).map_or(TokenKind::Word, TokenKind::Keyword);
        return (kind, plain);
    }
    let end = rest.find(|sign: char| !(sign.is_alphanumeric() || sign == '_'));
    let end = end.unwrap_or(rest.len());
    if end == plain {
        let kind = Keyword::named(&rest[..plain]).map_or(TokenKind::Word, TokenKind::Keyword);
        return (kind, plain);
    }
    (TokenKind::ForeignWord, end)
}

/// Digits, a point that is not one of two, an exponent; letters that hang on it make it none.
fn number(rest: &str) -> (TokenKind, usize) {
    let bytes = rest.as_bytes();
    let digits = |from: usize| {
        let tail = &bytes[from..];
        let end = tail.iter().position(|byte| !byte.is_ascii_digit());
        from + end.unwrap_or(tail.len())
    };
    let byte = |at: usize| bytes.get(at).copied().unwrap_or_default();
    let mut end = digits(0);
    if byte(end) == b'.' && byte(end + 1) != b'.' {
        end = digits(end + 1);
    }
    if matches!(byte(end), b'e' | b'E') {
        let sign = usize::from(matches!(byte(end + 1), b'+' | b'-'));
        let power = end + 1 + sign;
        if byte(power).is_ascii_digit() {
            end = digits(power);
        }
    }
    let hangs = |at: usize| is_of_word(byte(at)) || (byte(at) == b'.' && byte(at + 1) != b'.');
    if !hangs(end) {
        return (TokenKind::Number, end);
    }
    while hangs(end) {
        end += 1;
    }
    (TokenKind::BadNumber, end)
}

/// All signs in a row that nothing begins with.
fn unknown(rest: &str) -> usize {
    let begins = |sign: char| {
        sign.is_alphanumeric()
            || sign == '_'
            || u8::try_from(sign)
                .is_ok_and(|byte| is_white(byte) || b";,:=()[]+-*/^.<>".contains(&byte))
    };
    let first = rest.chars().next().map_or(0, char::len_utf8);
    rest[first..]
        .find(begins)
        .map_or(rest.len(), |at| first + at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use TokenKind::*;

    fn kinds(text: &str) -> Vec<(TokenKind, &str)> {
        tokens(text)
            .map(|one| (one.kind, slice(text, one.span)))
            .collect()
    }

    #[test]
    fn numbers_end_where_they_end() {
        assert_eq!(
            kinds("1..2"),
            [(Number, "1"), (DotDot, ".."), (Number, "2")]
        );
        assert_eq!(
            kinds("1.5e-3+.5 2."),
            [
                (Number, "1.5e-3"),
                (Plus, "+"),
                (Number, ".5"),
                (Number, "2.")
            ]
        );
        for bad in ["2x", "1e", "1.2.3", "0x1F", "1e5.2", "1e+"] {
            let whole = bad.trim_end_matches('+');
            assert_eq!(kinds(bad)[0], (BadNumber, whole));
        }
    }

    #[test]
    fn comments_know_their_kind_and_end() {
        let text = "/** a */ /* b */ /**/ /*** c ***/ // d\r\nx /* e";
        let found = kinds(text);
        let expected = [
            (DocComment, "/** a */"),
            (BlockComment, "/* b */"),
            (BlockComment, "/**/"),
            (BlockComment, "/*** c ***/"),
            (LineComment, "// d"),
            (Word, "x"),
            (OpenComment, "/* e"),
        ];
        assert_eq!(found, expected);
        assert_eq!(kinds("/*/"), [(OpenComment, "/*/")]);
    }

    #[test]
    fn words_of_other_alphabets_and_signs_are_one_token_each() {
        let text = "\u{feff}\u{3b8}_1 a\u{3b8} BEGIN Begin \0\0# \u{2212}x x\u{2212}";
        let found = kinds(text);
        let expected = [
            (ForeignWord, "\u{3b8}_1"),
            (ForeignWord, "a\u{3b8}"),
            (TokenKind::Keyword(super::Keyword::Begin), "BEGIN"),
            (Word, "Begin"),
            (Unknown, "\0\0#"),
            (Unknown, "\u{2212}"),
            (Word, "x"),
            (Word, "x"),
            (Unknown, "\u{2212}"),
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn between_tokens_is_white_space_only() {
        let text = "BEGIN a;\u{a0}\u{2003}.5.x [m/s^2] <= >= \u{1F600}\u{0301} 3\u{3b8} /*";
        let mut at = 0;
        for one in tokens(text) {
            let (start, end) = (one.span.start as usize, one.span.end as usize);
            assert!(
                text.as_bytes()[at..start]
                    .iter()
                    .all(|byte| is_white(*byte))
            );
            assert!(start < end && text.get(start..end).is_some());
            at = end;
        }
        assert_eq!(at, text.len());
    }
}
