//! Expressions: precedence, calls, and how deep they may be.
//!
//! Owns their grammar. An error ends the expression: what is left of it would be told in vain.

use super::super::diagnostic::{Code, Diagnostic};
use super::super::lexer::{TokenKind, slice};
use super::super::syntax::{Comparison, ExprText, Name, Node, Operator, Span};
use super::paper::Beyond;
use super::{Parser, join, shown};
use crate::limits::DCML_DEPTH;

/// An expression and how deep its tree is.
type Measured = (ExprText, usize);

/// How tight operators bind.
const SUM: u8 = 1;
const PRODUCT: u8 = 2;

impl Parser<'_, '_> {
    /// An expression; nothing if it cannot be read, which is told.
    pub(super) fn expression(&mut self) -> Option<ExprText> {
        self.comparison(0).map(|(value, _)| value)
    }

    /// `a < b`, or a sum. `level` counts what it stands in.
    fn comparison(&mut self, level: usize) -> Option<Measured> {
        let (left, left_depth) = self.binary(SUM, level)?;
        let comparison = match self.kind() {
            TokenKind::Less => Comparison::Less,
            TokenKind::LessOrEqual => Comparison::LessOrEqual,
            TokenKind::Greater => Comparison::Greater,
            TokenKind::GreaterOrEqual => Comparison::GreaterOrEqual,
            _ => return Some((left, left_depth)),
        };
        let sign = self.bump().span;
        self.extension(sign, Beyond::Comparison);
        let (right, right_depth) = self.binary(SUM, level)?;
        let span = join(left.span, right.span);
        let depth = left_depth.max(right_depth) + 1;
        self.deep(depth, span)?;
        let node = Node::Compare(comparison, Box::new(left), Box::new(right));
        Some((ExprText { span, node }, depth))
    }

    /// Operators in a row that bind as tight as `tightness` or tighter, to the left.
    fn binary(&mut self, tightness: u8, level: usize) -> Option<Measured> {
        let (mut left, mut depth) = self.operand(tightness, level)?;
        loop {
            let operator = match (self.kind(), tightness) {
                (TokenKind::Plus, SUM) => Operator::Add,
                (TokenKind::Minus, SUM) => Operator::Subtract,
                (TokenKind::Star, PRODUCT) => Operator::Multiply,
                (TokenKind::Slash, PRODUCT) => Operator::Divide,
                _ => return Some((left, depth)),
            };
            self.bump();
            let (right, right_depth) = self.operand(tightness, level)?;
            depth = depth.max(right_depth) + 1;
            let span = join(left.span, right.span);
            if depth > DCML_DEPTH {
                self.deep(depth, right.span)?;
            }
            let node = Node::Binary(operator, Box::new(left), Box::new(right));
            left = ExprText { span, node };
        }
    }

    fn operand(&mut self, tightness: u8, level: usize) -> Option<Measured> {
        if tightness == SUM {
            self.binary(PRODUCT, level)
        } else {
            self.factor(level)
        }
    }

    fn factor(&mut self, level: usize) -> Option<Measured> {
        let span = self.token().span;
        self.deep(level, span)?;
        match self.kind() {
            TokenKind::Number => {
                let node = Node::Number(self.number());
                self.no_power()?;
                Some((ExprText { span, node }, 1))
            }
            TokenKind::Word | TokenKind::ForeignWord => {
                if self.kind_after(1) == TokenKind::Open {
                    let call = self.call(level)?;
                    self.no_power()?;
                    return Some(call);
                }
                let node = Node::Name(self.word().to_owned());
                self.bump();
                self.no_power()?;
                Some((ExprText { span, node }, 1))
            }
            TokenKind::Plus | TokenKind::Minus => {
                let is_minus = self.bump().kind == TokenKind::Minus;
                if !std::mem::take(&mut self.may_be_signed) {
                    self.extension(span, Beyond::Sign);
                }
                let (inside, depth) = self.factor(level + 1)?;
                let span = join(span, inside.span);
                self.deep(depth + 1, span)?;
                let node = Node::Sign(is_minus, Box::new(inside));
                Some((ExprText { span, node }, depth + 1))
            }
            TokenKind::Open => {
                self.bump();
                let (mut inside, depth) = self.comparison(level + 1)?;
                let last = self.close(span)?;
                inside.span = join(span, last);
                self.no_power()?;
                Some((inside, depth))
            }
            TokenKind::Keyword(_) if !self.begins_line() => {
                // Tells that it is no name.
                self.name();
                None
            }
            _ => {
                self.unexpected("a value");
                None
            }
        }
    }

