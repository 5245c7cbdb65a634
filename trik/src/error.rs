//! Why something could not be done, by who has to act.
//!
//! Owns the kinds of errors of this crate and how they read. How a command ends because of one is known to `refusal`.

use std::fmt;
use std::path::{Path, PathBuf};

/// Why something could not be done. Shown, it is a sentence for the person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// What was asked for is not possible: the person asks for something else, and the text says what there is.
    Refused(String),
    /// A file or directory that the person named cannot be taken.
    File {
        /// As it was named.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// This computer does not do what is needed.
    System {
        /// What was tried.
        what: String,
        /// What the system says.
        why: String,
    },
    /// No robot answers there, or the connection to it is lost: the person looks at the network.
    Unreachable(String),
    /// The robot was reached and refuses, or does not say that it has done it: the person looks at the robot.
    Robot(String),
    /// A process that this one started has failed.
    Process(String),
    /// Another process has already said why.
    Reported,
}

impl Error {
    /// What is wrong with a file that was named.
    pub(crate) fn file(path: &Path, why: impl fmt::Display) -> Self {
        Self::File {
            path: path.to_owned(),
            why: why.to_string(),
        }
    }

    /// What the system says of something that was tried.
    pub(crate) fn system(what: impl fmt::Display, why: impl fmt::Display) -> Self {
        Self::System {
            what: what.to_string(),
            why: why.to_string(),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Refused(text)
            | Self::Unreachable(text)
            | Self::Robot(text)
            | Self::Process(text) => f.write_str(text),
            Self::File { path, why } => write!(f, "{}: {why}", path.display()),
            Self::System { what, why } => write!(f, "{what}: {why}"),
            Self::Reported => Ok(()),
        }
    }
}

impl std::error::Error for Error {}
