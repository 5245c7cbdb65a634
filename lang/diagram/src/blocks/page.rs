//! The table as a page of documentation: what `docs/user/blocks.md` has between its marks.
//!
//! Owns the layout of that page. Reads and writes no file.

use lang_text::problem::Locale;
use std::fmt::Write;

use super::{Category, Content, Kits, Property, Row, Silent, Type, table};

/// Where the made part begins in the page.
pub const BEGIN: &str = "<!-- blocks: begin -->\n";
/// Where it ends.
pub const END: &str = "<!-- blocks: end -->\n";

/// All blocks as Markdown.
pub fn markdown() -> String {
    let mut page = String::new();
    for category in [
        Category::Algorithms,
        Category::Actions,
        Category::Wait,
        Category::Drawing,
    ] {
        let title = match category {
            Category::Algorithms => "Algorithms",
            Category::Actions => "Actions",
            Category::Wait => "Waiting",
            Category::Drawing => "Drawing",
        };
        let _ = write!(page, "\n## {title}\n");
        for row in table().filter(|row| row.category == category) {
            block(&mut page, row);
        }
    }
    page.push('\n');
    page
}

fn block(page: &mut String, row: &Row) {
    let kits = match row.kits {
        Kits::Both => "",
        Kits::V6 => ", kit V6 only",
        Kits::V62 => ", kit V62 only",
    };
    let _ = write!(page, "\n### {}\n\n`{}`{kits}.\n", row.shown, row.kind);
    for sentence in sentences(row.text_in(Locale::English)) {
        let _ = writeln!(page, "{sentence}");
    }
    match row.silent {
        Silent::Never => {}
        Silent::Simulated => page.push_str("It is passed through in the simulator.\n"),
        Silent::WithoutMailbox => {
            page.push_str("It is passed through in a simulator without a mailbox.\n");
        }
        Silent::WithoutGamepad => {
            page.push_str("It is passed through in a simulator without a gamepad.\n");
        }
        Silent::Real => page.push_str("It is passed through on a real robot.\n"),
        Silent::Always => page.push_str("It is passed through when a diagram is run.\n"),
    }
    if row.properties.is_empty() {
        return;
    }
    page.push_str("\n| property | shown as | what | default |\n| --- | --- | --- | --- |\n");
    for property in row.properties {
        let default = match property.default {
            "" => String::new(),
            text => format!("`{text}`"),
        };
        let _ = writeln!(
            page,
            "| `{}` | {} | {} | {default} |",
            property.name,
            property.shown,
            content(property)
        );
    }
}

/// One sentence per line, as everywhere in the documentation.
fn sentences(text: &str) -> impl Iterator<Item = &str> {
    text.split_inclusive(". ").map(str::trim_end)
}

fn content(property: &Property) -> String {
    let words = |words: &[&str]| {
        let quoted: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
        quoted.join(", ")
    };
    match property.content {
        Content::Expression(Type::Statements) => "statements".into(),
        Content::Expression(Type::Truth) => "expression, true or false".into(),
        Content::Expression(Type::Whole) => "expression, whole number".into(),
        Content::Expression(Type::Number) => "expression, number".into(),
        Content::Expression(Type::Text | Type::Printed) => "expression, text".into(),
        Content::Expression(Type::List) => "expression, list of ports".into(),
        Content::Evaluated => "text, or an expression with `Evaluate`".into(),
        Content::Raw => "text".into(),
        Content::Variable => "name of a variable".into(),
        Content::Ports => "ports, divided by commas".into(),
        Content::Number => "whole number, no expression".into(),
        Content::Flag => "`true` or `false`".into(),
        Content::Choice(choices) => words(choices),
        Content::Port(ports) => format!("port: {}", words(ports)),
    }
}
