//! What all failures share: who can change something about them, and what the system said.
//!
//! Knows no failure of ours.

use lang_text::problem::of_system;
use std::fmt;
use std::io;

/// Who can change something about a failure.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Blame {
    /// The person who starts trikd, or asks it on its machine.
    Operator,
    /// A client: what it asks for cannot be done.
    Client,
    /// The mounted tree, or its mount.
    Tree,
    /// The machine: its kernel, its disk, its memory.
    System,
    /// trikd itself.
    Trikd,
}

/// A failure of the system. Unlike [`io::Error`] it can be kept, compared and told to several.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Os {
    /// Its kind.
    pub kind: io::ErrorKind,
    /// Its number, if it is one of the kernel.
    pub errno: Option<i32>,
    text: String,
}

impl From<io::Error> for Os {
    fn from(error: io::Error) -> Self {
        Self {
            kind: error.kind(),
            errno: error.raw_os_error(),
            text: error.to_string(),
        }
    }
}

impl From<nix::Error> for Os {
    fn from(error: nix::Error) -> Self {
        Self {
            kind: io::Error::from(error).kind(),
            errno: Some(error as i32),
            text: error.to_string(),
        }
    }
}

impl Os {
    /// What the system said, in Russian as far as that is known.
    pub fn russian(&self) -> String {
        of_system(&self.text)
    }
}

impl fmt::Display for Os {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.text)
    }
}
