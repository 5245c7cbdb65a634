//! A text with models, as a page asks about it.
//!
//! Owns the forms of all answers; `types.d.ts` declares them. Made anew for each change.

use crate::failure::Failure;
use crate::units::Units;
use lang_dcml::diagnostic::{Diagnostic, Severity};
use lang_dcml::generate::{Options, Target, generate};
use lang_dcml::limits::DCML_TEXT_MAX;
use lang_dcml::lines::Lines;
use lang_dcml::model::Model;
use lang_dcml::syntax::{Kind, Span};
use lang_dcml::{models, understand, understand_paper};
use lang_editor::{Colour, Edit, Item, Reading, Symbol, SymbolKind};
use serde_json::{Value, json};

/// A text that was read.
#[derive(Debug)]
pub struct Text {
    reading: Reading,
    units: Units,
}

/// The names of the kinds of declared names.
fn kind(kind: Kind) -> &'static str {
    match kind {
        Kind::Action => "action",
        Kind::Param => "parameter",
        Kind::Const => "constant",
        Kind::Config => "configuration",
        Kind::Var => "variable",
    }
}

impl Text {
    /// Reads one.
    ///
    /// # Errors
    /// It is longer than any document may be.
    pub fn read(text: String) -> Result<Self, Failure> {
        if text.len() > DCML_TEXT_MAX {
            let mib = DCML_TEXT_MAX >> 20;
            let why = format!("the text is longer than {mib} MiB, put its models into several");
            return Err(Failure::Request(why));
        }
        let units = Units::of(&text);
        Ok(Self {
            reading: Reading::of(text),
            units,
        })
    }

    /// What is wrong with it, as `trik dcml lint` tells; with `is_paper` what the published language does not have is wrong too.
    pub fn diagnostics(&self, is_paper: bool) -> Value {
        let own;
        let found = match is_paper {
            true => {
                own = understand_paper(self.reading.text()).diagnostics;
                &own[..]
            }
            false => self.reading.diagnostics(),
        };
        let lines = Lines::of(self.reading.text());
        let all = found.iter().map(|one| self.diagnostic(one, &lines));
        all.collect()
    }

