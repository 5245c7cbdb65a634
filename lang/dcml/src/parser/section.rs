//! Sections of declarations: names with their documentation, units, ranges and numbers.
//!
//! Owns where documentation belongs: what stands before a name, or after its comma on the same line, is the name's; what
//! stands before a section is that of all its names that have none.

use super::super::diagnostic::{Code, Diagnostic};
use super::super::lexer::{Keyword, TokenKind, slice};
use super::super::syntax::{Declaration, Domain, Kind, ModelText, Name, Node, Section, Span};
use super::paper::{Beyond, Part};
use super::{Parser, join, shown};

/// What follows a name.
enum Next {
    Name,
    End,
}

impl Parser<'_, '_> {
    /// From the keyword to the semicolon.
    pub(super) fn section(&mut self, kind: Kind, model: &mut ModelText) {
        let doc = self.doc_before();
        let earlier = model.sections.iter().any(|one| one.kind == kind);
        if !earlier {
            self.paper_order(Part::of(kind));
        }
        let first = self.bump().span;
        let doc = doc.or(self.doc_before());
        if self.take(TokenKind::Colon).is_none() {
            self.unexpected("`:`");
        }
        if earlier {
            self.extension(first, Beyond::SecondSection);
        }
        let mut names = Vec::new();
        while let Some((name, next)) = self.declaration(kind) {
            names.extend(name);
            if matches!(next, Next::End) {
                break;
            }
        }
        for one in &mut names {
            if one.doc.is_none() {
                one.doc.clone_from(&doc);
            }
        }
        let span = join(first, self.before());
        model.sections.push(Section { kind, span, names });
    }

    /// One declaration and what separates it from the next; nothing if there is no name, which is told.
    fn declaration(&mut self, kind: Kind) -> Option<(Option<Declaration>, Next)> {
        let doc = self.doc_before();
        if let TokenKind::Keyword(_) = self.kind()
            && self.kind_after(1) != TokenKind::Comma
            && self.kind_after(1) != TokenKind::Semicolon
        {
            // Another section begins: this one ended with a comma, or was empty.
            self.unexpected("a name");
            return None;
        }
        if self.kind() == TokenKind::Keyword(Keyword::End) && self.begins_line() {
            self.unexpected("a name");
            return None;
        }
        let is_keyword = matches!(self.kind(), TokenKind::Keyword(_));
        let Some(name) = self.name() else {
            self.damage.names = true;
            if is_keyword {
                self.bump();
                return Some((None, self.separator(kind)?));
            }
            self.skip_in_section();
            return match self.take(TokenKind::Comma) {
                Some(_) => Some((None, Next::Name)),
                None => {
                    self.take(TokenKind::Semicolon);
                    None
                }
            };
        };
        let mut one = Declaration {
            doc,
            name,
            ..Declaration::default()
        };
        let is_read = self.unit(&mut one) && self.domain(&mut one) && self.value(&mut one);
        if !is_read {
            self.skip_in_section();
        }
        let inside = self.doc_before();
        let next = self.separator(kind);
        let behind = self.doc_behind();
        one.doc = one.doc.or(inside).or(behind);
        Some((Some(one), next.unwrap_or(Next::End)))
    }

    /// Goes to the next comma or semicolon of this section.
    fn skip_in_section(&mut self) {
        self.damage.any = true;
        loop {
            let is_over = matches!(
                self.kind(),
                TokenKind::Comma
                    | TokenKind::Semicolon
                    | TokenKind::Keyword(_)
                    | TokenKind::EndOfText
            );
            if is_over || (self.begins_line() && self.begins_statement()) {
                return;
            }
            self.bump();
        }
    }

    fn separator(&mut self, kind: Kind) -> Option<Next> {
        match self.kind() {
            TokenKind::Comma => {
                self.bump();
                return Some(Next::Name);
            }
            TokenKind::Semicolon => {
                self.bump();
                return Some(Next::End);
            }
            _ => {}
        }
        let is_name = matches!(self.kind(), TokenKind::Word | TokenKind::ForeignWord);
        let is_statement = self.begins_statement()
            && !(kind == Kind::Const && self.kind_after(1) == TokenKind::Equals);
        if is_name && !is_statement {
            let span = self.before();
            let found = Diagnostic::new(
                Code::MissingComma,
                span,
                "`,` is missing after this",
                "no `,` here",
            );
            self.report(
                found.hint("put a comma between names, and a semicolon after the last one"),
            );
            return Some(Next::Name);
        }
        if is_statement || self.begins_line() {
            let span = self.before();
            let found = Diagnostic::new(
                Code::MissingSemicolon,
                span,
                "`;` is missing after this",
                "no `;` here",
            );
            self.report(found.hint("end each section with `;`"));
            if is_statement {
                return None;
            }
        } else {
            self.unexpected("`,` or `;`");
        }
        self.damage.names = true;
        self.skip_in_section();
        match self.kind() {
            TokenKind::Comma => {
                self.bump();
                Some(Next::Name)
            }
            TokenKind::Semicolon => {
                self.bump();
                Some(Next::End)
            }
            _ => None,
        }
    }

