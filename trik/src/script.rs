//! Programs in languages with text under a judge: JavaScript and Python in virtual time.
//!
//! Model time passes only while a program waits, so the same program in the same world does the same each time. `tree` is
//! the robot as files, `drawing` its display, `input` its keys and gamepad, `refresh` how old
//! readings are; `stage` is where JavaScript stands, `javascript`
//! steps its threads; `python` serves a child process.

mod drawing;
mod input;
mod javascript;
mod python;
mod refresh;
mod stage;
mod tree;

pub use javascript::JavaScript;
pub use python::Python;

use lang_diagram::brick::Command;
use lang_text::problem::{Place, Position, Problem, Words};
use std::path::{Component, Path};
use trikd::js::read_text;

/// When a program begins, in milliseconds of model time: as late as a diagram does in the original's simulator, so that
/// what rules do at the beginning is done by then.
const START_MS: u32 = 30;

/// A file of the program's folder: programs under a judge see nothing else.
fn beside(folder: &Path, file: &str) -> Result<String, String> {
    let is_plain = Path::new(file)
        .components()
        .all(|part| matches!(part, Component::Normal(_)));
    if !is_plain {
        return Err(format!(
            "{file}: a judged program reads only files of its own folder"
        ));
    }
    read_text(&folder.join(file))
}

/// What the mailbox answers to the words of the daemon's programs, and what the robot is told.
fn mailbox(words: &str, hull: &mut i32, mut tell: impl FnMut(Command<'_>)) -> String {
    let (word, rest) = words.split_once(' ').unwrap_or((words, ""));
    let number = |text: &str| text.trim().parse::<i32>().ok();
    match word {
        "send" => {
            let (to, message) = rest.split_once(' ').unwrap_or((rest, ""));
            let hull = number(to).filter(|hull| *hull >= 0);
            tell(Command::Send { message, hull });
        }
        "join" => {
            let mut parts = rest.split(' ');
            let address = parts.next().unwrap_or("");
            let mut part = || parts.next().and_then(number).unwrap_or(-1);
            let (port, own) = (part(), part());
            *hull = own.max(0);
            tell(Command::Join {
                address,
                port,
                hull: own,
            });
        }
        "hull" => {
            *hull = number(rest).unwrap_or(*hull);
            return hull.to_string();
        }
        "ip" => return "127.0.0.1".to_owned(),
        "connected" | "enabled" => return "1".to_owned(),
        _ => {}
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
