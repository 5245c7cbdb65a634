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
use lang_text::problem::{Locale, Problem, Words};
use std::path::Path;

/// Why a save cannot be read.
pub(crate) enum Unreadable {
    /// The file itself.
    File(Words),
    /// What is in it.
    Save(Vec<Problem>),
    /// It has no such diagram to run.
    Diagram(Words),
}

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
            Unreadable::Save(problems) => match flow::is_text(path) {
                true => Reporter::of_unread_text(path, locale).lines(&problems),
                false => Reporter::new(path, None, locale).lines(&problems),
            },
        },
        code: UNREADABLE,
    })
}

/// The bytes of a file that is no longer than a save may be.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, Words> {
    let limit = SAVE_BYTES as u64;
    input::read(path, limit).map_err(|unread| why(&unread, limit, A_DIAGRAM))
}
