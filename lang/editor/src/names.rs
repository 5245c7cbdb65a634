//! The names of a document: where each is declared, where it is used.
//!
//! Owns the search. A name means one thing in a model, so all words of it that are equal are the same.

use super::Reading;
use super::words::{Extent, Role, Word};
use crate::limits::DCML_EDITOR_PLACES;
use lang_dcml::syntax::{Declaration, EquationText, Kind, ModelText, Span};

/// What the word at a place is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meant<'a> {
    /// The word.
    pub(super) word: Word,
    /// How it is written.
    pub(super) text: &'a str,
    /// The model that it stands in.
    pub(super) model: Option<&'a Extent>,
}

/// A declared name with all that is said where it is declared.
#[derive(Clone, Copy, Debug)]
pub(super) struct Declared<'a> {
    pub(super) kind: Kind,
    pub(super) said: &'a Declaration,
}

impl Reading {
    /// The word at a place, if it is a name or another word that means something.
    pub(super) fn meant(&self, offset: u32) -> Option<Meant<'_>> {
        let word = *self.words.at(offset)?;
        Some(Meant {
            word,
            text: self.slice(word.span),
            model: self.words.model(word.span.start),
        })
    }

    /// The tree of a model that the words see.
    pub(super) fn tree(&self, model: &Extent) -> Option<&ModelText> {
        let all = &self.document().models;
        let behind = all.partition_point(|one| one.span.start <= model.span.start);
        let found = all[..behind].last()?;
        (model.span.start < found.span.end).then_some(found)
    }

    /// All declarations of a model.
    pub(super) fn declarations<'a>(&'a self, model: &Extent) -> impl Iterator<Item = Declared<'a>> {
        let sections = self.tree(model).into_iter().flat_map(|tree| &tree.sections);
        sections.flat_map(|section| {
            let kind = section.kind;
            section
                .names
                .iter()
                .map(move |said| Declared { kind, said })
        })
    }

    /// The first declaration of a name.
    pub(super) fn declared(&self, model: &Extent, name: &str) -> Option<Declared<'_>> {
        self.declarations(model)
            .find(|one| one.said.name.text == name)
    }

    /// The equations of a name, in the order of the text.
    pub(super) fn equations<'a>(
        &'a self,
        model: &Extent,
        name: &'a str,
    ) -> impl Iterator<Item = &'a EquationText> {
        let equations = self
            .tree(model)
            .into_iter()
            .flat_map(|tree| &tree.equations);
        equations.filter(move |one| one.target.text == name)
    }

    /// Where the name at a place is declared: the name of the declaration, or of the model.
    pub fn definition(&self, offset: u32) -> Option<Span> {
        let meant = self.meant(offset)?;
        match meant.word.role {
            Role::ModelName => Some(meant.word.span),
            Role::Declared(_) | Role::Use => {
                let words = self.words.of_model(meant.model?);
                let is_declared = |one: &&Word| matches!(one.role, Role::Declared(_));
                let mut declared = words.iter().filter(is_declared);
                declared
                    .find(|one| self.slice(one.span) == meant.text)
                    .map(|one| one.span)
            }
            _ => None,
        }
    }

    /// All places of the name at a place, in the order of the text, and whether each declares it; at most
    /// [`DCML_EDITOR_PLACES`].
    pub fn references(&self, offset: u32) -> Vec<(Span, bool)> {
        let found = self.meant(offset).map(|meant| self.occurrences(meant));
        found.unwrap_or_default()
    }

    /// Places where the name at a place gets its value, in the order of the text: declarations and left sides of equations.
    pub fn writes(&self, offset: u32) -> Vec<Span> {
        let Some(meant) = self.meant(offset) else {
            return Vec::new();
        };
        let Some(model) = meant.model else {
            return Vec::new();
        };
        let declared = self
            .occurrences(meant)
            .into_iter()
            .filter(|(_, is_declared)| *is_declared);
        let targets = self.equations(model, meant.text).map(|one| one.target.span);
        let mut all: Vec<Span> = declared.map(|(span, _)| span).chain(targets).collect();
        all.sort_unstable();
        all
    }

    fn occurrences(&self, meant: Meant<'_>) -> Vec<(Span, bool)> {
        let Some(model) = meant.model else {
            return Vec::new();
        };
        let is_same = |one: &&Word| match (meant.word.role, one.role) {
            (Role::Declared(_) | Role::Use, Role::Declared(_) | Role::Use) => {
                self.slice(one.span) == meant.text
            }
            (Role::Function(this), Role::Function(other)) => this == other,
            (Role::ModelName, Role::ModelName) => one.span == meant.word.span,
            (Role::Piecewise, Role::Piecewise) => true,
            _ => false,
        };
        let words = self.words.of_model(model).iter().filter(is_same);
        let words = words.take(DCML_EDITOR_PLACES);
        words
            .map(|one| {
                (
                    one.span,
                    matches!(one.role, Role::Declared(_) | Role::ModelName),
                )
            })
            .collect()
    }
}
