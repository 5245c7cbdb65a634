//! Why a bridge cannot be begun, and who can mend it.
//!
//! Owns the errors of this crate. Knows no command.

pub use recorder::error::Blame;

use std::fmt;
use std::net::SocketAddr;

/// What is wrong. Shown, it is a sentence for the person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// Nobody can listen there.
    Address(SocketAddr, String),
    /// The tree cannot be looked at.
    Tree(recorder::error::Error),
    /// There are no more threads.
    Thread(String),
    /// Nothing can be made of what a tree has.
    Message(journal::error::Error),
}

impl Error {
    /// The person or the part that can mend it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Address(..) => Blame::Caller,
            Self::Message(_) => Blame::Machine,
            Self::Tree(why) => why.blame(),
            Self::Thread(_) => Blame::Machine,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Address(address, why) => {
                write!(
                    f,
                    "{address}: {why}; --port and --address choose another one"
                )
            }
            Self::Tree(why) => write!(f, "{why}"),
            Self::Message(why) => write!(f, "what the tree has cannot be passed on: {why}"),
            Self::Thread(why) => write!(f, "a thread: {why}"),
        }
    }
}

impl std::error::Error for Error {}
