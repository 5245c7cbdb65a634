//! What each word of a document is there: a declaration, a use, a function, a unit.
//!
//! Owns that for texts that are half written: it goes by the tokens alone, so that a missing sign costs nothing behind the
//! next semicolon. Whether a name is declared is known to the rest of the editor.

use lang_dcml::function::Function;
use lang_dcml::lexer::{self, Keyword, Token, TokenKind};
use lang_dcml::syntax::{Kind, Span};
use std::ops::Range;

/// What a word is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Role {
    /// A reserved word.
    Keyword(Keyword),
    /// The name of a model, after `BEGIN`.
    ModelName,
    /// A part of the name of a package.
    Package,
    /// A name where it is declared.
    Declared(Kind),
    /// A part of a unit, between brackets.
    Unit,
    /// `in` of a domain.
    In,
    /// `S1` of a domain.
    Circle,
    /// A name that stands for its value, or whose equation this is.
    Use,
    /// `d` of a derivative.
    Derivative,
    /// A name with a parenthesis after it that is a function.
    Function(Function),
    /// `piecewise`.
    Piecewise,
    /// A name with a parenthesis after it that is no function.
    Unknown,
    /// A number.
    Number,
    /// A comment; whether it is documentation.
    Comment(bool),
    /// Any other sign.
    Sign(TokenKind),
}

/// A token with what it is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Word {
    /// Where.
    pub span: Span,
    /// What.
    pub role: Role,
}

/// One model: from `BEGIN` to `END;`, or to where the next one begins.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extent {
    /// Where it stands.
    pub span: Span,
    /// Its words.
    pub words: Range<usize>,
    /// Its name.
    pub name: Option<Span>,
}

/// All words of a text, and the models that they make.
#[derive(Clone, Debug, Default)]
pub struct Words {
    /// In the order of the text.
    pub all: Vec<Word>,
    /// In the order of the text.
    pub models: Vec<Extent>,
}

/// Where in a document the next word stands.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Place {
    /// Between models.
    Outside,
    /// Behind `BEGIN`.
    Begin,
    /// Where a section or an equation begins.
    Body,
    /// In the name of a package.
    Package,
    /// Where a section wants a name.
    Name(Kind),
    /// Behind a name of a section.
    Behind(Kind),
    /// Between brackets.
    Unit(Kind),
    /// Behind `in`.
    Domain(Kind),
    /// Behind `=` of a constant.
    Value,
    /// In an equation.
    Equation,
    /// Behind `END`.
    End,
}

/// Goes over tokens and says what they are.
#[derive(Debug)]
struct Walk<'a> {
    text: &'a str,
    place: Place,
    words: Words,
}

impl Words {
    /// Of a text.
    pub fn of(text: &str) -> Self {
        let mut walk = Walk {
            text,
            place: Place::Outside,
            words: Self::default(),
        };
        let mut tokens = lexer::tokens(text).peekable();
        while let Some(token) = tokens.next() {
            let is_called = tokens
                .peek()
                .is_some_and(|next| next.kind == TokenKind::Open);
            walk.step(token, is_called);
        }
        walk.words.close(text.len());
        walk.words
    }

    /// The word at a place; one that ends there, if none begins there.
    pub fn at(&self, offset: u32) -> Option<&Word> {
        let behind = self.all.partition_point(|one| one.span.start <= offset);
        let here = self.all[..behind]
            .last()
            .filter(|one| offset < one.span.end);
        let is_word = |one: &&Word| !matches!(one.role, Role::Sign(_));
        let before = || {
            let before = self.all.partition_point(|one| one.span.end < offset);
            self.all.get(before).filter(|one| one.span.end == offset)
        };
        here.filter(is_word)
            .or_else(|| before().filter(is_word))
            .or(here)
    }

    /// How many words end before a place, or at it.
    pub fn before(&self, offset: u32) -> usize {
        self.all.partition_point(|one| one.span.end <= offset)
    }

    /// The model that a place is in.
    pub fn model(&self, offset: u32) -> Option<&Extent> {
        let behind = self.models.partition_point(|one| one.span.start <= offset);
        let model = self.models[..behind].last()?;
        (offset <= model.span.end).then_some(model)
    }

    /// The words of a model.
    pub fn of_model(&self, model: &Extent) -> &[Word] {
        self.all.get(model.words.clone()).unwrap_or_default()
    }

