//! A project for the eye: diagrams as pictures with icons of our own, and programs as plain sentences.
//!
//! Owns what is shown of a block: its name and the few properties that say what it does. Pictures are in `show/picture`,
//! sentences in `show/outline`. Knows no files and no terminal.

mod labels;
pub mod outline;
pub mod picture;
pub mod words;

#[cfg(test)]
mod tests;

use super::blocks::{self, Content, Row};
use super::project::Block;
use crate::limits;
use lang_text::problem::Locale;

/// The name of a block, as the editor has it.
pub fn name(block: &Block, locale: Locale) -> String {
    match blocks::find(&block.kind) {
        Some(row) => row.shown_in(locale).to_owned(),
        None => block.kind.clone(),
    }
}

/// The text of a property, or what a new block has.
fn property<'a>(block: &'a Block, row: &Row, name: &str) -> &'a str {
    let default = || row.property(name).map_or("", |property| property.default);
    block
        .properties
        .get(name)
        .map_or_else(default, String::as_str)
}

/// What a block does, in a few words: texts of its properties, the flags left out.
pub fn details(block: &Block) -> String {
    let Some(row) = blocks::find(&block.kind) else {
        return String::new();
    };
    let mut all = Vec::new();
    for one in row.properties {
        if matches!(one.content, Content::Flag) {
            continue;
        }
        let text = property(block, row, one.name);
        let text = match one.name {
            "Sign" => sign(text),
            _ => text,
        };
        if !text.is_empty() {
            all.push(shortened(text));
        }
    }
    if all.is_empty() {
        let arguments = block.arguments.iter();
        all.extend(
            arguments.map(|argument| format!("{} = {}", argument.name, shortened(&argument.value))),
        );
    }
    all.join(", ")
}

fn sign(word: &str) -> &str {
    match word {
        "greater" => ">",
        "less" => "<",
        "notLess" => ">=",
        "notGreater" => "<=",
        "equals" => "=",
        other => other,
    }
}

/// One line, not too long.
fn shortened(text: &str) -> String {
    let mut out = String::new();
    for letter in text.trim().chars() {
        if out.chars().count() >= limits::PICTURE_PROPERTY_MAX {
            out.push_str("...");
            break;
        }
        match letter {
            '\n' => out.push_str("; "),
            letter if letter.is_control() || ('\u{202a}'..='\u{202e}').contains(&letter) => {
                out.push(' ')
            }
            letter => out.push(letter),
        }
    }
    out
}
