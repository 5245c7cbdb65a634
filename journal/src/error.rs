//! Why a recording cannot be written or read, and who can mend it.
//!
//! Owns the errors of this crate. Knows no command.

use std::fmt;
use std::io;

/// The person or the part that can mend it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blame {
    /// The file, and the person who brings it.
    File,
    /// The machine: its disk.
    Machine,
    /// The caller of this crate.
    Caller,
}

/// What is wrong. Shown, it is a reason in lower case without a trailing stop.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// The system says no.
    Io(String),
    /// It says so of the file that is made of another one.
    Output(String),
    /// The file is no MCAP.
    NotARecording,
    /// The file ends before its end: its recorder was killed, or the disk was full.
    Cut,
    /// The file contradicts itself.
    Damaged(String),
    /// Something in the file is larger than a reader takes.
    TooLarge {
        /// What it is.
        what: &'static str,
        /// Its size.
        bytes: u64,
        /// What is taken.
        most: u64,
    },
    /// The text of a `format` means nothing.
    Format(String),
    /// A tuple that is not as the `format` of its node says.
    Tuple {
        /// Path of the node.
        node: String,
        /// Its bytes.
        bytes: usize,
        /// Those of the format.
        wanted: usize,
    },
    /// There is nothing of this name.
    Absent(String),
    /// More than a recording can hold.
    TooMany(&'static str),
}

impl Error {
    /// The person or the part that can mend it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Io(_) | Self::Output(_) => Blame::Machine,
            Self::NotARecording | Self::Cut | Self::Damaged(_) | Self::TooLarge { .. } => {
                Blame::File
            }
            Self::Format(_) | Self::Tuple { .. } | Self::Absent(_) | Self::TooMany(_) => {
                Blame::Caller
            }
        }
    }

    /// The same of the file that is made, where there is another one that is read.
    pub(crate) fn of_output(self) -> Self {
        if let Self::Io(why) = self {
            return Self::Output(why);
        }
        self
    }

    /// The same with the place of the part of the file that is damaged.
    pub(crate) fn in_part(self, at: u64) -> Self {
        if let Self::Damaged(why) = self {
            return Self::Damaged(format!("{why}, in the part at byte {at}"));
        }
        self
    }

    /// What the library for the container says while a file is read.
    pub(crate) fn reading(error: mcap::McapError) -> Self {
        use mcap::McapError as E;
        #[allow(
            clippy::wildcard_enum_match_arm,
            reason = "their errors: all that are not named here are damage, with their words"
        )]
        match error {
            // Without a number of the system it is what the decompressor says.
            E::Io(error) if error.raw_os_error().is_some() => Self::from(error),
            E::Io(error) if error.kind() != io::ErrorKind::UnexpectedEof => {
                Self::Damaged(error.to_string())
            }
            E::Io(_) | E::UnexpectedEof | E::UnexpectedEoc => Self::Cut,
            E::BadMagic => Self::NotARecording,
            other => Self::Damaged(other.to_string()),
        }
    }

    /// What it says while one is written.
    pub(crate) fn writing(error: mcap::McapError) -> Self {
        use mcap::McapError as E;
        #[allow(
            clippy::wildcard_enum_match_arm,
            reason = "their errors: a writer can meet the disk and these limits"
        )]
        match error {
            E::Io(error) => Self::from(error),
            E::TooManyChannels => Self::TooMany("channels"),
            E::TooManySchemas => Self::TooMany("schemas"),
            other => Self::Io(other.to_string()),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(why) | Self::Output(why) | Self::Format(why) => f.write_str(why),
            Self::NotARecording => f.write_str("no recording: it does not begin as MCAP files do"),
            Self::Cut => f.write_str(
                "the recording is cut: its recorder did not finish it; `trik mend` makes it whole",
            ),
            Self::Damaged(why) => write!(
                f,
                "the recording is damaged: {why}; `trik mend` with `-o NEW.mcap` keeps what is whole"
            ),
            Self::TooLarge { what, bytes, most } => {
                write!(f, "{what} has {bytes} bytes, at most {most} are read")
            }
            Self::Tuple {
                node,
                bytes,
                wanted,
            } => write!(
                f,
                "{node}: a tuple of {bytes} bytes, its format has {wanted}"
            ),
            Self::Absent(what) => write!(f, "the recording has no {what}"),
            Self::TooMany(what) => write!(f, "too many {what} for one recording"),
        }
    }
}

impl std::error::Error for Error {}

impl From<io::Error> for Error {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::UnexpectedEof {
            return Self::Cut;
        }
        Self::Io(error.to_string())
    }
}