    /// `name(a, b)`.
    fn call(&mut self, level: usize) -> Option<Measured> {
        let text = self.word().to_owned();
        let span = self.bump().span;
        if text == "piecewise" {
            self.extension(span, Beyond::Piecewise);
        }
        let open = self.bump().span;
        let mut arguments = Vec::new();
        let mut depth = 0;
        if self.kind() != TokenKind::Close {
            loop {
                let (argument, its_depth) = self.comparison(level + 1)?;
                arguments.push(argument);
                depth = depth.max(its_depth);
                if self.take(TokenKind::Comma).is_none() {
                    break;
                }
            }
        }
        let last = self.close(open)?;
        let whole = join(span, last);
        self.deep(depth + 1, whole)?;
        let node = Node::Call(Name { text, span }, arguments);
        Some((ExprText { span: whole, node }, depth + 1))
    }

    /// The partner of an open parenthesis. Where the statement ends without it, it is told and nothing is lost.
    fn close(&mut self, open: Span) -> Option<Span> {
        if let Some(span) = self.take(TokenKind::Close) {
            return Some(span);
        }
        let is_over =
            self.kind() == TokenKind::Semicolon || (self.begins_line() && self.begins_statement());
        if is_over {
            let found = Diagnostic::new(
                Code::Unclosed,
                open,
                "this parenthesis is not closed",
                "it begins here",
            );
            self.report(found.hint("put `)` where it ends"));
            return Some(self.before());
        }
        let found = self.unexpected_here("an operator or `)`");
        self.damage.any = true;
        if let Some(found) = found {
            self.findings
                .add(found.note(open, "the parenthesis begins here"));
        }
        None
    }

    /// `x^2` is what many try.
    fn no_power(&mut self) -> Option<()> {
        if self.kind() != TokenKind::Caret {
            return Some(());
        }
        let span = self.token().span;
        let found = Diagnostic::new(
            Code::Unexpected,
            span,
            "there is no operator `^`",
            "not an operator",
        );
        self.report(found.hint("write `pow(x, 2)` or `x * x`"));
        None
    }

    /// The number that stands here.
    pub(super) fn number(&mut self) -> f64 {
        let span = self.bump().span;
        let text = slice(self.text, span);
        let number: f64 = text.parse().unwrap_or(f64::NAN);
        let digits = text.split(['e', 'E']).next().unwrap_or_default();
        let is_zero = !digits.bytes().any(|byte| matches!(byte, b'1'..=b'9'));
        if number.is_finite() && (number != 0.0 || is_zero) {
            return number;
        }
        let what = if number == 0.0 { "small" } else { "large" };
        let message = format!("the number `{}` is too {what}", shown(text));
        let found = Diagnostic::new(Code::NumberRange, span, message, format!("too {what}"));
        self.report(found.hint("numbers lie between 4.9e-324 and 1.8e308"));
        1.0
    }

    /// Refuses what is too deep.
    fn deep(&mut self, depth: usize, span: Span) -> Option<()> {
        if depth <= DCML_DEPTH {
            return Some(());
        }
        let message = format!("the expression is deeper than {DCML_DEPTH}");
        let found = Diagnostic::new(Code::TooDeep, span, message, "too deep here");
        self.report(
            found.hint("give a name to a part of it: declare a `VAR` and write an equation for it"),
        );
        None
    }
}
