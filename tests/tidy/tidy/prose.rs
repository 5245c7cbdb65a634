//! Rules of prose: tables of documents are whole, and old turns of phrase do not come back, also not in comments.

use std::path::PathBuf;

use super::{none, sources};
use harness::documents::documents;

/// Phrases that a reader stumbles over, in small letters, with what to write instead.
const BANNED: [(&str, &str); 13] = [
    ("who is not", "if you are not"),
    ("whoever", "if you, anyone who, a program that"),
    ("may have so much", "is at most"),
    ("may have so many", "has at most"),
    ("in the place of", "instead of"),
    ("in place of", "instead of"),
    ("one behind the other", "one after the other"),
    ("thereof", "of it"),
    ("gives itself", "takes"),
    ("what is more is", "what exceeds that is"),
    ("of long ago", "outdated"),
    ("robots of old", "earlier robots"),
    ("if it is not said", "by default"),
];

/// Lines of prose of all documents, without examples, with their places. Not the list of modules: `.ci/modules` makes it
/// from the sources.
fn prose() -> Vec<(PathBuf, Vec<(usize, String)>)> {
    let read = |path: PathBuf| {
        let text = std::fs::read_to_string(&path)
            .unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut inside = false;
        let mut lines = Vec::new();
        for (index, line) in text.lines().enumerate() {
            if line.trim_start().starts_with("```") {
                inside = !inside;
            } else if !inside {
                lines.push((index + 1, line.to_owned()));
            }
        }
        (path, lines)
    };
    let is_written = |path: &PathBuf| !path.ends_with("maintainer/modules.md");
    documents()
        .into_iter()
        .filter(is_written)
        .map(read)
        .collect()
}

/// Cells of a row of a table: what stands between bars, except bars after a backslash.
fn cells(row: &str) -> usize {
    let row = row.trim().replace("\\|", "");
    row.trim_start_matches('|')
        .trim_end_matches('|')
        .matches('|')
        .count()
        + 1
}

#[test]
fn every_row_of_a_table_has_as_many_cells_as_its_header() {
    let mut complaints = Vec::new();
    for (path, lines) in prose() {
        let mut header = None;
        for (number, line) in lines {
            if !line.starts_with('|') {
                header = None;
                continue;
            }
            let wanted = *header.get_or_insert(cells(&line));
            if cells(&line) != wanted || !line.trim_end().ends_with('|') {
                let found = cells(&line);
                complaints.push(format!(
                    "{}:{number}: {found} cells, not {wanted}",
                    path.display()
                ));
            }
        }
    }
    none(&complaints);
}

/// Rows that show fences themselves.
const SHOWS_FENCES: &str = "docs/maintainer/testing.md";

/// A quotation that goes on in the next line has lost what stood at the break: `\n` that became a new line.
#[test]
fn quotations_end_in_their_line() {
    let mut complaints = Vec::new();
    for (path, lines) in prose() {
        for (number, line) in lines {
            let is_odd = line.matches('`').count() % 2 != 0;
            let shows_fences = path.ends_with(SHOWS_FENCES) && line.starts_with('|');
            if is_odd && !shows_fences {
                let path = path.display();
                complaints.push(format!("{path}:{number}: a backtick has no partner"));
            }
        }
    }
    none(&complaints);
}

/// What a line says in such words, with its place.
fn stumbles<'a>(place: &'a str, line: &str) -> impl Iterator<Item = String> + 'a {
    let line = line.to_lowercase();
    let found = BANNED
        .iter()
        .filter(move |(phrase, _)| line.contains(phrase));
    found.map(move |(phrase, better)| format!("{place}: '{phrase}': write {better}"))
}

#[test]
fn documents_are_written_in_plain_words() {
    let mut complaints = Vec::new();
    for (path, lines) in prose() {
        for (number, line) in lines {
            complaints.extend(stumbles(&format!("{}:{number}", path.display()), &line));
        }
    }
    none(&complaints);
}

#[test]
fn comments_are_written_in_plain_words() {
    let mut complaints = Vec::new();
    for source in sources() {
        for (index, line) in source.text.lines().enumerate() {
            let line = line.trim_start();
            if line.starts_with("//") {
                complaints.extend(stumbles(&format!("{}:{}", source.path, index + 1), line));
            }
        }
    }
    none(&complaints);
}
