//! A data-flow project for the eye: its program in sentences, and its diagrams as pictures.
//!
//! Owns what blocks and ends of edges are called, and which properties are worth saying. Knows no files and no terminal.

mod picture;
mod sentences;
mod ways;
mod words;

#[cfg(test)]
mod tests;

pub use picture::picture;
pub use sentences::{Extent, Line, lines, sentences};
pub use ways::Looks;
pub use words::{too_many, too_many_edges};

use crate::blocks::{Content, PORT_OF_CALL, Property};
use crate::project::{Block, Diagram};
use lang_text::problem::Locale;
use std::collections::HashMap;
use words::Word;

/// The kind of a block, as the editor has it.
fn kind(block: &Block, locale: Locale) -> String {
    match block.row {
        Some(row) => row.shown_in(locale).to_owned(),
        None => format!(
            "{} {}",
            Word::Unknown.text(locale),
            shortened(&block.element, 60)
        ),
    }
}

/// What each block of a diagram is called: by its caption, or by its kind if it has none, with a number if others are
/// called the same.
pub fn callings(diagram: &Diagram, locale: Locale) -> Vec<String> {
    let name = |block: &Block| match block.name.trim() {
        "" => kind(block, locale),
        caption => shortened(caption, 60),
    };
    let names: Vec<String> = diagram.blocks.iter().map(name).collect();
    let mut counts: HashMap<&str, (usize, usize)> = HashMap::new();
    for name in &names {
        counts.entry(name).or_default().1 += 1;
    }
    let mut all = Vec::with_capacity(names.len());
    for name in &names {
        let number = counts.get_mut(name.as_str()).and_then(|(passed, count)| {
            *passed += 1;
            (*count > 1).then_some(*passed)
        });
        all.push(match number {
            Some(number) => format!("{name} ({number})"),
            None => name.clone(),
        });
    }
    all
}

/// The name or the number of a port.
fn port(block: &Block, port: i32) -> String {
    let at = usize::try_from(port).ok();
    let known = at.and_then(|at| block.row?.ports.get(at));
    known.map_or_else(|| port.to_string(), |port| port.name.to_owned())
}

/// The name that the editor shows, without the sign that it shows between a name and its value.
fn shown(property: &Property) -> &'static str {
    property.shown.trim_end_matches(['=', ':'])
}

/// What a block does, in a few words: texts of properties that are not those of a new block, with their names where there
/// are several of a kind.
pub fn details(block: &Block) -> String {
    let said = changed(block).into_iter().map(|one| {
        let text = shortened(one.text, crate::limits::PICTURE_PROPERTY_MAX);
        match one.is_flag || block.row.is_some_and(|row| row.properties.len() > 2) {
            true => format!("{} = {text}", one.name),
            false => text,
        }
    });
    said.collect::<Vec<_>>().join(", ")
}

/// The kind of a block and its caption, if that says more.
pub fn name(block: &Block, locale: Locale) -> String {
    let kind = kind(block, locale);
    let caption = block.name.trim();
    let is_kind = |row: &crate::blocks::Row| [row.shown, row.russian].contains(&caption);
    match caption.is_empty() || caption == block.element || block.row.is_some_and(is_kind) {
        true => kind,
        false => format!("{kind} '{}'", shortened(caption, 60)),
    }
}

/// A property that is said.
struct Changed<'a> {
    /// The name that the editor shows.
    name: &'a str,
    text: &'a str,
    is_flag: bool,
}

/// Properties that are not those of a new block, then those that the row does not know.
fn changed(block: &Block) -> Vec<Changed<'_>> {
    said(block, false)
}

/// The same, or all properties that are not empty.
fn said(block: &Block, with_defaults: bool) -> Vec<Changed<'_>> {
    let known = block.row.map_or(&[][..], |row| row.properties);
    let mut all = Vec::new();
    for property in known {
        let text = block.text(property.name);
        // Which sensor or port it is says what the block does, also where it is the usual one.
        let is_part_of_it = matches!(property.content, Content::Sensor | Content::Port)
            || property.name == PORT_OF_CALL;
        if text != property.default || (with_defaults || is_part_of_it) && !text.is_empty() {
            all.push(Changed {
                name: shown(property),
                text,
                is_flag: property.content == Content::Flag,
            });
        }
    }
    for (name, text) in &block.properties {
        if known.iter().all(|property| property.name != name) {
            all.push(Changed {
                name,
                text,
                is_flag: false,
            });
        }
    }
    all
}

/// One line, not too long, without signs that change how others are seen.
fn shortened(text: &str, most: usize) -> String {
    let mut out = String::new();
    for (count, letter) in text.trim().chars().enumerate() {
        if count >= most {
            out.push_str("...");
            break;
        }
        match letter {
            '\n' => out.push_str("; "),
            '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2060}'..='\u{206f}' => {
                out.push(' ');
            }
            letter if letter.is_control() => out.push(' '),
            letter => out.push(letter),
        }
    }
    out
}
