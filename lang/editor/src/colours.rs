//! The colours of words by what they mean.
//!
//! Owns which word is what to an editor; which colour that is, is its own.

use super::Reading;
use super::words::Role;
use crate::limits::DCML_EDITOR_PLACES;
use lang_dcml::syntax::{Kind, Span};
use std::collections::{HashMap, HashSet};

/// What a word is to an editor.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Colour {
    /// A reserved word, `in`, `piecewise`, `d`.
    Keyword,
    /// A model.
    Model,
    /// A package.
    Package,
    /// An action or a parameter.
    Parameter,
    /// A part of the configuration.
    Property,
    /// A constant, `pi` and `e` too, or a variable.
    Variable,
    /// A function.
    Function,
    /// A unit, or the circle.
    Type,
    /// A number.
    Number,
    /// A comment.
    Comment,
}

impl Colour {
    /// All, in the order of their numbers.
    pub const ALL: [Self; 10] = [
        Self::Keyword,
        Self::Model,
        Self::Package,
        Self::Parameter,
        Self::Property,
        Self::Variable,
        Self::Function,
        Self::Type,
        Self::Number,
        Self::Comment,
    ];
}

/// A word with its colour.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Painted {
    /// Where; never more than one line, but for comments.
    pub span: Span,
    /// What it is.
    pub colour: Colour,
    /// It is declared here.
    pub is_declaration: bool,
    /// It never changes while a robot drives: constants and parameters.
    pub is_fixed: bool,
    /// It belongs to the language.
    pub is_of_language: bool,
    /// It is documentation.
    pub is_doc: bool,
}

impl Reading {
    /// The words of a stretch with their colours, in the order of the text; at most [`DCML_EDITOR_PLACES`]. Names that are
    /// not declared have none.
    pub fn colours(&self, stretch: Span) -> Vec<Painted> {
        let mut all = Vec::new();
        let from = self.words.before(stretch.start);
        let mut model = usize::MAX;
        let (mut kinds, mut declared) = (HashMap::new(), HashSet::new());
        for (at, word) in self.words.all.iter().enumerate().skip(from) {
            if word.span.start >= stretch.end || all.len() >= DCML_EDITOR_PLACES {
                break;
            }
            let behind = self
                .words
                .models
                .partition_point(|one| one.words.start <= at);
            if model != behind {
                model = behind;
                (kinds, declared) = self.kinds(behind);
            }
            let text = self.slice(word.span);
            all.extend(
                paint(word.role, kinds.get(text).copied(), text).map(|painted| Painted {
                    span: word.span,
                    is_declaration: declared.contains(&word.span) || word.role == Role::ModelName,
                    ..painted
                }),
            );
        }
        all
    }

    /// The kinds of the names of the model with a number from 1, and where they are declared.
    fn kinds(&self, number: usize) -> (HashMap<&str, Kind>, HashSet<Span>) {
        let model = number
            .checked_sub(1)
            .and_then(|at| self.words.models.get(at));
        let words = model
            .map(|model| self.words.of_model(model))
            .unwrap_or_default();
        let (mut kinds, mut spans) = (HashMap::new(), HashSet::new());
        for word in words {
            if let Role::Declared(kind) = word.role {
                kinds.entry(self.slice(word.span)).or_insert(kind);
                spans.insert(word.span);
            }
        }
        (kinds, spans)
    }
}

fn paint(role: Role, kind: Option<Kind>, text: &str) -> Option<Painted> {
    let of_language = |colour| (colour, true);
    let (colour, is_of_language) = match role {
        Role::Keyword(_) | Role::In | Role::Piecewise | Role::Derivative => {
            of_language(Colour::Keyword)
        }
        Role::ModelName => (Colour::Model, false),
        Role::Package => (Colour::Package, false),
        Role::Unit | Role::Circle => of_language(Colour::Type),
        Role::Function(_) => of_language(Colour::Function),
        Role::Number => (Colour::Number, false),
        Role::Comment(_) => (Colour::Comment, false),
        Role::Declared(_) | Role::Use => match kind {
            Some(Kind::Action | Kind::Param) => (Colour::Parameter, false),
            Some(Kind::Config) => (Colour::Property, false),
            Some(Kind::Const | Kind::Var) => (Colour::Variable, false),
            None if matches!(text, "pi" | "e") => of_language(Colour::Variable),
            None => return None,
        },
        Role::Unknown | Role::Sign(_) => return None,
    };
    let is_fixed = colour == Colour::Variable && is_of_language;
    Some(Painted {
        span: Span::default(),
        colour,
        is_declaration: false,
        is_fixed: is_fixed
            || matches!(
                (role, kind),
                (
                    Role::Declared(_) | Role::Use,
                    Some(Kind::Const | Kind::Param)
                )
            ),
        is_of_language,
        is_doc: role == Role::Comment(true),
    })
}
