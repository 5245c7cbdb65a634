//! Coloured words as numbers, each from the one before.
//!
//! Owns that form and the names of colours.

use super::super::document::{Document, Encoding};
use lang_dcml::syntax::Span;
use lang_editor::limits::DCML_EDITOR_PLACES;
use lang_editor::{Colour, Painted};
use serde_json::{Value, json};

/// The names of the numbers.
pub fn legend() -> Value {
    json!({
        "tokenTypes": Colour::ALL.map(name),
        "tokenModifiers": ["declaration", "readonly", "defaultLibrary", "documentation"],
    })
}

fn name(colour: Colour) -> &'static str {
    match colour {
        Colour::Keyword => "keyword",
        Colour::Model => "class",
        Colour::Package => "namespace",
        Colour::Parameter => "parameter",
        Colour::Property => "property",
        Colour::Variable => "variable",
        Colour::Function => "function",
        Colour::Type => "type",
        Colour::Number => "number",
        Colour::Comment => "comment",
    }
}

/// The words of a stretch.
pub fn tokens(document: &Document, stretch: Span, encoding: Encoding) -> Value {
    let mut walk = Walk::new(document.reading().text(), encoding);
    let mut data: Vec<Value> = Vec::new();
    let (mut line, mut unit) = (0, 0);
    for one in document.reading().colours(stretch) {
        // Only comments have several lines; others are one part of one.
        let parts = document
            .by_lines(one.span)
            .take(DCML_EDITOR_PLACES - data.len() / 5);
        let whole = std::iter::once(one.span);
        let parts: &mut dyn Iterator<Item = Span> = if one.colour == Colour::Comment {
            &mut { parts }
        } else {
            &mut { whole }
        };
        for part in parts {
            walk.to(part.start);
            let at = (walk.line, walk.unit);
            walk.to(part.end);
            let length = walk.unit - at.1;
            let ahead = if at.0 == line { at.1 - unit } else { at.1 };
            let numbers = [
                at.0 - line,
                ahead,
                length,
                number(one.colour),
                modifiers(&one),
            ];
            data.extend(numbers.map(Value::from));
            (line, unit) = at;
        }
        if data.len() >= 5 * DCML_EDITOR_PLACES {
            break;
        }
    }
    json!({ "data": data })
}

fn number(colour: Colour) -> usize {
    let mut all = Colour::ALL.into_iter();
    all.position(|one| one == colour).unwrap_or_default()
}

fn modifiers(one: &Painted) -> usize {
    let flags = [
        one.is_declaration,
        one.is_fixed,
        one.is_of_language,
        one.is_doc,
    ];
    let bits = flags.into_iter().enumerate();
    bits.map(|(at, flag)| usize::from(flag) << at).sum()
}

/// A place that goes forward through a text.
struct Walk<'a> {
    text: &'a str,
    encoding: Encoding,
    at: usize,
    line: usize,
    unit: usize,
}

impl<'a> Walk<'a> {
    fn new(text: &'a str, encoding: Encoding) -> Self {
        Self {
            text,
            encoding,
            at: 0,
            line: 0,
            unit: 0,
        }
    }

    fn to(&mut self, offset: u32) {
        let end = usize::try_from(offset).unwrap_or(usize::MAX);
        let Some(between) = self.text.get(self.at..end) else {
            return;
        };
        let bytes = self.text.as_bytes();
        for (at, sign) in between.char_indices() {
            let next = bytes.get(self.at + at + 1);
            if sign == '\n' || (sign == '\r' && next != Some(&b'\n')) {
                (self.line, self.unit) = (self.line + 1, 0);
                continue;
            }
            self.unit += match self.encoding {
                Encoding::Utf8 => sign.len_utf8(),
                Encoding::Utf16 => sign.len_utf16(),
                Encoding::Utf32 => 1,
            };
        }
        self.at = end;
    }
}
