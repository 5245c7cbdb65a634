//! A world of TRIK Studio for `trik up`, and for planners: from a file to a field.
//!
//! Owns which files have worlds and what is said when one has none. Knows no simulation.

use crate::error::Error;
use crate::input::{self, Unread};
use lang_text::problem::Problem;
use sim::field::{Field, Locks};
use std::path::Path;

/// Bytes of a file that are read at most: more than any save may have.
const BYTES: u64 = 64 << 20;

/// The field of a world model, or of a project, and what the project locks.
///
/// # Errors
/// The file cannot be read, or there is no world in it.
pub(crate) fn read(path: &Path) -> Result<(Field, Locks), Error> {
    let say = |problem: &dyn std::fmt::Display| format!("{}: {problem}", path.display());
    let refused = |why: &dyn std::fmt::Display| Error::file(path, why);
    let bytes = input::read(path, BYTES).map_err(|unread| match unread {
        Unread::Missing => refused(&"there is no such file"),
        Unread::Directory => refused(&"this is a directory: name a world or a project"),
        Unread::TooLong => refused(&format!("longer than {} MiB", BYTES >> 20)),
        Unread::Silent => refused(&"nothing comes out of this FIFO or device: name a file"),
        Unread::Failed(error) => refused(&error),
    })?;
    let all = |problems: Vec<Problem>| {
        let lines: Vec<String> = problems.iter().map(|one| say(one)).collect();
        Error::Refused(lines.join("\n"))
    };
    let is_text = bytes
        .iter()
        .find(|byte| !byte.is_ascii_whitespace() && ![0xef, 0xbb, 0xbf].contains(*byte))
        == Some(&b'<');
    let mut locks = Locks::default();
    let (text, blobs) = if is_text {
        let text = String::from_utf8(bytes).map_err(|error| refused(&error))?;
        (text, None)
    } else {
        let project = lang_diagram::read::read(&bytes).map_err(all)?.project;
        locks = Locks::of(&project.meta);
        let none = "there is no world in this project; give a world model, FILE.xml";
        (project.world.ok_or_else(|| refused(&none))?, project.blobs)
    };
    let mut opened = Field::read(&text).map_err(all)?;
    let mut problems = std::mem::take(&mut opened.problems);
    problems.extend(opened.field.add_blobs(&blobs.unwrap_or_default()));
    for problem in &problems {
        eprintln!("trik: {}", say(problem));
    }
    Ok((opened.field, locks))
}
