//! A world of TRIK Studio for `trik up`, and for planners: from a file to a field.
//!
//! Owns which files have worlds and what is said when one has none. Knows no simulation.

use super::words;
use crate::error::Error;
use crate::input::{self, words as unread_words};
use crate::limits;
use lang_text::problem::{Locale, Problem, Words};
use sim::field::{Field, Locks};
use std::path::Path;

/// The field of a world model, or of a project, and what the project locks; what is wrong is told in this language.
///
/// # Errors
/// The file cannot be read, or there is no world in it.
pub(crate) fn read(path: &Path, locale: Locale) -> Result<(Field, Locks), Error> {
    let say = |problem: &Problem| format!("{}: {}", path.display(), problem.in_locale(locale));
    let refused = |why: &Words| Error::file(path, why.in_locale(locale));
    let most = limits::WORLD_FILE_BYTES_MAX;
    let bytes = input::read(path, most)
        .map_err(|unread| refused(&unread_words::why(&unread, most, words::A_WORLD)))?;
    let found = of(bytes).map_err(|why| match why {
        Unfit::File(why) => refused(&why),
        Unfit::World(problems) => {
            let lines: Vec<String> = problems.iter().map(say).collect();
            Error::Refused(lines.join("\n"))
        }
    })?;
    for problem in &found.problems {
        eprintln!("trik: {}", say(problem));
    }
    Ok((found.field, found.locks))
}

/// A world that was found in a file.
pub(crate) struct FoundWorld {
    /// The world.
    pub(crate) field: Field,
    /// What its project locks.
    pub(crate) locks: Locks,
    /// What is strange in it.
    problems: Vec<Problem>,
}

/// Why there is no world in bytes.
pub(crate) enum Unfit {
    /// It is another kind of file.
    File(Words),
    /// What is wrong in it.
    World(Vec<Problem>),
}

/// The world in the bytes of a file.
///
/// # Errors
/// There is none.
pub(crate) fn of(bytes: Vec<u8>) -> Result<FoundWorld, Unfit> {
    let is_text = bytes
        .iter()
        .find(|byte| !byte.is_ascii_whitespace() && ![0xef, 0xbb, 0xbf].contains(*byte))
        == Some(&b'<');
    let mut locks = Locks::default();
    let (text, blobs) = if is_text {
        let text = String::from_utf8(bytes).map_err(|_| Unfit::File(unread_words::no_text()))?;
        (text, None)
    } else {
        let read = lang_diagram::read::read(&bytes).map_err(Unfit::World)?;
        let project = read.project;
        locks = Locks::of(&project.meta);
        let world = project
            .world
            .ok_or_else(|| Unfit::File(words::no_world()))?;
        (world, project.blobs)
    };
    let mut opened = Field::read(&text).map_err(Unfit::World)?;
    let mut problems = std::mem::take(&mut opened.problems);
    problems.extend(opened.field.add_blobs(&blobs.unwrap_or_default()));
    Ok(FoundWorld {
        field: opened.field,
        locks,
        problems,
    })
}
