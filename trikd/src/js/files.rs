//! Texts of programs and of the files that they name.
//!
//! Owns how long such a text may be and why one cannot be read. Knows no engine.

use crate::blame::{Blame, Os};
use crate::limits;
use std::fmt;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Why a text cannot be read.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Unread {
    /// It cannot be opened.
    Unopened(PathBuf, Os),
    /// It fails while it is read.
    Broken(PathBuf, Os),
    /// It is longer than [`limits::JS_FILE_BYTES`].
    TooLong(PathBuf),
    /// It is outside of the folder, and a judge allows nothing else.
    Outside(String),
}

impl Unread {
    /// Who can change something about it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Unopened(..) | Self::TooLong(_) | Self::Outside(_) => Blame::Client,
            Self::Broken(..) => Blame::System,
        }
    }
}

impl fmt::Display for Unread {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unopened(path, os) => write!(out, "{}: cannot be opened: {os}", path.display()),
            Self::Broken(path, os) => write!(out, "{}: cannot be read: {os}", path.display()),
            Self::TooLong(path) => {
                let most = limits::JS_FILE_BYTES >> 20;
                write!(out, "{}: longer than {most} MiB", path.display())
            }
            Self::Outside(file) => {
                write!(
                    out,
                    "{file}: a judged program reads only files of its own folder"
                )
            }
        }
    }
}

impl std::error::Error for Unread {}

/// The text of a program or of a file that it includes.
///
/// # Errors
/// Why it cannot be read, with its place.
pub fn read_text(path: &Path) -> Result<String, Unread> {
    let file = std::fs::File::open(path)
        .map_err(|error| Unread::Unopened(path.to_owned(), error.into()))?;
    let mut bytes = Vec::new();
    file.take(limits::JS_FILE_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(|error| Unread::Broken(path.to_owned(), error.into()))?;
    if bytes.len() as u64 > limits::JS_FILE_BYTES {
        return Err(Unread::TooLong(path.to_owned()));
    }
    // Editors of Windows put a mark in front.
    let text = String::from_utf8_lossy(&bytes);
    Ok(text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned())
}
