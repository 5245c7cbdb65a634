//! Programs in languages with text under a judge: JavaScript and Python in virtual time.
//!
//! Model time passes only while a program waits, so the same program in the same world
//! does the same each time. `tree` is the robot as files, `drawing` its display, `input` its keys and gamepad; `stage` is
//! where JavaScript stands, `javascript` steps its threads.

mod drawing;
mod input;
mod javascript;
mod stage;
mod tree;

pub use javascript::JavaScript;

use lang::problem::{Place, Position, Problem, Words};

/// A failure of a program as a problem: its file, and its line if the text begins with one.
fn problem(file: &str, text: &str) -> Problem {
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

#[cfg(test)]
mod tests;
