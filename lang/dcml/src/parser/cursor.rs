//! The tokens of a document, one after another: where the parser is, what it tells, and documentation on its way.
//!
//! Owns what is wrong with single tokens, and where a statement ends that cannot be read. Knows no grammar.

use super::super::diagnostic::{Code, Diagnostic};
use super::super::lexer::{self, Token, TokenKind, slice};
use super::super::syntax::{Doc, Span};
use super::paper::Beyond;
use super::{Parser, shown};
use crate::limits::{DCML_SHOWN, DCML_TOKENS};

impl<'a> Parser<'a, '_> {
    /// All tokens; what is wrong with one is told here. Not if there are too many.
    pub(super) fn read_tokens(&mut self) -> bool {
        for one in lexer::tokens(self.text) {
            match one.kind {
                TokenKind::DocComment => self.docs.push((self.tokens.len(), one.span)),
                TokenKind::LineComment | TokenKind::BlockComment => {
                    if self.paper {
                        self.bad.push(one.span.start);
                    }
                    self.extension(one.span, Beyond::Comment);
                }
                kind => {
                    self.tell_bad(kind, one.span);
                    if kind != TokenKind::OpenComment {
                        self.tokens.push(one);
                    }
                }
            }
            if self.tokens.len() + self.docs.len() > DCML_TOKENS {
                let message = format!("the document has more than {DCML_TOKENS} words and signs");
                let found = Diagnostic::new(Code::TooLong, one.span, message, "this is too much");
                self.findings
                    .add(found.hint("put its models into several files"));
                return false;
            }
        }
        let end = u32::try_from(self.text.len()).unwrap_or(u32::MAX);
        let span = Span { start: end, end };
        let kind = TokenKind::EndOfText;
        self.tokens.push(Token { kind, span });
        self.paper_documentation();
        true
    }

    pub(super) fn tell_bad(&mut self, kind: TokenKind, span: Span) {
        let word = slice(self.text, span);
        let found = match kind {
            TokenKind::Unknown => unknown_sign(word, span),
            TokenKind::BadNumber => bad_number(word, span),
            TokenKind::OpenComment => {
                self.is_cut = true;
                let start = Span {
                    start: span.start,
                    end: span.start + 2,
                };
                Diagnostic::new(
                    Code::OpenComment,
                    start,
                    "this comment has no end",
                    "it begins here",
                )
                .hint("end it with `*/`")
            }
            TokenKind::ForeignWord => {
                self.bad.push(span.start);
                if !self.foreign.insert(word) {
                    return;
                }
                let message = format!("`{}` has letters that are not Latin", shown(word));
                Diagnostic::new(Code::ForeignName, span, message, "not a name")
                    .hint("names have Latin letters, digits and `_`: `theta`, `omega_1`")
            }
            _ => return,
        };
        self.bad.push(span.start);
        self.findings.add(found);
    }

    pub(super) fn token(&self) -> Token {
        // There is an end of the text, and nobody goes beyond it.
        self.tokens[self.at]
    }

    pub(super) fn kind(&self) -> TokenKind {
        self.token().kind
    }

    pub(super) fn kind_after(&self, count: usize) -> TokenKind {
        let last = self.tokens.len() - 1;
        self.tokens[(self.at + count).min(last)].kind
    }

    pub(super) fn word(&self) -> &'a str {
        slice(self.text, self.token().span)
    }

    /// The token before this one; at the beginning this one.
    pub(super) fn before(&self) -> Span {
        self.tokens[self.at.saturating_sub(1)].span
    }

    pub(super) fn bump(&mut self) -> Token {
        let token = self.token();
        if self.at + 1 < self.tokens.len() {
            self.at += 1;
        }
        token
    }

    pub(super) fn take(&mut self, kind: TokenKind) -> Option<Span> {
        (self.kind() == kind).then(|| self.bump().span)
    }

    pub(super) fn report(&mut self, found: Diagnostic) {
        self.damage.any = true;
        self.findings.add(found);
    }

    /// Tells that something else should stand here, if the token itself is not told already.
    pub(super) fn unexpected(&mut self, expected: &str) {
        let found = self.unexpected_here(expected);
        self.damage.any = true;
        if let Some(found) = found {
            self.findings.add(found);
        }
    }

    pub(super) fn unexpected_here(&self, expected: &str) -> Option<Diagnostic> {
        let span = self.token().span;
        let what = match self.kind() {
            TokenKind::Unknown | TokenKind::BadNumber => return None,
            TokenKind::EndOfText => "the text ends".to_owned(),
            _ => format!("`{}` stands", shown(self.word())),
        };
        let message = format!("{what} where {expected} should be");
        let label = format!("{expected} expected");
        Some(Diagnostic::new(
            Code::Unexpected,
            self.visible(span),
            message,
            label,
        ))
    }

    /// A place that can be shown: the end of the text has nothing to point at, so it is what stands before it.
    pub(super) fn visible(&self, span: Span) -> Span {
        if span.start < span.end {
            span
        } else {
            self.before()
        }
    }

    /// Whether a line ends between the token before this one and this one.
    pub(super) fn begins_line(&self) -> bool {
        let gap = Span {
            start: self.before().end,
            end: self.token().span.start,
        };
        self.kind() == TokenKind::EndOfText || slice(self.text, gap).contains('\n')
    }

    /// Whether what stands here is surely the beginning of a statement.
    pub(super) fn begins_statement(&self) -> bool {
        match self.kind() {
            TokenKind::Keyword(_) | TokenKind::EndOfText => true,
            TokenKind::Word | TokenKind::ForeignWord => {
                let is_derivative = self.word() == "d"
                    && self.kind_after(1) == TokenKind::Open
                    && self.kind_after(3) == TokenKind::Close
                    && self.kind_after(4) == TokenKind::Equals;
                is_derivative || matches!(self.kind_after(1), TokenKind::Equals | TokenKind::Colon)
            }
            _ => false,
        }
    }

    /// The semicolon at the end of a statement.
    pub(super) fn semicolon(&mut self) {
        if self.take(TokenKind::Semicolon).is_some() {
            return;
        }
        if self.begins_line() || self.begins_statement() {
            let span = self.before();
            let found = Diagnostic::new(
                Code::MissingSemicolon,
                span,
                "`;` is missing after this",
                "no `;` here",
            );
            self.report(found.hint("end each statement with `;`"));
            if self.begins_statement() || self.kind() == TokenKind::Open {
                return;
            }
        } else {
            self.unexpected("`;`");
        }
        self.skip_statement();
    }

    /// Goes to the token after the next semicolon, or before what begins another statement.
    pub(super) fn skip_statement(&mut self) {
        loop {
            match self.kind() {
                TokenKind::EndOfText | TokenKind::Keyword(_) => return,
                TokenKind::Semicolon => {
                    self.bump();
                    return;
                }
                _ if self.begins_line() && self.begins_statement() => return,
                _ => self.bump(),
            };
        }
    }

    /// The documentation that stands directly before this token.
    pub(super) fn doc_before(&mut self) -> Option<Doc> {
        let mut found = None;
        while let Some(&(before, span)) = self.docs.get(self.next_doc) {
            if before > self.at {
                break;
            }
            self.next_doc += 1;
            if before == self.at {
                found = Some(self.doc(span));
            }
        }
        found
    }

    /// The first documentation after the end of a statement or declaration: on the same line, where the next word is not.
    /// What else stands there is passed.
    pub(super) fn doc_behind(&mut self) -> Option<Doc> {
        let end = self.before().end;
        let next = self.token();
        let mut first = None;
        while let Some(&(before, span)) = self.docs.get(self.next_doc) {
            let has_break = |start, end| slice(self.text, Span { start, end }).contains('\n');
            let is_last = next.kind == TokenKind::EndOfText;
            let is_earlier = before < self.at;
            let is_behind = before == self.at && !has_break(end, span.start);
            if !is_earlier && !(is_behind && (is_last || has_break(span.end, next.span.start))) {
                break;
            }
            self.next_doc += 1;
            if first.is_none() && !is_earlier {
                first = Some(self.doc(span));
            }
        }
        first
    }

    pub(super) fn doc(&self, span: Span) -> Doc {
        Doc {
            text: plain(slice(self.text, span)),
            span,
        }
    }
}

