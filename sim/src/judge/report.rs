//! What was said in a run as a report: the form in which TRIK Studio's `2D-model` writes it.
//!
//! Owns that form: a list of levels and messages, and the variables of the rules as they are.

use super::json;
use lang_constraint::{Entry, Level};

/// The name of a level in reports.
pub fn level(level: Level) -> &'static str {
    match level {
        Level::Info => "info",
        // What is wrong with rules is told like everything that is wrong.
        Level::Error | Level::Critical => "error",
        Level::Log | Level::Variables => "log",
    }
}

/// The report as JSON.
pub fn write(entries: &[Entry]) -> String {
    let mut out = String::from("[");
    for (index, entry) in entries.iter().enumerate() {
        out.push_str(if index == 0 { "\n" } else { ",\n" });
        if entry.level == Level::Variables {
            out.push_str(&entry.text);
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
