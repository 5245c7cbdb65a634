//! The blocks that a person can draw with, from the table of blocks.
//!
//! Owns how a row of it is told to a page; names and defaults are those of the table.

use crate::failure::Failure;
use crate::flow;
use crate::options::Options;
use crate::project::Answer;
use lang_dataflow::read::Language;
use lang_diagram::blocks::choices::called;
use lang_diagram::blocks::{Category, Content, Kits, Property, Row, Silent, Type, table};
use lang_text::problem::Locale;
use serde_json::{Value, json};

/// All blocks of a language, by category and in the order of the editor's palette. Options: `locale`, and `language`, which
/// is `diagram` or `dataflow`.
pub fn palette(options: &str) -> Answer<Value> {
    let mut locale = Locale::default();
    let told = Options::read(options).and_then(|mut options| {
        locale = options.locale()?;
        let language = options.language()?;
        options.end()?;
        Ok::<_, Failure>(match language {
            Language::Diagram => table().map(|one| row(one, locale)).collect(),
            Language::Dataflow => flow::palette(locale),
        })
    });
    (told, locale)
}

fn row(row: &Row, locale: Locale) -> Value {
    let kits: &[&str] = match row.kits {
        Kits::Both => &["trikV62Kit", "trikV6Kit"],
        Kits::V6 => &["trikV6Kit"],
        Kits::V62 => &["trikV62Kit"],
    };
    json!({
        "kind": row.kind,
        "title": row.shown_in(locale),
        "category": match row.category {
            Category::Algorithms => "algorithms",
            Category::Actions => "actions",
            Category::Wait => "wait",
            Category::Drawing => "drawing",
        },
        "kits": kits,
        // It stands in old saves, and nobody draws it again.
        "isOld": row.silent == Silent::Always,
        "text": row.text_in(locale),
        "icon": row.icon,
        "properties": row.properties.iter().map(|one| property(one, locale)).collect::<Vec<_>>(),
    })
}

fn property(property: &Property, locale: Locale) -> Value {
    let (takes, choices): (&str, Option<&[&str]>) = match property.content {
        Content::Expression(Type::Statements) => ("statements", None),
        Content::Expression(
            Type::Truth | Type::Whole | Type::Number | Type::Text | Type::Printed | Type::List,
        )
        | Content::Evaluated => ("expression", None),
        Content::Raw => ("text", None),
        Content::Variable => ("variable", None),
        Content::Ports => ("ports", None),
        Content::Number => ("number", None),
        Content::Flag => ("choice", Some(&["true", "false"])),
        Content::Choice(choices) | Content::Port(choices) => ("choice", Some(choices)),
    };
    json!({
        "name": property.name,
        "title": property.shown_in(locale),
        "found": property.shown,
        "default": property.default,
        "takes": takes,
        "choices": choices,
        "choiceTitles": choices.map(|all| all.iter().map(|one| called(one, locale)).collect::<Vec<_>>()),
    })
}