    /// Where a word stands that would begin at a place; nothing in a comment.
    pub fn place(&self, text: &str, offset: u32) -> Option<Place> {
        let behind = self.all.partition_point(|one| one.span.start < offset);
        let last = self.all[..behind].last();
        let is_in = |one: &Word| match one.role {
            // A comment of one line goes on where it ends.
            Role::Comment(_) => {
                offset < one.span.end || !lexer::slice(text, one.span).ends_with("*/")
            }
            _ => false,
        };
        if last.is_some_and(|one| {
            is_in(one)
                && !lexer::slice(
                    text,
                    Span {
                        start: one.span.end,
                        end: offset,
                    },
                )
                .contains('\n')
        }) {
            return None;
        }
        let start = self.model(offset).map_or(offset, |model| model.span.start);
        let mut walk = Walk {
            text: lexer::slice(text, Span { start, end: offset }),
            place: Place::Outside,
            words: Self::default(),
        };
        let mut tokens = lexer::tokens(walk.text).peekable();
        while let Some(token) = tokens.next() {
            let is_called = tokens
                .peek()
                .is_some_and(|next| next.kind == TokenKind::Open);
            walk.step(token, is_called);
        }
        Some(walk.place)
    }

    /// Closes the last model where the text, or the next one, is.
    fn close(&mut self, end: usize) {
        let count = self.all.len();
        if let Some(last) = self.models.last_mut().filter(|one| one.words.end == 0) {
            last.words.end = count;
            last.span.end = u32::try_from(end).unwrap_or(u32::MAX);
        }
    }
}

impl Walk<'_> {
    fn step(&mut self, token: Token, is_called: bool) {
        let role = match token.kind {
            kind if kind.is_comment() => Role::Comment(kind == TokenKind::DocComment),
            TokenKind::Keyword(keyword) => self.keyword(keyword, token.span),
            TokenKind::Word | TokenKind::ForeignWord => self.word(token, is_called),
            TokenKind::Number | TokenKind::BadNumber => Role::Number,
            kind => self.sign(kind),
        };
        self.words.all.push(Word {
            span: token.span,
            role,
        });
        if self.place == Place::End && token.kind == TokenKind::Semicolon {
            self.words.close(token.span.end as usize);
            self.place = Place::Outside;
        }
    }

    fn keyword(&mut self, keyword: Keyword, span: Span) -> Role {
        self.place = match keyword {
            Keyword::Begin => {
                self.words.close(span.start as usize);
                self.words.models.push(Extent {
                    span,
                    words: self.words.all.len()..0,
                    name: None,
                });
                Place::Begin
            }
            Keyword::End => Place::End,
            Keyword::Package => Place::Package,
            Keyword::Section(kind) => Place::Name(kind),
        };
        Role::Keyword(keyword)
    }

    fn word(&mut self, token: Token, is_called: bool) -> Role {
        let word = lexer::slice(self.text, token.span);
        match self.place {
            Place::Begin => {
                if let Some(model) = self.words.models.last_mut() {
                    model.name = Some(token.span);
                }
                self.place = Place::Body;
                Role::ModelName
            }
            Place::Package => Role::Package,
            Place::Name(kind) if !is_called => {
                self.place = Place::Behind(kind);
                Role::Declared(kind)
            }
            Place::Behind(kind) if word == "in" => {
                self.place = Place::Domain(kind);
                Role::In
            }
            Place::Domain(kind) if word == "S1" => {
                self.place = Place::Behind(kind);
                Role::Circle
            }
            Place::Unit(_) => Role::Unit,
            // No section has a word here: the semicolon is missing.
            _ => {
                self.place = match self.place {
                    Place::Outside => Place::Outside,
                    _ => Place::Equation,
                };
                in_equation(word, is_called)
            }
        }
    }

    fn sign(&mut self, kind: TokenKind) -> Role {
        use Place::{Behind, Domain, Name, Outside, Unit, Value};
        self.place = match (kind, self.place) {
            (_, Outside) => Outside,
            (TokenKind::Semicolon, Place::End) => Place::End,
            (TokenKind::Semicolon, _) => Place::Body,
            (TokenKind::Comma, Name(of) | Behind(of) | Unit(of) | Domain(of)) => Name(of),
            (TokenKind::Comma, Value) => Name(Kind::Const),
            (TokenKind::OpenBracket, Name(of) | Behind(of)) => Unit(of),
            (TokenKind::CloseBracket, Unit(of)) => Behind(of),
            (TokenKind::Equals, Behind(Kind::Const) | Domain(Kind::Const)) => Value,
            (_, same) => same,
        };
        Role::Sign(kind)
    }
}

fn in_equation(word: &str, is_called: bool) -> Role {
    match Function::named(word) {
        _ if !is_called => Role::Use,
        Some(function) => Role::Function(function),
        None if word == "d" => Role::Derivative,
        None if word == "piecewise" => Role::Piecewise,
        None => Role::Unknown,
    }
}
