//! Why something of the queue is not done, and who can mend it.
//!
//! Owns the errors of this crate. Knows no command.

use crate::limits;
use std::fmt;

/// The person or the part that can mend it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blame {
    /// The person who has handed it in, or has asked.
    Caller,
    /// The server, or the way to it.
    Server,
    /// This computer.
    Machine,
}

/// What is wrong. Shown, it is a sentence for the person.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// No server is reached, or it does not let us in.
    Reach(String, String),
    /// The server has no JetStream, or not the rights for it.
    Streams(String),
    /// A stream or a consumer of this name is there that was not made by this program.
    Foreign(&'static str),
    /// The server does not answer, or refuses: what was asked, and what it says.
    Asked(&'static str, String),
    /// A header that a submission must have is missing.
    NoHeader(&'static str),
    /// A header that clients cannot read.
    Unreadable,
    /// A message under a subject that is not that of what is in it.
    Place,
    /// What stands under the subject of a result is none.
    NoResult,
    /// A task or a name of a file that cannot be one.
    Name(String),
    /// More bytes than a submission may have: these, of so many.
    TooLarge(usize, usize),
    /// There are no threads or no memory.
    Machine(String),
}

impl Error {
    /// What was asked of the server, and what it says.
    pub(crate) fn asked(what: &'static str, why: impl fmt::Display) -> Self {
        Self::Asked(what, why.to_string())
    }

    /// The person or the part that can mend it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::NoHeader(_)
            | Self::Unreadable
            | Self::Place
            | Self::Name(_)
            | Self::TooLarge(..) => Blame::Caller,
            Self::Reach(..)
            | Self::Streams(_)
            | Self::Foreign(_)
            | Self::NoResult
            | Self::Asked(..) => Blame::Server,
            Self::Machine(_) => Blame::Machine,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Reach(server, why) => write!(
                f,
                "no NATS server is reached at {server}: {why}; --server names another one"
            ),
            Self::Streams(why) => write!(
                f,
                "the server keeps no streams: {why}; start it with JetStream (nats-server --jetstream --store_dir DIR)"
            ),
            Self::Foreign(name) => write!(
                f,
                "the server has a stream or consumer {name} that was made in another way, so submissions could be lost or judged twice: \
                 delete it, or use another server"
            ),
            Self::Asked(what, why) => write!(f, "{what}: the server says: {why}"),
            Self::NoHeader(name) => write!(f, "the submission has no header {name}"),
            Self::Unreadable => f.write_str("the message has a header that no client can read"),
            Self::Place => {
                f.write_str("the subject of the message does not end with the id of what is in it")
            }
            Self::NoResult => f.write_str(
                "what the server keeps as its result is none: somebody else has published it",
            ),
            Self::Name(name) => write!(
                f,
                "'{}' is no name: it has 1 to {} bytes, no / and no control characters, and does not begin with a dot",
                name.escape_debug()
                    .take(limits::NAME_BYTES_MAX)
                    .collect::<String>(),
                limits::NAME_BYTES_MAX
            ),
            Self::TooLarge(bytes, most) => write!(
                f,
                "the submission has {bytes} bytes, and {most} are the most that is taken"
            ),
            Self::Machine(why) => f.write_str(why),
        }
    }
}

impl std::error::Error for Error {}
