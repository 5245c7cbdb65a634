//! The table as a page of documentation: what `docs/user/dataflow.md` has between its marks.
//!
//! Owns the layout of that page. Reads and writes no file.

use super::{Content, Direction, Kind, Property, Row, table};
use std::fmt::Write;

/// Where the made part begins in the page.
pub const BEGIN: &str = "<!-- blocks: begin -->\n";
/// Where it ends.
pub const END: &str = "<!-- blocks: end -->\n";

/// All blocks as Markdown.
pub fn markdown() -> String {
    let mut page = String::new();
    for row in table() {
        block(&mut page, row);
    }
    page.push('\n');
    page
}

fn block(page: &mut String, row: &Row) {
    let _ = write!(page, "\n### {}\n\n`{}`.\n", row.shown, row.element);
    for sentence in row.text.split_inclusive(". ") {
        let _ = writeln!(page, "{}", sentence.trim_end());
    }
    let ports = |direction: Direction| -> String {
        let all = (0..).zip(row.ports);
        let all = all.filter(|(_, port)| port.way == direction);
        let all = all.map(|(at, port)| format!("{at} `{}` {}", port.name, kind(port.of)));
        all.collect::<Vec<String>>().join(", ")
    };
    let _ = writeln!(page, "\n| ports | |\n| --- | --- |");
    for (name, direction) in [("in", Direction::In), ("out", Direction::Out)] {
        let all = ports(direction);
        if !all.is_empty() {
            let _ = writeln!(page, "| {name} | {all} |");
        }
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

/// What tokens of a port are, in a word.
fn kind(kind: Kind) -> String {
    match kind {
        Kind::Unit => "control".into(),
        Kind::Truth => "truth".into(),
        Kind::Whole => "whole number".into(),
        Kind::Text => "text".into(),
        Kind::List => "list".into(),
        Kind::Items(count) => format!("list of {count}"),
        Kind::Any => "anything".into(),
    }
}

fn content(property: &Property) -> String {
    match property.content {
        Content::Expression => "statements; the last one is the value".into(),
        Content::Truth => "expression, true or false".into(),
        Content::Whole => "expression, whole number".into(),
        Content::Variables => "assignments, or names of variables, divided by `;`".into(),
        Content::Evaluated => "text, or an expression with `Evaluate`".into(),
        Content::Raw => "text".into(),
        Content::Constant => "number, truth, text, or list in brackets".into(),
        Content::Number => "whole number, not computed".into(),
        Content::Flag => "`true` or `false`".into(),
        Content::Choice(choices) => {
            let quoted: Vec<String> = choices.iter().map(|word| format!("`{word}`")).collect();
            quoted.join(", ")
        }
        Content::Sensor => "a sensor variable, as `sensorA1`".into(),
        Content::Port => "name of a port".into(),
    }
}
