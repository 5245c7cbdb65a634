//! Edits that mend what a diagnostic tells.
//!
//! Owns which findings have such edits. What is meant is guessed as the finding's hint guesses it.

use super::words::Role;
use super::{Edit, Reading, facts};
use crate::limits::DCML_EDITOR_FIXES;
use lang_dcml::diagnostic::{Code, Diagnostic};
use lang_dcml::function::Function;
use lang_dcml::lexer::{Keyword, TokenKind};
use lang_dcml::nearest::nearest;
use lang_dcml::syntax::{Kind, Span};

/// A change that mends one finding.
#[derive(Clone, Debug, PartialEq)]
pub struct Fix {
    /// What it does, for a menu.
    pub title: String,
    /// What it mends: its place in the diagnostics.
    pub of: usize,
    /// How.
    pub edits: Vec<Edit>,
    /// Whether it is most probably what the author means.
    pub is_preferred: bool,
}

impl Reading {
    /// What can be done about the findings that touch a stretch; for the first [`DCML_EDITOR_FIXES`] of them.
    pub fn fixes(&self, stretch: Span) -> Vec<Fix> {
        let all = self.diagnostics().iter().enumerate();
        let touch =
            all.filter(|(_, one)| one.span.start <= stretch.end && stretch.start <= one.span.end);
        let few = touch.take(DCML_EDITOR_FIXES);
        few.flat_map(|(of, one)| self.fixes_of(of, one)).collect()
    }

    fn fixes_of(&self, of: usize, diagnostic: &Diagnostic) -> Vec<Fix> {
        let mut all = Vec::new();
        let word = self.slice(diagnostic.span);
        if let Some(meant) = self.meant_instead(diagnostic.code, word, diagnostic.span) {
            all.push(Fix {
                title: format!("Change to `{meant}`"),
                of,
                edits: vec![Edit {
                    span: diagnostic.span,
                    text: meant,
                }],
                is_preferred: true,
            });
        }
        if diagnostic.code == Code::UndeclaredName {
            for kind in [Kind::Param, Kind::Action] {
                all.extend(self.declare(diagnostic.span, kind).map(|edit| Fix {
                    title: format!(
                        "Declare `{word}` as {} {}",
                        article(kind),
                        facts::kind(kind)
                    ),
                    of,
                    edits: vec![edit],
                    is_preferred: false,
                }));
            }
        }
        all
    }

    /// The known word that a wrong one was probably meant to be.
    fn meant_instead(&self, code: Code, word: &str, span: Span) -> Option<String> {
        let found = match code {
            Code::UndeclaredName => {
                let model = self.words.model(span.start)?;
                let declared = self
                    .declarations(model)
                    .map(|one| one.said.name.text.as_str());
                let numbers = facts::NUMBERS.iter().map(|(name, ..)| *name);
                nearest(word, declared.chain(numbers))
            }
            Code::UnknownFunction => nearest(
                word,
                Function::ALL
                    .map(Function::name)
                    .into_iter()
                    .chain(["piecewise"]),
            ),
            Code::UnknownSection => nearest(word, Keyword::ALL.map(Keyword::text)),
            _ => None,
        };
        found.filter(|found| *found != word).map(str::to_owned)
    }

    /// The edit that declares the name at a place.
    fn declare(&self, name: Span, kind: Kind) -> Option<Edit> {
        let model = self.words.model(name.start)?;
        let word = self.words.at(name.start).filter(|one| one.span == name)?;
        if word.role != Role::Use {
            return None;
        }
        let text = self.slice(name);
        let sections = self.tree(model).into_iter().flat_map(|tree| &tree.sections);
        let mut of_kind = sections.filter(|one| one.kind == kind && !one.names.is_empty());
        if let Some(section) = of_kind.next()
            && let Some(end) = self.semicolon(section.span)
        {
            return Some(Edit {
                span: Span { start: end, end },
                text: format!(", {text}"),
            });
        }
        let behind = self.behind_heading(model)?;
        Some(Edit {
            span: Span {
                start: behind,
                end: behind,
            },
            text: format!("\n{}: {text};", kind.keyword()),
        })
    }

    /// Where the semicolon of a section stands.
    fn semicolon(&self, section: Span) -> Option<u32> {
        let last = self.words.before(section.end).checked_sub(1)?;
        let word = self.words.all.get(last)?;
        (word.role == Role::Sign(TokenKind::Semicolon) && word.span.start >= section.start)
            .then_some(word.span.start)
    }

    /// The end of the name of a model, or of its package.
    fn behind_heading(&self, model: &super::words::Extent) -> Option<u32> {
        let words = self.words.of_model(model);
        let package = words
            .iter()
            .position(|one| one.role == Role::Keyword(Keyword::Package));
        let end = package.and_then(|at| {
            let mut rest = words[at..].iter();
            rest.find(|one| one.role == Role::Sign(TokenKind::Semicolon))
        });
        end.map(|one| one.span.end)
            .or(model.name.map(|name| name.end))
    }
}

const fn article(kind: Kind) -> &'static str {
    match kind {
        Kind::Action => "an",
        _ => "a",
    }
}
