//! A save on its way from its file to crate `lang-diagram`.
//!
//! Owns which files are read, and what is said of one that cannot be.

use super::report::Reporter;
use super::{flow, words};
use crate::input;
use crate::input::words::{A_DIAGRAM, why};
use crate::refusal::{Refusal, UNREADABLE};
use crate::terminal::named;
use lang_diagram::limits::SAVE_BYTES;
use lang_diagram::read::{self, Opened};
use lang_text::problem::{Locale, Words};
use std::path::Path;
use studio::lint::unread;
pub(crate) use studio::program::Unreadable;

/// Reads a save.
pub(crate) fn open(path: &Path) -> Result<Opened, Unreadable> {
    let bytes = bytes(path).map_err(Unreadable::File)?;
    read::read(&bytes).map_err(Unreadable::Save)
}

/// Reads a save, of which nothing else can be said if it cannot be read; a data-flow program as text is none.
pub(crate) fn must_open(path: &Path, locale: Locale) -> Result<Opened, Refusal> {
    let opened = match flow::is_text(path) {
        true => Err(Unreadable::File(words::only_saves())),
        false => open(path),
    };
    must(opened, path, locale)
}

/// What was read, or why nothing else can be said of the file.
pub(crate) fn must<T>(
    read: Result<T, Unreadable>,
    path: &Path,
    locale: Locale,
) -> Result<T, Refusal> {
    read.map_err(|why| Refusal {
        lines: match why {
            Unreadable::File(why) | Unreadable::Diagram(why) => {
                vec![format!("trik: {}: {}", named(path), why.in_locale(locale))]
            }
            Unreadable::Save(problems) => Reporter::of(path, unread(path), locale).lines(&problems),
        },
        code: UNREADABLE,
    })
}

/// The bytes of a file that is no longer than a save may be.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, Words> {
    let limit = SAVE_BYTES as u64;
    input::read(path, limit).map_err(|unread| why(&unread, limit, A_DIAGRAM))
}
