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
    /// A class or a robot whose name cannot be part of a topic.
    Name(String),
    /// This program was built without TLS.
    NoTls,
    /// There are no more threads.
    Thread(String),
    /// Nothing can be made of what a tree has.
    Message(journal::error::Error),
}

impl Error {
    /// The person or the part that can mend it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Address(..) | Self::Name(_) | Self::NoTls => Blame::Caller,
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
            Self::Name(name) => write!(
                f,
                "'{}' cannot be part of a topic: a name has 1 to {} bytes, and none of / * # + ? $",
                name.escape_debug(),
                crate::limits::TOPIC_PART_BYTES_MAX
            ),
            Self::NoTls => f.write_str(
                "this trik was built without TLS: cargo build --release -p trik --features mqtt-tls",
            ),
            Self::Tree(why) => write!(f, "{why}"),
            Self::Message(why) => write!(f, "what the tree has cannot be passed on: {why}"),
            Self::Thread(why) => write!(f, "a thread: {why}"),
        }
    }
}

impl std::error::Error for Error {}
