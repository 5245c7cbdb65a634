//! The documentation of models as Markdown: what is said of each name, and all equations.
//!
//! Owns the page. Texts of the author stay as they are, except where they would be read as part of a table or a heading.

use super::diagnostic::Diagnostic;
use super::format::format;
use super::lexer::slice;
use super::syntax::{Declaration, Domain, Kind, ModelText};
use std::fmt::Write;

/// A page for all models of a document; else why it cannot be read. Mistakes of meaning are no hindrance.
pub fn markdown(text: &str) -> Result<String, Vec<Diagnostic>> {
    // Equations are shown in the one layout.
    let text = format(text)?;
    let document = super::understand(&text).document;
    let mut out = String::new();
    for model in &document.models {
        if !out.is_empty() {
            out.push('\n');
        }
        page(model, &text, &mut out);
    }
    Ok(out)
}

fn page(model: &ModelText, text: &str, out: &mut String) {
    let _ = writeln!(out, "# {}\n", model.name.text);
    if let Some(package) = &model.package {
        let _ = writeln!(out, "Package `{}`.\n", package.text);
    }
    if let Some(doc) = &model.doc {
        for line in doc.text.lines() {
            let line = line.trim_end();
            // A heading would be one of the page; a tag of JavaDoc is a point of a list.
            match line.strip_prefix('@').and_then(|tag| tag.split_once(' ')) {
                Some((tag, rest)) => {
                    let _ = writeln!(out, "- *{tag}* {}", rest.trim());
                }
                None if line.starts_with('#') => {
                    let _ = writeln!(out, "\\{line}");
                }
                None => {
                    let _ = writeln!(out, "{line}");
                }
            }
        }
        out.push('\n');
    }
    for (kind, title) in [
        (Kind::Action, "Actions"),
        (Kind::Param, "Parameters"),
        (Kind::Const, "Constants"),
        (Kind::Config, "Configuration"),
        (Kind::Var, "Variables"),
    ] {
        let sections = model.sections.iter().filter(|one| one.kind == kind);
        let names: Vec<&Declaration> = sections.flat_map(|one| &one.names).collect();
        if !names.is_empty() {
            table(title, &names, text, out);
        }
    }
    out.push_str("## Equations\n\n```dcml\n");
    for one in &model.equations {
        for line in slice(text, one.span).lines() {
            // In a model they stand two spaces further to the right.
            let _ = writeln!(out, "{}", line.strip_prefix("  ").unwrap_or(line));
        }
    }
    out.push_str("```\n");
}

/// A row for each name; columns that nobody fills are left out.
fn table(title: &str, names: &[&Declaration], text: &str, out: &mut String) {
    let value = |one: &Declaration| {
        let (_, span) = one.value?;
        Some(format!("`{}`", slice(text, span)))
    };
    let unit = |one: &Declaration| one.unit.as_ref().map(|unit| unit.text.clone());
    let range = |one: &Declaration| {
        one.domain.map(|(domain, _)| match domain {
            Domain::Circle => "an angle that wraps".to_owned(),
            Domain::Range(from, to) => format!("{from} to {to}"),
        })
    };
    let doc = |one: &Declaration| one.doc.as_ref().map(|doc| doc.text.clone());
    type Column<'a> = (&'a str, &'a dyn Fn(&Declaration) -> Option<String>);
    let all: [Column<'_>; 4] = [
        ("value", &value),
        ("unit", &unit),
        ("range", &range),
        ("meaning", &doc),
    ];
    let is_used = |column: &&Column<'_>| names.iter().any(|one| column.1(one).is_some());
    let columns: Vec<&Column<'_>> = all.iter().filter(is_used).collect();
    let _ = write!(out, "## {title}\n\n| name |");
    for (name, _) in &columns {
        let _ = write!(out, " {name} |");
    }
    out.push_str("\n| --- |");
    out.push_str(&" --- |".repeat(columns.len()));
    out.push('\n');
    for one in names {
        let _ = write!(out, "| `{}` |", one.name.text);
        for (_, column) in &columns {
            let cell = column(one).unwrap_or_default();
            let _ = write!(out, " {} |", in_cell(&cell));
        }
        out.push('\n');
    }
    out.push('\n');
}

/// One line, in which no bar ends the cell.
fn in_cell(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").replace('|', "\\|")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_page_has_what_is_said_and_no_empty_columns() {
        let text = "/** A car.\n * # Not a heading\n * @author me\n */
BEGIN Car PACKAGE: a.b;
ACTION: v [m/s] in -1 .. 2, /** speed | forwards */
  w;
PARAM: /** the
  * base */ L;
CONST: g = -9.81;
CONFIG: x, th in S1;
d(x)=v*L*g; d(th)=w; END;";
        insta::assert_snapshot!("page", markdown(text).expect("a page"));
        assert!(markdown("BEGIN").is_err());
    }
}