    /// `[m/s]`. Gives false where the rest of the declaration cannot be read.
    fn unit(&mut self, one: &mut Declaration) -> bool {
        let Some(open) = self.take(TokenKind::OpenBracket) else {
            return true;
        };
        self.extension(open, Beyond::Units);
        while !matches!(
            self.kind(),
            TokenKind::CloseBracket
                | TokenKind::Comma
                | TokenKind::Semicolon
                | TokenKind::Equals
                | TokenKind::Keyword(_)
                | TokenKind::EndOfText
        ) {
            self.bump();
        }
        let Some(close) = self.take(TokenKind::CloseBracket) else {
            let found = Diagnostic::new(
                Code::Unclosed,
                open,
                "this bracket is not closed",
                "it begins here",
            );
            self.report(found.hint("a unit is written `[m/s]`"));
            return false;
        };
        let inside = Span {
            start: open.end,
            end: close.start,
        };
        let text = slice(self.text, inside);
        let trimmed = text.trim();
        if trimmed.contains(['\n', '\r']) || trimmed.contains("//") || trimmed.contains("/*") {
            let found = Diagnostic::new(
                Code::Unexpected,
                open,
                "a unit has one line and no comments",
                "it begins here",
            );
            self.report(found.hint("a unit is written `[m/s]`"));
        }
        let skipped = text.len() - text.trim_start().len();
        let start = inside.start + u32::try_from(skipped).unwrap_or_default();
        let length = u32::try_from(trimmed.len()).unwrap_or_default();
        let span = if trimmed.is_empty() {
            join(open, close)
        } else {
            Span {
                start,
                end: start + length,
            }
        };
        one.unit = Some(Name {
            text: trimmed.to_owned(),
            span,
        });
        true
    }

    /// `in S1` or `in -2 .. 2`.
    fn domain(&mut self, one: &mut Declaration) -> bool {
        if self.kind() != TokenKind::Word || self.word() != "in" {
            return true;
        }
        // A name that is `in` and lacks its comma would have a comma or semicolon after it.
        if matches!(self.kind_after(1), TokenKind::Comma | TokenKind::Semicolon) {
            return true;
        }
        let first = self.bump().span;
        self.extension(first, Beyond::Domain);
        if self.kind() == TokenKind::Word && self.word() == "S1" {
            let last = self.bump().span;
            one.domain = Some((Domain::Circle, join(first, last)));
            return true;
        }
        let Some((from, _)) = self.signed_number("`S1` or a number") else {
            return false;
        };
        if self.take(TokenKind::DotDot).is_none() {
            self.unexpected("`..`");
            return false;
        }
        let Some((to, last)) = self.signed_number("a number") else {
            return false;
        };
        one.domain = Some((Domain::Range(from, to), join(first, last)));
        true
    }

    /// `= 9.81`.
    fn value(&mut self, one: &mut Declaration) -> bool {
        if self.take(TokenKind::Equals).is_none() {
            return true;
        }
        let first = self.token().span;
        let from = self.at;
        self.may_be_signed = matches!(self.kind(), TokenKind::Plus | TokenKind::Minus)
            && self.kind_after(1) == TokenKind::Number;
        let value = self.expression();
        self.may_be_signed = false;
        let Some(value) = value else {
            self.damage.any = true;
            // It has a value, whatever it is.
            one.value = Some((0.0, first));
            return false;
        };
        let number = match &value.node {
            Node::Number(number) => Some(*number),
            Node::Sign(minus, inside) => match inside.node {
                Node::Number(number) if *minus => Some(-number),
                Node::Number(number) => Some(number),
                _ => None,
            },
            _ => None,
        };
        // A sign and a number are two words; what is a number and longer has parentheses.
        if number.is_some() && self.at > from + 2 {
            self.extension(value.span, Beyond::Parentheses);
        }
        if number.is_none() {
            let text = shown(slice(self.text, value.span));
            let message = format!(
                "the value of `{}` is no number but `{text}`",
                shown(&one.name.text)
            );
            let found = Diagnostic::new(Code::Unexpected, value.span, message, "a number expected");
            self.report(found.hint("what is computed is a `VAR` with an equation"));
        }
        one.value = Some((number.unwrap_or_default(), value.span));
        true
    }

    fn signed_number(&mut self, expected: &str) -> Option<(f64, Span)> {
        let first = self.token().span;
        let is_negative = match self.kind() {
            TokenKind::Minus => {
                self.bump();
                true
            }
            TokenKind::Plus => {
                self.bump();
                false
            }
            _ => false,
        };
        if self.kind() != TokenKind::Number {
            self.unexpected(expected);
            return None;
        }
        let number = self.number();
        let span = join(first, self.before());
        Some((if is_negative { -number } else { number }, span))
    }
}
