//! Why a text of a configuration, something that it names, or its program cannot be taken; and the person or the part that can mend it.
//!
//! Owns the errors of this crate that have no place yet: `problem` is what becomes of them once file and line are known.
//! What a running converter refuses is a `converter::Fault`. Knows nothing of errno.

use std::fmt;

/// The person or the part that can mend it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blame {
    /// The author of the configuration.
    Configuration,
    /// The machine: its memory.
    Machine,
    /// This crate.
    Ours,
}

/// What is wrong. Shown, it is a reason in lower case without a trailing stop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// A text of the configuration means nothing: a format, the name of an event.
    Text(String),
    /// A file, a library or a model that the configuration names cannot be had, or is none.
    Named(String),
    /// The program failed, in Lua's words.
    Script(String),
    /// There is no memory for a Lua state.
    NoMemory,
    /// The program has left no such converter in this state, though it did so when it was loaded.
    NoConverter {
        /// Path of the node.
        node: String,
        /// What is not there.
        missing: Missing,
    },
    /// Something that does not happen.
    Ours(&'static str),
}

/// What a program has not made this time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Missing {
    /// The node.
    Node,
    /// The converter at the wanted place of the node's chain.
    Converter,
}

impl Error {
    /// The person or the part that can mend it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Text(_) | Self::Named(_) | Self::Script(_) | Self::NoConverter { .. } => {
                Blame::Configuration
            }
            Self::NoMemory => Blame::Machine,
            Self::Ours(_) => Blame::Ours,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Text(text) | Self::Named(text) | Self::Script(text) => f.write_str(text),
            Self::NoMemory => f.write_str("not enough memory for a lua state"),
            Self::NoConverter {
                node,
                missing: Missing::Node,
            } => write!(f, "{node}: the program made no such node this time"),
            Self::NoConverter {
                node,
                missing: Missing::Converter,
            } => write!(
                f,
                "{node}: the program made no lua converter here this time"
            ),
            Self::Ours(text) => f.write_str(text),
        }
    }
}

impl std::error::Error for Error {}
