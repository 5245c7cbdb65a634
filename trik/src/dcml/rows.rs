//! A table of actions: names in the first line, then rising times in s, each with what is done from then on.
//!
//! Owns the form of the table. Columns of states are left out, so that tables of other commands can be given. Knows no
//! command.

use crate::input::{self, Unread};
use crate::limits;
use crate::refusal::{Refusal, UNREADABLE};
use std::path::Path;

/// The text of a table.
pub(super) fn read(path: &str) -> Result<String, Refusal> {
    let unreadable = |why: String| Refusal {
        lines: vec![format!("trik: {path}: {why}")],
        code: UNREADABLE,
    };
    let most = limits::DCML_ACTIONS_BYTES_MAX;
    let bytes = input::read(Path::new(path), most).map_err(|unread| {
        unreadable(match unread {
            Unread::Missing => {
                "there is no such table of actions; formulas are NAME = FORMULA".to_owned()
            }
            Unread::Directory => "this is a directory: name a table".to_owned(),
            Unread::TooLong => format!("longer than {} MiB", most >> 20),
            Unread::Silent => "nothing comes out of this FIFO or device: name a file".to_owned(),
            Unread::Failed(error) => format!("cannot be read: {error}"),
        })
    })?;
    lang_dcml::decode(bytes).map_err(|why| Refusal {
        lines: vec![format!("trik: {path}:{why}")],
        code: UNREADABLE,
    })
}

/// Times and lines of actions in the order of the names; else `LINE:COLUMN` and what is wrong there.
pub(super) fn table_of(
    text: &str,
    names: &[&str],
    others: &[&str],
) -> Result<Rows, (String, String)> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = (1..)
        .zip(text.lines())
        .filter(|(_, line)| !line.trim().is_empty());
    let (at, header) = lines.next().ok_or_else(|| {
        let why = format!(
            "the table is empty: its first line is t,{}",
            names.join(",")
        );
        ("1:1".to_owned(), why)
    })?;
    let columns = columns(at, header, names, others)?;
    let (mut times, mut rows): Rows = (Vec::new(), Vec::new());
    for (at, line) in lines {
        if rows.len() >= limits::DCML_ROWS_MAX {
            return Err((
                format!("{at}:1"),
                format!("more than {} lines", limits::DCML_ROWS_MAX),
            ));
        }
        let mut row = vec![0.0; names.len()];
        let mut time = 0.0;
        let mut count = 0;
        for (cell, (column, place)) in cells(line).zip(columns.iter().zip(0..)) {
            count = place + 1;
            // An output may be no number, which is no matter here.
            if matches!(column, Meaning::Other(_)) {
                continue;
            }
            let shown: String = cell.1.chars().take(40).collect();
            let number: f64 = match cell.1.parse() {
                Ok(number) if f64::is_finite(number) => number,
                _ => {
                    return Err((
                        format!("{at}:{}", cell.0),
                        format!("{shown:?} is no number"),
                    ));
                }
            };
            match column {
                Meaning::Time => time = number,
                Meaning::Action(action) => row[*action] = number,
                Meaning::Other(_) => (),
            }
        }
        let given = cells(line).count();
        if given != columns.len() || count != columns.len() {
            let why = format!(
                "there are {given} numbers, but the first line has {} names",
                columns.len()
            );
            return Err((format!("{at}:1"), why));
        }
        if times.last().is_some_and(|last| time <= *last) {
            let why = format!("the time {time} s does not come after the one before it");
            return Err((format!("{at}:1"), why));
        }
        times.push(time);
        rows.push(row);
    }
    if rows.is_empty() {
        return Err((
            format!("{at}:1"),
            "there are no lines under the names".into(),
        ));
    }
    Ok((times, rows))
}

/// Times, and a line of numbers for each.
pub(super) type Rows = (Vec<f64>, Vec<Vec<f64>>);

/// What a column is.
#[derive(Clone, Copy, PartialEq)]
enum Meaning {
    Time,
    /// By its number.
    Action(usize),
    /// A state or an output, which actions do not need.
    Other(usize),
}

/// What each column is, all of them different.
fn columns(
    at: usize,
    header: &str,
    names: &[&str],
    others: &[&str],
) -> Result<Vec<Meaning>, (String, String)> {
    let mut columns: Vec<Meaning> = Vec::new();
    let all = || format!("the names are t,{}", names.join(","));
    for (column, cell) in cells(header) {
        let shown: String = cell.chars().take(40).collect();
        let place = |all: &[&str]| all.iter().position(|one| *one == cell);
        let found = match (place(names), place(others)) {
            (Some(action), _) => Meaning::Action(action),
            (None, _) if cell == "t" => Meaning::Time,
            (None, Some(other)) => Meaning::Other(other),
            (None, None) => {
                let why = format!("there is no action {shown:?}: {}", all());
                return Err((format!("{at}:{column}"), why));
            }
        };
        if columns.contains(&found) {
            let why = format!("{shown:?} is there twice");
            return Err((format!("{at}:{column}"), why));
        }
        columns.push(found);
    }
    let is_missing = |one: &Meaning| !columns.contains(one);
    let wanted = (0..names.len()).map(Meaning::Action);
    let name = match wanted.chain([Meaning::Time]).find(is_missing) {
        None => return Ok(columns),
        Some(Meaning::Action(action)) => names.get(action).copied().unwrap_or_default(),
        Some(_) => "t",
    };
    Err((format!("{at}:1"), format!("{name} is missing: {}", all())))
}

/// Cells of a line with their columns, counted from 1.
fn cells(line: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut column = 1;
    line.split(',').map(move |cell| {
        let blanks = cell.chars().take_while(|sign| sign.is_whitespace()).count();
        let place = column + blanks;
        column += cell.chars().count() + 1;
        (place, cell.trim())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_have_their_names_in_any_order() {
        let found = table_of("b, t ,x,a\n1,0,9,2\n\n3,0.5,9,4\n", &["a", "b"], &["x"]);
        let expected = (vec![0.0, 0.5], vec![vec![2.0, 1.0], vec![4.0, 3.0]]);
        assert_eq!(found, Ok(expected));
    }

    #[test]
    fn what_is_wrong_has_its_place() {
        for (text, place, why) in [
            ("", "1:1", "the table is empty: its first line is t,a"),
            (
                "t,b\n",
                "1:3",
                "there is no action \"b\": the names are t,a",
            ),
            ("t\n", "1:1", "a is missing: the names are t,a"),
            ("a\n", "1:1", "t is missing: the names are t,a"),
            ("t,a,a\n", "1:5", "\"a\" is there twice"),
            ("t,a\n", "1:1", "there are no lines under the names"),
            ("t,a\n0, x\n", "2:4", "\"x\" is no number"),
            ("t,a\n0,inf\n", "2:3", "\"inf\" is no number"),
            (
                "t,a\n0\n",
                "2:1",
                "there are 1 numbers, but the first line has 2 names",
            ),
            (
                "t,a\n0,1,2\n",
                "2:1",
                "there are 3 numbers, but the first line has 2 names",
            ),
            (
                "t,a\n0,1\n0,1\n",
                "3:1",
                "the time 0 s does not come after the one before it",
            ),
        ] {
            let expected = Err((place.to_owned(), why.to_owned()));
            assert_eq!(table_of(text, &["a"], &["x"]), expected, "{text:?}");
        }
    }
}
