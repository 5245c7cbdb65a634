//! A save on its way from its file to crate `lang-diagram`.
//!
//! Owns which files are read, and what is said of one that cannot be.

use super::report::Reporter;
use crate::refusal::{Refusal, UNREADABLE};
use crate::terminal::named;
use lang_diagram::limits::SAVE_BYTES;
use lang_diagram::read::{self, Opened};
use lang_text::problem::{Locale, Problem};
use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Why a save cannot be read.
pub(crate) enum Unreadable {
    /// The file itself.
    File(String),
    /// What is in it.
    Save(Vec<Problem>),
}

/// Reads a save.
pub(crate) fn open(path: &Path) -> Result<Opened, Unreadable> {
    let bytes = bytes(path).map_err(Unreadable::File)?;
    read::read(&bytes).map_err(Unreadable::Save)
}

/// Reads a save of which nothing else can be said if it cannot be read.
pub(crate) fn must_open(path: &Path, locale: Locale) -> Result<Opened, Refusal> {
    open(path).map_err(|why| Refusal {
        lines: match why {
            Unreadable::File(why) => vec![format!("trik: {}: {why}", named(path))],
            Unreadable::Save(problems) => Reporter::new(path, None, locale).lines(&problems),
        },
        code: UNREADABLE,
    })
}

/// The bytes of a file that is no longer than a save may be.
fn bytes(path: &Path) -> Result<Vec<u8>, String> {
    let failed = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        io::ErrorKind::IsADirectory => {
            "this is a directory: name a diagram, a file NAME.qrs".to_owned()
        }
        _ => format!("cannot be read: {error}"),
    };
    let limit = SAVE_BYTES as u64;
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(failed)?;
    file.take(limit + 1)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    if bytes.len() as u64 > limit {
        let mib = limit >> 20;
        return Err(format!("longer than {mib} MiB, which no diagram is"));
    }
    Ok(bytes)
}
