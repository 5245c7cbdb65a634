//! What is shown of the word under the pointer.
//!
//! Owns what is said and in which order; marks of a text format are put in by the code that shows it.

use super::names::Meant;
use super::words::Role;
use super::{Reading, facts};
use crate::limits::DCML_EDITOR_SHOWN_BYTES;
use lang_dcml::syntax::{Declaration, Domain, Kind, Span};

/// What is shown of a word.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Hover {
    /// The word.
    pub span: Span,
    /// A line of the language: how the word is declared or called.
    pub code: String,
    /// What it is, in a few words; may be empty.
    pub what: String,
    /// What the author or the language says of it, with lines; may be empty.
    pub said: String,
    /// More of the language: its equations.
    pub more: String,
}

impl Reading {
    /// What is shown of the word at a place.
    pub fn hover(&self, offset: u32) -> Option<Hover> {
        let meant = self.meant(offset)?;
        let of_language = |code: String, said: &str| Hover {
            code,
            said: said.to_owned(),
            ..Hover::default()
        };
        let text = meant.text.to_owned();
        let shown = match meant.word.role {
            Role::Keyword(keyword) => of_language(text, facts::keyword(keyword)),
            Role::Function(function) => {
                of_language(facts::signature(function), facts::function(function))
            }
            Role::Piecewise => of_language(facts::PIECEWISE.to_owned(), facts::PIECEWISE_MEANS),
            Role::Derivative => of_language("d(x)".to_owned(), facts::DERIVATIVE),
            Role::In => of_language(text, facts::DOMAIN),
            Role::Circle => of_language(text, facts::CIRCLE),
            Role::Unit => of_language(text, facts::UNIT),
            Role::ModelName => self.about_model(meant)?,
            Role::Declared(_) | Role::Use => self.about_name(meant)?,
            Role::Package | Role::Unknown | Role::Number | Role::Comment(_) | Role::Sign(_) => {
                return None;
            }
        };
        Some(Hover {
            span: meant.word.span,
            ..shown
        })
    }

    fn about_model(&self, meant: Meant<'_>) -> Option<Hover> {
        let tree = self.tree(meant.model?);
        let count = |kind: Kind| {
            let sections = tree.into_iter().flat_map(|tree| &tree.sections);
            let of_kind = sections.filter(|one| one.kind == kind);
            of_kind.map(|one| one.names.len()).sum::<usize>()
        };
        let package = tree.and_then(|tree| tree.package.as_ref());
        let package = package.map(|one| format!("package {}, ", one.text));
        Some(Hover {
            code: format!("BEGIN {}", meant.text),
            what: format!(
                "{}{}, {}, {}",
                package.unwrap_or_default(),
                several(count(Kind::Action), "action"),
                several(count(Kind::Param), "parameter"),
                several(count(Kind::Config), "part of the configuration"),
            ),
            said: tree
                .and_then(|tree| tree.doc.as_ref())
                .map(|doc| shortened(&doc.text, DCML_EDITOR_SHOWN_BYTES))
                .unwrap_or_default(),
            ..Hover::default()
        })
    }

    fn about_name(&self, meant: Meant<'_>) -> Option<Hover> {
        let model = meant.model?;
        let Some(declared) = self.declared(model, meant.text) else {
            let number = facts::NUMBERS
                .into_iter()
                .find(|(name, ..)| *name == meant.text);
            return number.map(|(name, value, said)| Hover {
                code: format!("{name} = {value}"),
                said: said.to_owned(),
                ..Hover::default()
            });
        };
        let mut equations = self.equations(model, meant.text);
        let first = equations.next();
        let what = match (declared.kind, first.map(|one| one.is_derivative)) {
            (Kind::Config, Some(true)) => "state: a part of the configuration with a derivative",
            (Kind::Config, Some(false)) => {
                "output: a part of the configuration that is computed from the rest"
            }
            (kind, _) => facts::kind(kind),
        };
        Some(Hover {
            code: format!(
                "{} {}{}",
                declared.kind.keyword(),
                shortened(meant.text, DCML_EDITOR_SHOWN_BYTES),
                suffixes(declared.said)
            ),
            what: what.to_owned(),
            said: declared
                .said
                .doc
                .as_ref()
                .map(|doc| shortened(&doc.text, DCML_EDITOR_SHOWN_BYTES))
                .unwrap_or_default(),
            more: first
                .map(|one| shortened(self.slice(one.span), DCML_EDITOR_SHOWN_BYTES))
                .unwrap_or_default(),
            ..Hover::default()
        })
    }
}

/// Unit, domain and value of a declaration.
pub(super) fn suffixes(said: &Declaration) -> String {
    let unit = said
        .unit
        .as_ref()
        .map(|unit| format!(" [{}]", shortened(&unit.text, DCML_EDITOR_SHOWN_BYTES)));
    let domain = said.domain.map(|(domain, _)| match domain {
        Domain::Circle => " in S1".to_owned(),
        Domain::Range(from, to) => format!(" in {from} .. {to}"),
    });
    let value = said.value.map(|(value, _)| format!(" = {value}"));
    [unit, domain, value].into_iter().flatten().collect()
}

fn several(count: usize, what: &str) -> String {
    match count {
        1 => format!("1 {what}"),
        _ if what == "part of the configuration" => format!("{count} parts of the configuration"),
        _ => format!("{count} {what}s"),
    }
}

/// A text as far as anybody reads it.
pub(super) fn shortened(text: &str, most: usize) -> String {
    if text.len() <= most {
        return text.to_owned();
    }
    let mut end = most;
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    format!("{} ...", &text[..end])
}
