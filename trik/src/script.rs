//! Programs in languages with text under a judge: JavaScript and Python in virtual time.
//!
//! Model time passes only while a program waits, so the same program in the same world does the same each time. `tree` is
//! the robot as files, `drawing` its display, `input` its keys and gamepad, `refresh` how old
//! readings are, `lines` where its threads stand; `stage` is where JavaScript stands, `javascript`
//! steps its threads; `python` serves a child process.

mod drawing;
mod input;
mod javascript;
mod lines;
mod python;
mod refresh;
mod stage;
mod tree;
mod words;

pub use javascript::JavaScript;
pub use python::Python;

use lang_diagram::brick::Command;
use lang_text::problem::{Place, Position, Problem, Words};
use std::path::{Component, Path};
use trikd::js::files::{Unread, read_text};
use trikd::protocol::program::mailbox::Question;

/// When a program begins, in milliseconds of model time: as late as a diagram does in the original's simulator, so that
/// what rules do at the beginning is done by then.
const START_MS: u32 = 30;

/// A file of the program's folder: programs under a judge see nothing else.
fn beside(folder: &Path, file: &str) -> Result<String, Unread> {
    let is_plain = Path::new(file)
        .components()
        .all(|part| matches!(part, Component::Normal(_)));
    if !is_plain {
        return Err(Unread::Outside(file.to_owned()));
    }
    read_text(&folder.join(file))
}

/// What the mailbox answers to the words of the daemon's programs, and what the robot is told.
fn mailbox(words: &str, hull: &mut i32, mut tell: impl FnMut(Command<'_>)) -> String {
    let Some(question) = Question::parse(words) else {
        return String::new();
    };
    match question {
        Question::Send { hull, text } => tell(Command::Send {
            message: text,
            hull: hull.filter(|hull| *hull >= 0),
        }),
        Question::Join {
            address,
            port,
            hull: own,
        } => {
            *hull = own.max(0);
            tell(Command::Join {
                address,
                port,
                hull: own,
            });
        }
        Question::SetHull(number) => {
            *hull = number;
            return hull.to_string();
        }
        Question::Hull => return hull.to_string(),
        Question::Ip => return "127.0.0.1".to_owned(),
        Question::Connected | Question::Enabled => return "1".to_owned(),
        // The judge knows no other addresses.
        Question::Connect { .. } | Question::Server | Question::Renew => {}
    }
    String::new()
}

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
