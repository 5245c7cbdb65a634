//! The table of a class as CSV: UTF-8 with a mark at its beginning, commas, as RFC 4180 has it.
//!
//! Owns that form. A text that a spreadsheet program would take for a formula begins with an apostrophe.

use super::{Grades, number};
use crate::check::words;
use std::fmt::Write as _;

/// By which spreadsheet programs know that a file is UTF-8.
const MARK: char = '\u{feff}';
/// What formulas begin with, in narrow and in wide letters.
const FORMULA: [char; 10] = [
    '=', '+', '-', '@', '\t', '\r', '\u{ff1d}', '\u{ff0b}', '\u{ff0d}', '\u{ff20}',
];

/// The whole file.
pub(super) fn write(grades: &Grades) -> String {
    let mut out = String::from(MARK);
    let titles = words::table(grades.locale);
    let mut cells = vec![text(titles.pupil)];
    for column in &grades.columns {
        let name = column.name();
        cells.push(text(&name));
        cells.push(text(&format!("{name}: {}", titles.result)));
    }
    cells.push(text(titles.sum));
    if grades.pass_mark.is_some() {
        cells.push(text(titles.passed));
    }
    line(&mut out, &cells);
    for (pupil, name) in grades.pupils.iter().enumerate() {
        let mut cells = vec![text(name)];
        for column in 0..grades.columns.len() {
            let run = grades.cell(pupil, column);
            let points = run.and_then(|run| run.points);
            cells.push(points.map_or_else(String::new, number));
            cells.push(text(grades.result(run)));
        }
        cells.push(number(grades.sum(pupil)));
        if let Some(passed) = grades.has_passed(pupil) {
            cells.push(text(words::yes_or_no(passed, grades.locale)));
        }
        line(&mut out, &cells);
    }
    out
}

fn line(out: &mut String, cells: &[String]) {
    let _ = write!(out, "{}\r\n", cells.join(","));
}

/// A text, in quotes if it needs them.
fn text(text: &str) -> String {
    let is_formula = text.trim_start_matches(' ').starts_with(FORMULA);
    let mark = if is_formula { "'" } else { "" };
    let needs_quotes = |c: char| matches!(c, ',' | ';' | '"' | '\t' | '\r' | '\n');
    match is_formula || text.contains(needs_quotes) {
        true => format!("\"{mark}{}\"", text.replace('"', "\"\"")),
        false => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn no_text_is_a_formula() {
        for (name, written) in [
            ("anna", "anna"),
            (
                "=HYPERLINK(\"http://x\")",
                "\"'=HYPERLINK(\"\"http://x\"\")\"",
            ),
            (" =1", "\"' =1\""),
            ("-5", "\"'-5\""),
            ("@a", "\"'@a\""),
            ("a,b;c", "\"a,b;c\""),
            ("\u{ff1d}1", "\"'\u{ff1d}1\""),
        ] {
            assert_eq!(super::text(name), written);
        }
    }
}
