//! Why a command or a process of this crate could not do what it should, by who has to act.
//!
//! Owns the kinds of such failures and how they read. What a program gets for an operation on the tree is
//! `errno::Error`; where a failure is printed, and which exit status it has, is known to `cli` alone.

use crate::convert::shared::CacheError;
use crate::limits;
use crate::mount::MountError;
use config::problem::Problem;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// The person or the part that can mend it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blame {
    /// The person at the command line: names something else, or another file.
    Person,
    /// The author of the configuration.
    Configuration,
    /// The author of a converter.
    Converter,
    /// The machine: its kernel, its memory, its limits.
    Machine,
    /// This program.
    Ours,
}

/// Why something could not be done. Shown, it is a text for the person.
#[derive(Debug)]
pub enum Failure {
    /// What was asked for is not possible; the text says what is.
    Refused(String),
    /// A file or directory that was named cannot be taken.
    File {
        /// As it was named.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// A place in the configuration.
    Problem(Problem),
    /// A configuration was written and refused: why, in the words of the tree.
    NotApplied(String),
    /// A converter on trial does not do what it must.
    Converter(String),
    /// The directory for machine code.
    Cache(CacheError),
    /// A mount or its list.
    Mount(MountError),
    /// The system refuses something that was tried.
    System {
        /// What was tried.
        what: String,
        /// What the system says.
        why: String,
    },
    /// The guardian died before its daemon began.
    Orphaned,
    /// The daemon crashed too often; how it did so the last time.
    Crashed(String),
    /// A converter cannot be opened, or a thread that it needs cannot be started.
    Opening(String),
    /// Another process has printed why.
    Reported,
    /// A failure after which something of the person is left in a file.
    Kept {
        /// The failure.
        why: Box<Self>,
        /// Where it is.
        path: PathBuf,
    },
    /// A failure in the course of something, which the text says.
    At(String, Box<Self>),
}

impl Failure {
    /// What is wrong with a file that was named.
    pub fn file(path: &Path, why: impl fmt::Display) -> Self {
        Self::File {
            path: path.to_owned(),
            why: why.to_string(),
        }
    }

    /// What the system says of something that was tried.
    pub fn system(what: impl Into<String>, why: impl fmt::Display) -> Self {
        Self::System {
            what: what.into(),
            why: why.to_string(),
        }
    }

    /// Threads that cannot be started.
    pub fn threads(error: &io::Error) -> Self {
        Self::system("threads cannot be started", error)
    }

    /// The same in the course of something, for example `node motors/M1`.
    pub fn at(self, what: impl Into<String>) -> Self {
        Self::At(what.into(), Box::new(self))
    }

    /// The person or the part that can mend it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Refused(_) | Self::File { .. } => Blame::Person,
            Self::Problem(_) | Self::NotApplied(_) => Blame::Configuration,
            Self::Converter(_) | Self::Opening(_) => Blame::Converter,
            Self::Cache(_) | Self::Mount(_) | Self::System { .. } => Blame::Machine,
            Self::Orphaned | Self::Crashed(_) | Self::Reported => Blame::Ours,
            Self::Kept { why, .. } | Self::At(_, why) => why.blame(),
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(text)
            | Self::NotApplied(text)
            | Self::Converter(text)
            | Self::Opening(text) => f.write_str(text),
            Self::File { path, why } => write!(f, "{}: {why}", path.display()),
            Self::Problem(problem) => write!(f, "{problem}"),
            Self::Cache(error) => write!(f, "{error}"),
            Self::Mount(error) => write!(f, "{error}"),
            Self::System { what, why } => write!(f, "{what}: {why}"),
            Self::Orphaned => f.write_str("the guardian is gone"),
            Self::Crashed(how) => write!(
                f,
                "the daemon crashed {} times within {} seconds, the last time {how}; giving up",
                limits::CRASHES_MAX,
                limits::CRASH_WINDOW_SECONDS
            ),
            Self::Reported => Ok(()),
            Self::Kept { why, path } => write!(f, "{why}\nyour text is in {}", path.display()),
            Self::At(what, why) => write!(f, "{what}: {why}"),
        }
    }
}

impl std::error::Error for Failure {}

impl From<Problem> for Failure {
    fn from(problem: Problem) -> Self {
        Self::Problem(problem)
    }
}

impl From<CacheError> for Failure {
    fn from(error: CacheError) -> Self {
        Self::Cache(error)
    }
}

impl From<MountError> for Failure {
    fn from(error: MountError) -> Self {
        Self::Mount(error)
    }
}
