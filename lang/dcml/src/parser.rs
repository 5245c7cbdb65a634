//! Tokens to a tree, with recovery: one error for each statement that is wrong, and the rest is read as if it were right.
//!
//! Owns the grammar of documents, sections and equations; `cursor` has the tokens, `expression` the
//! grammar of expressions. Where a statement cannot be
//! read it goes on after its semicolon, or at what must be the beginning of the next one.

mod cursor;
mod expression;
mod paper;
mod section;

use super::diagnostic::{Code, Diagnostic, Findings};
use super::lexer::{Keyword, Token, TokenKind};
use super::nearest::nearest;
use super::syntax::{Damage, Document, EquationText, ExprText, ModelText, Name, Node, Span};
use crate::limits::DCML_SHOWN;
use paper::Part;
use std::collections::HashSet;

/// Reads a document. Where `paper` is set, what the published language does not have is an error.
pub(super) fn parse(text: &str, paper: bool, findings: &mut Findings) -> Document {
    let mut parser = Parser {
        text,
        tokens: Vec::new(),
        docs: Vec::new(),
        next_doc: 0,
        at: 0,
        findings,
        foreign: HashSet::new(),
        bad: Vec::new(),
        damage: Damage::default(),
        paper,
        furthest: None,
        may_be_signed: false,
        is_cut: false,
    };
    if parser.read_tokens() {
        parser.document()
    } else {
        Document::default()
    }
}

struct Parser<'a, 'f> {
    text: &'a str,
    /// Without comments; the last one is the end of the text.
    tokens: Vec<Token>,
    /// Documentation, each with the token before which it stands.
    docs: Vec<(usize, Span)>,
    next_doc: usize,
    at: usize,
    findings: &'f mut Findings,
    /// Names with foreign letters that are told.
    foreign: HashSet<&'a str>,
    /// Where tokens were wrong.
    bad: Vec<u32>,
    damage: Damage,
    paper: bool,
    /// The last part of this model in the order of the published grammar.
    furthest: Option<Part>,
    /// The next sign belongs to the number of a constant.
    may_be_signed: bool,
    /// The text ends inside a comment.
    is_cut: bool,
}

/// A text as it is shown in a message: one line that is not too long.
pub(super) fn shown(text: &str) -> String {
    let plain = |sign: char| if sign.is_control() { ' ' } else { sign };
    let mut signs = text.chars().map(plain);
    let mut begin: String = signs.by_ref().take(DCML_SHOWN).collect();
    if signs.next().is_some() {
        begin.push_str("...");
    }
    begin
}

/// From the beginning of one to the end of another.
fn join(first: Span, last: Span) -> Span {
    Span {
        start: first.start,
        end: last.end.max(first.end),
    }
}

