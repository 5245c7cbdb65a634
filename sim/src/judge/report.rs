//! What was said in a run as a report: the form in which TRIK Studio's `2D-model` writes it.
//!
//! Owns that form: a list of levels and messages, and the variables of the rules as they are.

use super::json::{self, Value};
use lang_constraint::{Entry, Level};
use lang_diagram::blocks;
use lang_text::problem::{Locale, Place, Problem};

/// The name of a level in reports.
pub fn level(level: Level) -> &'static str {
    match level {
        Level::Info => "info",
        Level::Warning => "warning",
        // What is wrong with rules is told like everything that is wrong.
        Level::Error | Level::Critical => "error",
        Level::Log | Level::Variables => "log",
    }
}

/// Where a problem is, for people; the original tells none of this.
pub fn place(problem: &Problem) -> String {
    let place = &problem.place;
    let parts = [&place.file, &place.diagram, &place.block];
    let parts = parts.into_iter().flatten();
    parts.map(|part| format!("{part}: ")).collect()
}

/// A problem in the words of the original, which gives no advice.
pub fn text(problem: &Problem, locale: Locale) -> String {
    let row = problem.place.block.as_deref().and_then(blocks::find_shown);
    let label = |name: &String| {
        row.map_or(name.as_str(), |row| row.label(name, locale))
            .to_owned()
    };
    let bare = Problem {
        place: Place {
            property: problem.place.property.as_ref().map(label),
            position: problem.place.position,
            ..Place::default()
        },
        hint: None,
        ..problem.clone()
    };
    let text = bare.in_locale(locale);
    let is_expression = problem.place.property.is_some();
    match text.split_once(". ") {
        // Advice is what follows a sentence about an expression.
        Some((said, _)) if is_expression => said.to_owned(),
        _ => text,
    }
}

/// What a message becomes that looks like JSON there: nothing, or what it is if it has variables.
fn raw(entry: &Entry) -> Option<Option<&str>> {
    let is_said = matches!(entry.level, Level::Info | Level::Log);
    if entry.level == Level::Variables {
        return Some(Some(&entry.text));
    }
    if !is_said || !entry.text.trim_start().starts_with('{') {
        return None;
    }
    match json::read(&entry.text) {
        Ok(value @ Value::Object(_)) => {
            let has_variables = value.get("variables").is_some();
            Some(has_variables.then_some(entry.text.as_str()))
        }
        _ => None,
    }
}

/// The report as JSON.
pub fn write(entries: &[Entry]) -> String {
    let mut out = String::from("[");
    let mut is_first = true;
    for entry in entries {
        let raw = raw(entry);
        if raw == Some(None) {
            continue;
        }
        out.push_str(if is_first { "\n" } else { ",\n" });
        is_first = false;
        if let Some(Some(raw)) = raw {
            out.push_str(raw);
            continue;
        }
        out.push_str("{\"level\":");
        json::text(&mut out, level(entry.level));
        out.push_str(",\"message\":");
        json::text(&mut out, &entry.text);
        out.push('}');
    }
    out.push_str("\n]\n");
    out
}

/// A report of levels and messages alone.
pub fn of_messages(messages: &[(String, String)]) -> String {
    let mut out = String::from("[");
    for (index, (level, message)) in messages.iter().enumerate() {
        out.push_str(if index == 0 {
            "\n{\"level\":"
        } else {
            ",\n{\"level\":"
        });
        json::text(&mut out, level);
        out.push_str(",\"message\":");
        json::text(&mut out, message);
        out.push('}');
    }
    out.push_str("\n]\n");
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::judge::json::{Value, read};

    #[test]
    fn a_report_has_levels_messages_and_the_variables() {
        let entry = |level, text: &str| Entry {
            level,
            at_ms: 0,
            place: String::new(),
            text: text.to_owned(),
        };
        let report = write(&[
            entry(Level::Info, "a \"b\""),
            entry(Level::Critical, "c"),
            entry(
                Level::Variables,
                r#"{"variables":[{"name":"total_score","value":3}]}"#,
            ),
        ]);
        let Ok(Value::Array(list)) = read(&report) else {
            panic!("{report}");
        };
        assert_eq!(
            list[0].get("message").and_then(Value::as_str),
            Some("a \"b\"")
        );
        assert_eq!(list[1].get("level").and_then(Value::as_str), Some("error"));
        let variables = list[2].get("variables");
        assert!(matches!(variables, Some(Value::Array(list)) if list.len() == 1));
        assert_eq!(read(&write(&[])), Ok(Value::Array(Vec::new())));
    }
}
