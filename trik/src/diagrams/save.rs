//! A save on its way from its file to crate `lang-diagram`.
//!
//! Owns which files are read, and what is said of one that cannot be.

use super::report::Reporter;
use crate::input::{self, Unread};
use crate::refusal::{Refusal, UNREADABLE};
use crate::terminal::named;
use lang_diagram::limits::SAVE_BYTES;
use lang_diagram::read::{self, Opened};
use lang_text::problem::{Locale, Problem};
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
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, String> {
    let limit = SAVE_BYTES as u64;
    input::read(path, limit).map_err(|unread| match unread {
        Unread::Missing => "there is no such file".to_owned(),
        Unread::Directory => "this is a directory: name a diagram, a file NAME.qrs".to_owned(),
        Unread::TooLong => format!("longer than {} MiB, which no diagram is", limit >> 20),
        Unread::Failed(error) => format!("cannot be read: {error}"),
    })
}
