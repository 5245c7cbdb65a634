//! A failure of a program with text as a problem with its place.
//!
//! Pure. Knows how the runners of all languages write the line of a failure.

use lang_text::problem::{Place, Position, Problem, Words};

/// A failure of a program as a problem: its file, and its line if the text begins with one.
pub fn problem(file: &str, text: &str) -> Problem {
    let line = text
        .strip_prefix("Line ")
        .and_then(|rest| rest.split_once(": "))
        .and_then(|(number, rest)| Some((number.parse().ok()?, rest)));
    let said = line.map_or(text, |(_, rest)| rest);
    let mut problem = Problem::error(Words::new(said, said));
    problem.place = Place {
        file: Some(file.to_owned()),
        position: line.map(|(line, _)| Position { line, column: 1 }),
        ..Place::default()
    };
    problem
}