impl<'a> Parser<'a, '_> {
    fn document(&mut self) -> Document {
        let mut document = Document::default();
        loop {
            match self.kind() {
                TokenKind::EndOfText => break,
                TokenKind::Keyword(Keyword::Begin) => {
                    let model = self.model();
                    document.models.push(model);
                }
                _ => self.outside(),
            }
        }
        if document.models.is_empty() && self.findings.errors() == 0 {
            let span = self.visible(self.token().span);
            let found = Diagnostic::new(
                Code::NoModel,
                span,
                "there is no model in this document",
                "nothing here",
            );
            self.findings
                .add(found.hint("a model begins with `BEGIN Name` and ends with `END;`"));
        }
        document
    }

    /// All that stands between models, told once.
    fn outside(&mut self) {
        let first = self.token().span;
        let word = self.word();
        if Keyword::named(&word.to_ascii_uppercase()) == Some(Keyword::Begin) {
            let found = Diagnostic::new(
                Code::OutsideModel,
                first,
                format!("`{word}` begins no model"),
                "write `BEGIN`",
            );
            self.findings
                .add(found.hint("reserved words have capital letters only"));
            let model = self.model();
            // Only its rules of meaning are of use.
            let _ = model;
            return;
        }
        while !matches!(
            self.kind(),
            TokenKind::EndOfText | TokenKind::Keyword(Keyword::Begin)
        ) {
            self.bump();
        }
        let found = Diagnostic::new(
            Code::OutsideModel,
            first,
            "this stands in no model",
            "outside of all models",
        );
        self.findings
            .add(found.hint("a model begins with `BEGIN Name` and ends with `END;`"));
    }

    fn model(&mut self) -> ModelText {
        self.damage = Damage::default();
        self.furthest = None;
        let mut model = ModelText {
            doc: self.doc_before(),
            ..ModelText::default()
        };
        let begin = self.bump().span;
        let inside = self.doc_before();
        model.name = self.model_name(begin);
        let behind = self.doc_behind();
        model.doc = model.doc.or(inside).or(behind);
        loop {
            let from = self.at;
            match self.kind() {
                TokenKind::Keyword(Keyword::End) => {
                    self.end(&model.name);
                    self.doc_behind();
                    break;
                }
                TokenKind::EndOfText if self.is_cut => {
                    // The end is in the comment, and so is what else is missing.
                    self.damage = Damage {
                        any: true,
                        names: true,
                        equations: true,
                    };
                    break;
                }
                TokenKind::EndOfText | TokenKind::Keyword(Keyword::Begin) => {
                    let message = format!("the model `{}` has no end", shown(&model.name.text));
                    let found = Diagnostic::new(Code::MissingEnd, begin, message, "it begins here");
                    self.report(found.hint("end it with `END;`"));
                    break;
                }
                TokenKind::Keyword(Keyword::Package) => self.package(&mut model),
                TokenKind::Keyword(Keyword::Section(kind)) => self.section(kind, &mut model),
                TokenKind::Word | TokenKind::ForeignWord => {
                    if self.statement(&mut model) {
                        break;
                    }
                }
                _ => {
                    self.unexpected("a section, an equation or `END;`");
                    self.damage.equations = true;
                    self.skip_statement();
                }
            }
            if self.at == from {
                self.bump();
            }
            // Behind an equation it is nobody's.
            self.doc_behind();
        }
        model.span = join(begin, self.before());
        let first = self.bad.partition_point(|at| *at < model.span.start);
        let is_bad = self.bad.get(first).is_some_and(|at| *at < model.span.end);
        self.damage.any |= is_bad;
        model.damage = self.damage;
        model
    }

    fn model_name(&mut self, begin: Span) -> Name {
        match self.kind() {
            TokenKind::Word | TokenKind::ForeignWord => {
                let text = self.word().to_owned();
                let span = self.bump().span;
                // A semicolon after the name is a common slip, and harmless.
                if let Some(span) = self.take(TokenKind::Semicolon) {
                    let found = Diagnostic::new(
                        Code::Unexpected,
                        span,
                        "no `;` stands after `BEGIN Name`",
                        "remove it",
                    );
                    self.report(found);
                }
                Name { text, span }
            }
            _ => {
                let found = Diagnostic::new(
                    Code::Unexpected,
                    begin,
                    "this model has no name",
                    "a name expected after it",
                )
                .hint("write `BEGIN Name`");
                self.report(found);
                Name {
                    text: String::new(),
                    span: begin,
                }
            }
        }
    }

    fn end(&mut self, name: &Name) {
        let end = self.bump().span;
        if self.take(TokenKind::Semicolon).is_some() {
            return;
        }
        // `END Name;` is what other languages have.
        let is_name = self.kind() == TokenKind::Word && self.word() == name.text;
        if is_name && self.kind_after(1) == TokenKind::Semicolon {
            let span = self.bump().span;
            self.bump();
            let found = Diagnostic::new(
                Code::Unexpected,
                span,
                "no name stands after `END`",
                "remove it",
            );
            self.report(found.hint("a model ends with `END;`"));
            return;
        }
        let found = Diagnostic::new(
            Code::MissingSemicolon,
            end,
            "`;` is missing after `END`",
            "no `;` here",
        );
        self.report(found.hint("a model ends with `END;`"));
    }

    /// What begins with a word: an equation, or a section that is not spelled right. Whether it ends the model.
    fn statement(&mut self, model: &mut ModelText) -> bool {
        let word = self.word();
        if word == "d" && self.kind_after(1) == TokenKind::Open {
            self.equation(model, true);
            return false;
        }
        match self.kind_after(1) {
            TokenKind::Equals => self.equation(model, false),
            TokenKind::Colon => self.unknown_section(model),
            TokenKind::Open
                if self.kind_after(3) == TokenKind::Close
                    && self.kind_after(4) == TokenKind::Equals =>
            {
                let span = self.token().span;
                let message = format!("`{}` of a name has no equation", shown(word));
                let found = Diagnostic::new(Code::Unexpected, span, message, "write `d`");
                self.report(found.hint("a derivative is written `d(x) = ...;`"));
                self.equation(model, true);
            }
            next => {
                let keyword = Keyword::named(&word.to_ascii_uppercase());
                if keyword == Some(Keyword::End) && next == TokenKind::Semicolon {
                    let span = self.token().span;
                    let found = Diagnostic::new(
                        Code::Unexpected,
                        span,
                        format!("`{word}` ends no model"),
                        "write `END`",
                    );
                    self.report(found.hint("reserved words have capital letters only"));
                    self.bump();
                    self.bump();
                    return true;
                }
                self.bump();
                self.unexpected("`=`");
                self.damage.equations = true;
                self.skip_statement();
            }
        }
        false
    }

    fn unknown_section(&mut self, model: &mut ModelText) {
        let word = self.word();
        let span = self.token().span;
        let meant = nearest(word, Keyword::ALL.map(Keyword::text)).and_then(Keyword::named);
        let message = format!("there is no section `{}`", shown(word));
        let found = Diagnostic::new(Code::UnknownSection, span, message, "not a section");
        match meant {
            Some(Keyword::Section(kind)) => {
                self.report(found.hint(format!("did you mean `{}`?", kind.keyword())));
                self.section(kind, model);
            }
            Some(Keyword::Package) => {
                self.report(found.hint("did you mean `PACKAGE`?"));
                self.package(model);
            }
            _ => {
                self.report(found.hint("there are PACKAGE, ACTION, PARAM, CONST, CONFIG and VAR"));
                self.damage.names = true;
                self.bump();
                self.bump();
                self.skip_statement();
            }
        }
    }

    fn equation(&mut self, model: &mut ModelText, is_derivative: bool) {
        let first = self.token().span;
        self.paper_order(Part::Equation);
        let target = if is_derivative {
            self.bump();
            self.derivative_target()
        } else {
            self.name()
        };
        let Some(target) = target else {
            self.damage.equations = true;
            self.skip_statement();
            return;
        };
        let value = if self.take(TokenKind::Equals).is_none() {
            self.unexpected("`=`");
            None
        } else {
            self.expression()
        };
        let value = match value {
            Some(value) => {
                self.semicolon();
                value
            }
            None => {
                self.damage.any = true;
                self.skip_statement();
                let span = target.span;
                ExprText {
                    span,
                    node: Node::Broken,
                }
            }
        };
        let span = join(first, self.before());
        model.equations.push(EquationText {
            span,
            target,
            is_derivative,
            value,
        });
    }

    /// `(x)` after `d`.
    fn derivative_target(&mut self) -> Option<Name> {
        self.bump();
        let name = self.name()?;
        if self.take(TokenKind::Close).is_none() {
            self.unexpected("`)`");
            return None;
        }
        Some(name)
    }

    /// A name; else tells that it is none.
    fn name(&mut self) -> Option<Name> {
        match self.kind() {
            TokenKind::Word | TokenKind::ForeignWord => {
                let text = self.word().to_owned();
                let span = self.bump().span;
                Some(Name { text, span })
            }
            TokenKind::Keyword(_) => {
                let word = self.word();
                let span = self.token().span;
                let message = format!("`{word}` is a reserved word and no name");
                let hint = format!(
                    "choose another name, for example `{}`",
                    word.to_ascii_lowercase()
                );
                let found =
                    Diagnostic::new(Code::ReservedName, span, message, "reserved").hint(hint);
                self.report(found);
                None
            }
            _ => {
                self.unexpected("a name");
                None
            }
        }
    }

    fn package(&mut self, model: &mut ModelText) {
        if model.package.is_none() {
            self.paper_order(Part::Package);
        }
        let keyword = self.bump().span;
        if self.take(TokenKind::Colon).is_none() {
            self.unexpected("`:`");
        }
        let Some(mut name) = self.name() else {
            self.skip_statement();
            return;
        };
        while self.take(TokenKind::Dot).is_some() {
            let Some(next) = self.name() else {
                self.skip_statement();
                return;
            };
            name.text.push('.');
            name.text.push_str(&next.text);
            name.span = join(name.span, next.span);
        }
        self.semicolon();
        if let Some(first) = &model.package {
            let found = Diagnostic::new(
                Code::DuplicatePackage,
                keyword,
                "the model has a package already",
                "a second one",
            );
            let found = found.note(first.span, "the first one is here");
            self.report(found);
            return;
        }
        model.package = Some(name);
    }
}
