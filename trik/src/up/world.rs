//! A world of TRIK Studio for `trik up`, and for planners: from a file to a field.
//!
//! Owns which files have worlds and what is said when one has none. Knows no simulation.

use crate::error::Error;
use crate::input::{self, Unread};
use crate::limits;
use lang_text::problem::Problem;
use sim::field::{Field, Locks};
use std::fmt;
use std::path::Path;

/// The field of a world model, or of a project, and what the project locks.
///
/// # Errors
/// The file cannot be read, or there is no world in it.
pub(crate) fn read(path: &Path) -> Result<(Field, Locks), Error> {
    let say = |problem: &dyn std::fmt::Display| format!("{}: {problem}", path.display());
    let refused = |why: &dyn std::fmt::Display| Error::file(path, why);
    let bytes = input::read(path, limits::WORLD_FILE_BYTES_MAX).map_err(|unread| match unread {
        Unread::Missing => refused(&"there is no such file"),
        Unread::Directory => refused(&"this is a directory: name a world or a project"),
        Unread::TooLong => refused(&format!(
            "longer than {} MiB",
            limits::WORLD_FILE_BYTES_MAX >> 20
        )),
        Unread::Silent => refused(&"nothing comes out of this FIFO or device: name a file"),
        Unread::Failed(error) => refused(&error),
    })?;
    let found = of(bytes).map_err(|why| match why {
        Unfit::File(why) => refused(&why),
        Unfit::World(problems) => {
            let lines: Vec<String> = problems.iter().map(|one| say(one)).collect();
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
    File(String),
    /// What is wrong in it.
    World(Vec<Problem>),
}

impl fmt::Display for Unfit {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(why) => out.write_str(why),
            // One is enough for a page.
            Self::World(problems) => problems.iter().take(1).try_for_each(|one| one.fmt(out)),
        }
    }
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
        let text = String::from_utf8(bytes).map_err(|error| Unfit::File(error.to_string()))?;
        (text, None)
    } else {
        let read = lang_diagram::read::read(&bytes).map_err(Unfit::World)?;
        let project = read.project;
        locks = Locks::of(&project.meta);
        let none = "there is no world in this project; give a world model, FILE.xml";
        let world = project.world.ok_or_else(|| Unfit::File(none.to_owned()))?;
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
