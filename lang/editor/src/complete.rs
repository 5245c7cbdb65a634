//! What may be written at a place.
//!
//! Owns what is offered where, and in which order. Which of it begins with the letters that are there already is seen by the
//! editor.

use super::about::{shortened, suffixes};
use super::words::{Extent, Place, Role, Word};
use super::{Reading, facts};
use crate::limits::{DCML_EDITOR_OFFERS, DCML_EDITOR_SHOWN_BYTES};
use lang_dcml::function::Function;
use lang_dcml::lexer::{Keyword, TokenKind};
use lang_dcml::syntax::{Kind, Span};
use std::collections::HashSet;

/// What an offer is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Item {
    /// A declared name.
    Name(Kind),
    /// A number of the language.
    Number,
    /// A function.
    Function,
    /// A reserved word.
    Keyword,
    /// A unit.
    Unit,
    /// A text with places to fill in.
    Snippet,
}

/// Something that may be written.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Completion {
    /// What is shown, and what the letters are compared with.
    pub label: String,
    /// What it is.
    pub item: Item,
    /// A few words.
    pub detail: String,
    /// What is said of it.
    pub said: String,
    /// What is put in.
    pub insert: String,
    /// The same with places to fill in: `${1:x}` and `$0`, for editors that know them.
    pub snippet: Option<String>,
    /// What it replaces.
    pub span: Span,
}

impl Completion {
    fn new(label: &str, item: Item, detail: &str, said: &str) -> Self {
        Self {
            label: label.to_owned(),
            item,
            detail: detail.to_owned(),
            said: said.to_owned(),
            insert: label.to_owned(),
            snippet: None,
            span: Span::default(),
        }
    }

    fn with(self, insert: &str, snippet: &str) -> Self {
        Self {
            insert: insert.to_owned(),
            snippet: Some(snippet.to_owned()),
            ..self
        }
    }
}

impl Reading {
    /// What may be written at a place, the likeliest first, and whether that is all; nothing in comments.
    pub fn complete(&self, offset: u32) -> (Vec<Completion>, bool) {
        let word = self.word_before(offset);
        let Some(place) = self.words.place(&self.text, word.start) else {
            return (Vec::new(), true);
        };
        let model = self.words.model(word.start);
        let mut all = match place {
            Place::Outside => outside(),
            Place::Body => self.statements(model),
            Place::Equation => self.equation(model, word.start),
            Place::Unit(_) => units(),
            Place::Behind(_) => vec![Completion::new(
                "in",
                Item::Keyword,
                "extension",
                facts::DOMAIN,
            )],
            Place::Domain(_) => vec![Completion::new(
                "S1",
                Item::Keyword,
                "extension",
                facts::CIRCLE,
            )],
            Place::Begin | Place::Package | Place::Name(_) | Place::Value | Place::End => {
                Vec::new()
            }
        };
        let is_whole = all.len() <= DCML_EDITOR_OFFERS;
        if !is_whole {
            // Those that the letters fit first, so that nobody misses the word that they are writing.
            let begun = self.slice(word).to_ascii_lowercase();
            all.sort_by_key(|one| !one.label.to_ascii_lowercase().starts_with(&begun));
            all.truncate(DCML_EDITOR_OFFERS);
        }
        for one in &mut all {
            one.span = word;
        }
        (all, is_whole)
    }

    /// The part of a word that stands before a place; it is replaced to its end.
    fn word_before(&self, offset: u32) -> Span {
        let none = Span {
            start: offset,
            end: offset,
        };
        match self.words.at(offset) {
            Some(word) if word.span.start < offset => match word.role {
                Role::Sign(_) | Role::Number | Role::Comment(_) => none,
                _ => word.span,
            },
            _ => none,
        }
    }

