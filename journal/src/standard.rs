//! Types of ROS 2 (Jazzy) that a recording uses beside those made from formats.
//!
//! Owns their texts and their bytes; the source of both is the package that the name begins with. Here is the log, in `robot`
//! what a robot measures and does.

pub mod robot;

use crate::cdr::{Reader, Writer};
use crate::schema::with_needed;

/// What every message with a header needs.
pub(crate) const HEADER: [(&str, &str); 2] = [
    (
        "std_msgs/Header",
        "builtin_interfaces/Time stamp\nstring frame_id\n",
    ),
    TIME,
];

const TIME: (&str, &str) = ("builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n");

/// The name of the schema of [`Log`].
pub const LOG: &str = "rcl_interfaces/msg/Log";

/// The text of that schema.
pub(crate) fn log_text() -> String {
    let fields = "builtin_interfaces/Time stamp\nuint8 level\nstring name\nstring msg\nstring file\nstring function\nuint32 line\n";
    with_needed(fields, &[TIME])
}

/// How bad a line of a log is, with the numbers of `rcl_interfaces/msg/Log`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// Nothing is wrong.
    Info,
    /// Somebody should look.
    Warn,
    /// Something failed.
    Error,
}

impl Level {
    fn number(self) -> u8 {
        match self {
            Self::Info => 20,
            Self::Warn => 30,
            Self::Error => 40,
        }
    }

    /// That of a number; those of other programs lie between.
    fn of(number: u8) -> Self {
        match number {
            40.. => Self::Error,
            30..40 => Self::Warn,
            0..30 => Self::Info,
        }
    }
}

/// A line of a log, or a failure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Log {
    /// How bad it is.
    pub level: Level,
    /// Whose line it is: the path of a node, or a program.
    pub name: String,
    /// What it says.
    pub text: String,
    /// The errno of a failure, 0 of anything else; the field `line` of the message.
    pub errno: u32,
}

impl Log {
    /// The message.
    pub(crate) fn encode(&self, unix_ns: u64) -> Vec<u8> {
        let mut out = Writer::new();
        stamp(&mut out, unix_ns);
        out.u8(self.level.number());
        out.string(&self.name).string(&self.text);
        out.string("").string("").u32(self.errno);
        out.finish()
    }

    /// A message; None if it is none.
    pub(crate) fn decode(message: &[u8]) -> Option<Self> {
        let mut read = Reader::new(message)?;
        read.i32()?;
        read.u32()?;
        let level = Level::of(read.u8()?);
        let name = read.string()?.to_owned();
        let text = read.string()?.to_owned();
        read.string()?;
        read.string()?;
        let errno = read.u32()?;
        Some(Self {
            level,
            name,
            text,
            errno,
        })
    }
}

/// Seconds and nanoseconds; after 2038 as far as 32 bits go.
pub(crate) fn stamp(out: &mut Writer, unix_ns: u64) {
    let seconds = i32::try_from(unix_ns / 1_000_000_000).unwrap_or(i32::MAX);
    let rest = u32::try_from(unix_ns % 1_000_000_000).unwrap_or(0);
    out.i32(seconds).u32(rest);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_of_a_log_comes_back() {
        let log = Log {
            level: Level::Error,
            name: "sensors/A1".to_owned(),
            text: "device: does not answer".to_owned(),
            errno: 5,
        };
        assert_eq!(
            Log::decode(&log.encode(1_700_000_000_250_000_000)),
            Some(log)
        );
        assert_eq!(Log::decode(&[0, 1, 0, 0, 1]), None);
    }
}