/// What a documentation comment says: without its signs, and the stars and spaces at the beginnings of lines.
fn plain(comment: &str) -> String {
    let inside = comment.strip_prefix("/**").unwrap_or(comment);
    let inside = inside.strip_suffix("*/").unwrap_or(inside);
    let mut lines: Vec<&str> = Vec::new();
    for (at, line) in inside.lines().enumerate() {
        let line = line.trim_end();
        let trimmed = line.trim_start();
        let star = trimmed.strip_prefix('*').filter(|_| at > 0);
        lines.push(match star {
            Some(rest) => rest.strip_prefix(' ').unwrap_or(rest),
            None => trimmed,
        });
    }
    lines.join("\n").trim_matches('\n').trim_end().to_owned()
}

fn unknown_sign(word: &str, span: Span) -> Diagnostic {
    let first = word.chars().next().unwrap_or_default();
    let name = match first {
        sign if sign.is_control() || sign.is_whitespace() => format!("U+{:04X}", u32::from(sign)),
        sign => format!("{sign} (U+{:04X})", u32::from(sign)),
    };
    let found = Diagnostic::new(
        Code::UnknownSign,
        span,
        format!("the sign {name} means nothing here"),
        "not of the language",
    );
    match first {
        '\0' => found.hint("is this a text file?"),
        '\u{2212}' | '\u{2013}' | '\u{2014}' => found.hint("write the minus sign `-`"),
        '\u{d7}' | '\u{b7}' | '\u{22c5}' => found.hint("write `*`"),
        sign if sign.is_whitespace() => found.hint("write a plain space"),
        '{' | '}' => found.hint("write `(` and `)`"),
        '#' => found.hint("a comment begins with `//`"),
        '%' => found.hint(
            "a comment begins with `//`; the remainder of a division is `a - b * floor(a / b)`",
        ),
        _ => found.hint("remove it"),
    }
}

fn bad_number(word: &str, span: Span) -> Diagnostic {
    let message = format!("`{}` is no number", shown(word));
    let found = Diagnostic::new(Code::BadNumber, span, message, "not a number");
    let digits = word.find(|sign: char| !(sign.is_ascii_digit() || sign == '.'));
    let (number, rest) = word.split_at(digits.unwrap_or(word.len()));
    let is_name = rest.starts_with(|sign: char| sign.is_ascii_alphabetic());
    if is_name && !rest.contains('.') && number.parse::<f64>().is_ok() && word.len() < DCML_SHOWN {
        return found.hint(format!(
            "to multiply write `{number} * {rest}`; a name begins with a letter"
        ));
    }
    found.hint("numbers are written `12`, `0.5` or `1.5e-3`")
}