    /// What a section or an equation begins with.
    fn statements(&self, model: Option<&Extent>) -> Vec<Completion> {
        let mut all = Vec::new();
        if let Some(model) = model {
            let equations = self
                .tree(model)
                .into_iter()
                .flat_map(|tree| &tree.equations);
            let given: HashSet<&str> = equations.map(|one| one.target.text.as_str()).collect();
            for one in self.declarations(model).take(DCML_EDITOR_OFFERS) {
                let name = one.said.name.text.as_str();
                let wants = matches!(one.kind, Kind::Config | Kind::Var);
                if !wants || given.contains(name) {
                    continue;
                }
                if one.kind == Kind::Config {
                    let label = format!("d({name})");
                    let offer =
                        Completion::new(&label, Item::Snippet, "derivative", facts::DERIVATIVE);
                    all.push(offer.with(&format!("{label} = "), &format!("{label} = $0;")));
                }
                let offer = Completion::new(name, Item::Name(one.kind), facts::kind(one.kind), "");
                all.push(offer.with(&format!("{name} = "), &format!("{name} = $0;")));
            }
        }
        for keyword in Keyword::ALL {
            let (insert, snippet) = match keyword {
                Keyword::Begin => continue,
                Keyword::End => ("END;", "END;\n$0".to_owned()),
                Keyword::Section(Kind::Const) => {
                    ("CONST: ", "CONST: ${1:name} = ${2:1};".to_owned())
                }
                other => ("", format!("{}: $0;", other.text())),
            };
            let text = keyword.text();
            let plain = format!("{text}: ");
            let insert = if insert.is_empty() { &plain } else { insert };
            let offer = Completion::new(text, Item::Keyword, "", facts::keyword(keyword));
            all.push(offer.with(insert, &snippet));
        }
        all
    }

    /// What an expression is made of, or what `d(` wants.
    fn equation(&self, model: Option<&Extent>, offset: u32) -> Vec<Completion> {
        let before = self.words.before(offset);
        let role = |back: usize| {
            let at = before.checked_sub(back)?;
            self.words.all.get(at).map(|one: &Word| one.role)
        };
        let is_derivative =
            role(1) == Some(Role::Sign(TokenKind::Open)) && role(2) == Some(Role::Derivative);
        let mut all = self.names(model, is_derivative);
        if is_derivative {
            return all;
        }
        let is_free = |name: &str| model.is_none_or(|model| self.declared(model, name).is_none());
        for (name, value, said) in facts::NUMBERS {
            if is_free(name) {
                all.push(Completion::new(
                    name,
                    Item::Number,
                    &format!("= {value}"),
                    said,
                ));
            }
        }
        for function in Function::ALL {
            let name = function.name();
            let places: Vec<String> = facts::parameters(function)
                .iter()
                .enumerate()
                .map(|(at, one)| format!("${{{}:{one}}}", at + 1))
                .collect();
            let offer = Completion::new(
                name,
                Item::Function,
                &facts::signature(function),
                facts::function(function),
            );
            all.push(offer.with(name, &format!("{name}({})$0", places.join(", "))));
        }
        let piecewise = Completion::new(
            "piecewise",
            Item::Snippet,
            facts::PIECEWISE,
            facts::PIECEWISE_MEANS,
        );
        let places = "piecewise(${1:x} < ${2:0}, ${3:value}, ${4:otherwise})$0";
        all.push(piecewise.with("piecewise", places));
        all
    }

    fn names(&self, model: Option<&Extent>, only_config: bool) -> Vec<Completion> {
        let Some(model) = model else {
            return Vec::new();
        };
        let declared = self.declarations(model);
        let wanted = declared.filter(|one| !only_config || one.kind == Kind::Config);
        // One more than is shown, so that it is known that there are more.
        let shown = wanted.take(DCML_EDITOR_OFFERS + 1);
        shown
            .map(|one| {
                let said = one
                    .said
                    .doc
                    .as_ref()
                    .map(|doc| shortened(&doc.text, DCML_EDITOR_SHOWN_BYTES));
                let detail = format!("{}{}", facts::kind(one.kind), suffixes(one.said));
                let name = &one.said.name.text;
                Completion::new(
                    name,
                    Item::Name(one.kind),
                    &detail,
                    &said.unwrap_or_default(),
                )
            })
            .collect()
    }
}

fn outside() -> Vec<Completion> {
    let begin = Completion::new("BEGIN", Item::Keyword, "", facts::keyword(Keyword::Begin));
    let begin = begin.with("BEGIN ", "BEGIN ${1:Name}\n$0\nEND;");
    let models = facts::MODELS.into_iter().map(|(label, said, text)| {
        let offer = Completion::new(label, Item::Snippet, said, "");
        offer.with(&filled(text), text)
    });
    models.chain([begin]).collect()
}

/// A text whose places have what they begin with.
fn filled(snippet: &str) -> String {
    let mut parts = snippet.split("${");
    let mut all = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (place, rest) = part.split_once('}').unwrap_or((part, ""));
        all.push_str(place.split_once(':').map_or("", |(_, text)| text));
        all.push_str(rest);
    }
    all.replace("$0", "")
}

fn units() -> Vec<Completion> {
    let all = facts::UNITS.into_iter();
    all.map(|unit| Completion::new(unit, Item::Unit, "unit", ""))
        .collect()
}
