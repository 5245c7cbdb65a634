//! The layers of the sandbox that a kernel may not give.
//!
//! Owns their names. What is always there (limits of memory, time, processes and files, and that programs with rights of
//! their own get none) is no layer.

use crate::error::Error;
use std::path::PathBuf;

/// A layer that may be missing.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum Layer {
    /// Another user than the judge's, or at least a namespace of users.
    User,
    /// A namespace of processes: the judge is nowhere, and all end with the first.
    Processes,
    /// A namespace of mounts: a `/proc` and a scratch folder of its own.
    Mounts,
    /// A namespace of networks, which has none.
    Network,
    /// A namespace of messages and shared memory.
    Messages,
    /// A filter of system calls.
    Calls,
    /// Rules of which files may be read and written.
    Files,
}

impl Layer {
    /// All of them.
    pub const ALL: [Self; 7] = [
        Self::User,
        Self::Processes,
        Self::Mounts,
        Self::Network,
        Self::Messages,
        Self::Calls,
        Self::Files,
    ];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::User => "user",
            Self::Processes => "processes",
            Self::Mounts => "mounts",
            Self::Network => "network",
            Self::Messages => "messages",
            Self::Calls => "calls",
            Self::Files => "files",
        }
    }
}

/// What a computer does not give.
#[derive(Clone, Debug, Default)]
pub(crate) struct Missing {
    /// The layers that are not there, or not whole.
    pub layers: Vec<Layer>,
    /// Where that of mounts lacks something.
    pub place: Option<PathBuf>,
}

/// The layer of a name.
pub(super) fn find(name: &str) -> Option<Layer> {
    Layer::ALL.into_iter().find(|layer| layer.name() == name)
}

/// The layer of a name, as an option has it.
pub(crate) fn named(name: &str) -> Result<Layer, Error> {
    find(name).ok_or_else(|| {
        let names = Layer::ALL.map(Layer::name).join(", ");
        Error::Refused(format!("there are {names}"))
    })
}
