//! Why a tree cannot be recorded, and who can mend it.
//!
//! Owns the errors of this crate. Knows no command.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// The person or the part that can mend it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blame {
    /// The person who asked: another tree, other patterns, another file.
    Caller,
    /// The machine: its disk, its memory.
    Machine,
}

/// What is wrong. Shown, it is a sentence for the person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// No node of the tree is wanted and sampled.
    Nothing(PathBuf),
    /// A file or directory cannot be used.
    File(PathBuf, journal::error::Error),
    /// The disk took less than all of a recording that was begun.
    Broken(PathBuf, journal::error::Error),
    /// There are no more threads, or one has failed.
    Thread(String),
    /// A pattern or a rate that means nothing.
    Request(String),
    /// The black box is being saved.
    Saving,
    /// There are too many of these.
    TooMany(&'static str),
}

impl Error {
    /// The person or the part that can mend it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Nothing(_)
            | Self::File(..)
            | Self::Request(_)
            | Self::Saving
            | Self::TooMany(_) => Blame::Caller,
            Self::Broken(..) | Self::Thread(_) => Blame::Machine,
        }
    }

    pub(crate) fn io(path: &Path, error: io::Error) -> Self {
        Self::File(path.to_owned(), error.into())
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing(root) => write!(
                f,
                "{}: nothing to record: no node that is wanted is sampled in the background, or the tree is another user's",
                root.display()
            ),
            Self::File(path, why) => write!(f, "{}: {why}", path.display()),
            Self::Broken(path, why) => {
                write!(
                    f,
                    "{}: {why}; trik mend keeps what was written before",
                    path.display()
                )
            }
            Self::Thread(why) => write!(f, "a thread: {why}"),
            Self::Request(why) => f.write_str(why),
            Self::Saving => f.write_str("the black box is being saved already: try again"),
            Self::TooMany(what) => write!(f, "too many {what}"),
        }
    }
}

impl std::error::Error for Error {}
