//! A document as an outline, and what of it can be folded.
//!
//! Owns the shape of both.

use super::Reading;
use super::about::shortened;
use super::words::{Extent, Role, Word};
use crate::limits::{DCML_EDITOR_NAME_BYTES, DCML_EDITOR_PLACES};
use lang_dcml::syntax::{Kind, Span};

/// What an entry of the outline is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum SymbolKind {
    /// A model.
    Model,
    /// A declared name.
    Name(Kind),
    /// An equation.
    Equation,
}

/// An entry of the outline.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Symbol {
    /// Its name; of an equation the left side.
    pub name: String,
    /// A few words about it.
    pub detail: String,
    /// What it is.
    pub kind: SymbolKind,
    /// All of it.
    pub span: Span,
    /// Its name, inside `span`.
    pub selection: Span,
    /// What is in it.
    pub inside: Vec<Symbol>,
}

/// What can be folded.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Fold {
    /// From its first sign to its last.
    pub span: Span,
    /// Whether it is a comment.
    pub is_comment: bool,
}

impl Reading {
    /// The outline: models, and in them declarations and equations. At most [`DCML_EDITOR_PLACES`] entries.
    pub fn symbols(&self) -> Vec<Symbol> {
        let mut left = DCML_EDITOR_PLACES;
        let models = self.words.models.iter();
        models
            .map_while(|model| self.model_symbol(model, &mut left))
            .collect()
    }

    fn model_symbol(&self, model: &Extent, left: &mut usize) -> Option<Symbol> {
        *left = left.checked_sub(1)?;
        let tree = self.tree(model);
        let name = model.name.map(|name| self.slice(name)).unwrap_or_default();
        let begin = Span {
            start: model.span.start,
            end: (model.span.start + 5).min(model.span.end),
        };
        let mut inside = Vec::new();
        for section in tree.into_iter().flat_map(|tree| &tree.sections) {
            for one in &section.names {
                let Some(next) = left.checked_sub(1) else {
                    break;
                };
                *left = next;
                let unit = one
                    .unit
                    .as_ref()
                    .map(|unit| format!(" [{}]", shortened(&unit.text, DCML_EDITOR_NAME_BYTES)));
                inside.push(Symbol {
                    name: shortened(&one.name.text, DCML_EDITOR_NAME_BYTES),
                    detail: format!("{}{}", section.kind.keyword(), unit.unwrap_or_default()),
                    kind: SymbolKind::Name(section.kind),
                    span: one.name.span,
                    selection: one.name.span,
                    inside: Vec::new(),
                });
            }
        }
        for one in tree.into_iter().flat_map(|tree| &tree.equations) {
            let Some(next) = left.checked_sub(1) else {
                break;
            };
            *left = next;
            let name = shortened(&one.target.text, DCML_EDITOR_NAME_BYTES);
            inside.push(Symbol {
                name: if one.is_derivative {
                    format!("d({name})")
                } else {
                    name
                },
                detail: String::new(),
                kind: SymbolKind::Equation,
                span: one.span,
                selection: one.target.span,
                inside: Vec::new(),
            });
        }
        inside.retain(|one| is_within(one.selection, one.span) && is_within(one.span, model.span));
        inside.sort_by_key(|one| one.span.start);
        Some(Symbol {
            name: shortened(
                if name.is_empty() { "BEGIN" } else { name },
                DCML_EDITOR_NAME_BYTES,
            ),
            detail: tree
                .and_then(|tree| tree.package.as_ref())
                .map(|package| shortened(&package.text, DCML_EDITOR_NAME_BYTES))
                .unwrap_or_default(),
            kind: SymbolKind::Model,
            span: model.span,
            selection: model.name.unwrap_or(begin),
            inside,
        })
    }

    /// What can be folded: models, sections and comments. At most [`DCML_EDITOR_PLACES`].
    pub fn folds(&self) -> Vec<Fold> {
        let of_code = |span| Fold {
            span,
            is_comment: false,
        };
        let models = self.words.models.iter().map(|one| of_code(one.span));
        let sections = self.document().models.iter().flat_map(|one| &one.sections);
        let sections = sections.map(|one| of_code(one.span));
        let equations = self.document().models.iter().flat_map(|one| &one.equations);
        let equations = equations.map(|one| of_code(one.span));
        let mut all: Vec<Fold> = models
            .chain(sections)
            .chain(equations)
            .chain(self.comments())
            .collect();
        all.retain(|one| self.slice(one.span).contains('\n'));
        all.truncate(DCML_EDITOR_PLACES);
        all.sort_by_key(|one| one.span);
        all
    }

    /// Comments; those of one line that follow each other are one.
    fn comments(&self) -> impl Iterator<Item = Fold> {
        let is_comment = |one: &Word| matches!(one.role, Role::Comment(_));
        let groups = self.words.all.chunk_by(move |a, b| {
            let is_line = |one: &Word| is_comment(one) && self.slice(one.span).starts_with("//");
            is_line(a) && is_line(b)
        });
        groups
            .filter(move |group| group.first().is_some_and(is_comment))
            .filter_map(|group| {
                let span = Span {
                    start: group.first()?.span.start,
                    end: group.last()?.span.end,
                };
                Some(Fold {
                    span,
                    is_comment: true,
                })
            })
    }
}

fn is_within(inner: Span, outer: Span) -> bool {
    outer.start <= inner.start && inner.end <= outer.end
}