    fn diagnostic(&self, one: &Diagnostic, lines: &Lines<'_>) -> Value {
        let place = lines.place(one.span.start);
        let notes = one.notes.iter();
        let notes = notes.map(|(span, text)| json!({"at": self.units.place(*span), "text": text}));
        json!({
            "code": one.code.name(),
            "severity": match one.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
            },
            "at": self.units.place(one.span),
            "line": place.line,
            "column": place.column,
            "message": one.message,
            "label": one.label,
            "hint": one.hint,
            "notes": notes.collect::<Vec<_>>(),
        })
    }

    /// The models without mistakes, with what is declared in them.
    pub fn models(&self) -> Value {
        let models = understand(self.reading.text()).models;
        let model = |one: &Model| {
            let names = one.symbols.iter().map(|symbol| {
                json!({"name": symbol.name, "kind": kind(symbol.kind), "unit": symbol.unit})
            });
            json!({"name": one.name, "package": one.package, "names": names.collect::<Vec<_>>()})
        };
        models.iter().map(model).collect()
    }

    /// The model of this name, or the only one.
    ///
    /// # Errors
    /// [`Failure::Several`], [`Failure::NoModel`], [`Failure::Mistakes`].
    pub fn model(&self, wanted: Option<&str>) -> Result<Model, Failure> {
        let understood = understand(self.reading.text());
        let written = understood.document.models.iter();
        let names: Vec<String> = written.map(|one| one.name.text.clone()).collect();
        let name = match (wanted, &names[..]) {
            (Some(name), _) => name,
            (None, [name]) => name,
            (None, []) => return Err(Failure::NoModel(String::new(), names)),
            (None, _) => return Err(Failure::Several(names)),
        };
        let found = understood.models.into_iter().find(|one| one.name == name);
        found.ok_or_else(|| match names.iter().any(|one| one == name) {
            true => Failure::Mistakes,
            false => Failure::NoModel(name.to_owned(), names.clone()),
        })
    }

    /// A model in another language.
    ///
    /// # Errors
    /// Those of [`Text::model`], [`Failure::Language`], [`Failure::Refused`].
    pub fn generate(
        &self,
        language: &str,
        wanted: Option<&str>,
        jacobian: bool,
    ) -> Result<String, Failure> {
        let target = Target::named(language);
        let target =
            target.ok_or_else(|| Failure::Language(language.chars().take(40).collect()))?;
        let model = self.model(wanted)?;
        generate(&model, target, &Options { jacobian })
            .map_err(|why| Failure::Refused(why.to_string()))
    }

    /// The edit that makes it as the formatter wants it, or none.
    ///
    /// # Errors
    /// [`Failure::Refused`]: what cannot be read has no layout.
    pub fn format(&self) -> Result<Value, Failure> {
        let edit = self.reading.formatted();
        let edit = edit.map_err(|why| Failure::Refused(why.to_string()))?;
        Ok(edit.map_or(Value::Null, |edit| self.edit(&edit)))
    }

    /// What the word at a place is; null if it is none.
    pub fn hover(&self, at: u32) -> Value {
        let hover = self.reading.hover(self.units.byte(at));
        hover.map_or(Value::Null, |hover| {
            json!({
                "at": self.units.place(hover.span),
                "code": hover.code,
                "what": hover.what,
                "said": hover.said,
                "more": hover.more,
            })
        })
    }

    /// What may stand at a place, the likeliest first.
    pub fn complete(&self, at: u32) -> Value {
        let (offers, is_all) = self.reading.complete(self.units.byte(at));
        let offers = offers.into_iter().map(|one| {
            json!({
                "label": one.label,
                "is": match one.item {
                    Item::Name(of) => kind(of),
                    Item::Number => "number",
                    Item::Function => "function",
                    Item::Keyword => "keyword",
                    Item::Unit => "unit",
                    Item::Snippet => "snippet",
                },
                "detail": one.detail,
                "said": one.said,
                "insert": one.insert,
                "snippet": one.snippet,
                "at": self.units.place(one.span),
            })
        });
        json!({"offers": offers.collect::<Vec<_>>(), "isAll": is_all})
    }

    /// Where the name at a place is declared; null if it is no name, or nowhere.
    pub fn definition(&self, at: u32) -> Value {
        let found = self.reading.definition(self.units.byte(at));
        found.map_or(Value::Null, |span| self.units.place(span))
    }

    /// All places of the name at a place.
    pub fn references(&self, at: u32) -> Value {
        let found = self.reading.references(self.units.byte(at)).into_iter();
        let one = |(span, declares)| json!({"at": self.units.place(span), "declares": declares});
        found.map(one).collect()
    }

    /// The edits that give the name at a place another one.
    ///
    /// # Errors
    /// [`Failure::Refused`].
    pub fn rename(&self, at: u32, new: &str) -> Result<Value, Failure> {
        let edits = self.reading.rename(self.units.byte(at), new);
        let edits = edits.map_err(|why| Failure::Refused(why.to_string()))?;
        Ok(edits.iter().map(|edit| self.edit(edit)).collect())
    }

    /// The function in whose parentheses a place is; null if there is none.
    pub fn signature(&self, at: u32) -> Value {
        let found = self.reading.signature(self.units.byte(at));
        found.map_or(Value::Null, |one| {
            let places = Units::of(&one.code);
            let arguments = one.arguments.iter().map(|span| places.place(*span));
            json!({
                "code": one.code,
                "said": one.said,
                "arguments": arguments.collect::<Vec<_>>(),
                "active": one.active,
            })
        })
    }

    /// The outline.
    pub fn symbols(&self) -> Value {
        let symbols = self.reading.symbols();
        symbols.iter().map(|one| self.symbol(one)).collect()
    }

    fn symbol(&self, one: &Symbol) -> Value {
        json!({
            "name": one.name,
            "detail": one.detail,
            "is": match one.kind {
                SymbolKind::Model => "model",
                SymbolKind::Name(of) => kind(of),
                SymbolKind::Equation => "equation",
            },
            "at": self.units.place(one.span),
            "name_at": self.units.place(one.selection),
            "inside": one.inside.iter().map(|one| self.symbol(one)).collect::<Vec<_>>(),
        })
    }

    /// What can be done about what is wrong between two places.
    pub fn fixes(&self, from: u32, to: u32) -> Value {
        let fixes = self.reading.fixes(self.span(from, to)).into_iter();
        let one = |fix: lang_editor::Fix| {
            json!({
                "title": fix.title,
                "of": fix.of,
                "edits": fix.edits.iter().map(|edit| self.edit(edit)).collect::<Vec<_>>(),
                "isPreferred": fix.is_preferred,
            })
        };
        fixes.map(one).collect()
    }

    /// The words between two places with what they are.
    pub fn colours(&self, from: u32, to: u32) -> Value {
        let words = self.reading.colours(self.span(from, to)).into_iter();
        let one = |word: lang_editor::Painted| {
            let is = match word.colour {
                Colour::Keyword => "keyword",
                Colour::Model => "model",
                Colour::Package => "package",
                Colour::Parameter => "parameter",
                Colour::Property => "configuration",
                Colour::Variable => "variable",
                Colour::Function => "function",
                Colour::Type => "unit",
                Colour::Number => "number",
                Colour::Comment => "comment",
            };
            json!({"at": self.units.place(word.span), "is": is, "declares": word.is_declaration})
        };
        words.map(one).collect()
    }

    fn span(&self, from: u32, to: u32) -> Span {
        let (start, end) = (self.units.byte(from), self.units.byte(to.max(from)));
        Span { start, end }
    }

    fn edit(&self, edit: &Edit) -> Value {
        json!({"at": self.units.place(edit.span), "text": edit.text})
    }
}

/// The models that come with this project: their names and texts.
pub fn shipped() -> Value {
    let all = models::ALL.iter();
    all.map(|one| json!({"name": one.name, "text": one.text}))
        .collect()
}
