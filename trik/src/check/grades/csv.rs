//! The table of a class as CSV: UTF-8 with a mark at its beginning, commas, as RFC 4180 has it.
//!
//! Owns the rows and columns; how a text becomes a cell is known to `output`.

use super::{Grades, number};
use crate::check::words;
use crate::output::csv::text;
use std::fmt::Write as _;

/// By which spreadsheet programs know that a file is UTF-8.
const MARK: char = '\u{feff}';
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
