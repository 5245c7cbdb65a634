//! Why the page is not served or does not do something, and who can mend it.
//!
//! Owns the errors of this crate. Knows no command.

use crate::guests::NotPaired;
use crate::limits::MISTAKES_MAX;
use lang_text::problem::{Locale, Problem, Words};
use std::fmt;
use std::io;
use std::net::SocketAddr;

/// The person or the part that can mend it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blame {
    /// The person who asked: another address, another order.
    Caller,
    /// The machine.
    Machine,
}

/// What is being done already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Busy {
    /// Values for actuators wait.
    Values,
    /// Requests to the control port wait.
    Requests,
    /// Uploads wait for the robot.
    Uploads,
    /// Files are read or changed.
    Files,
    /// Worlds are read.
    Worlds,
    /// A configuration is tried.
    Configuration,
}

impl Busy {
    fn sentence(self) -> &'static str {
        match self {
            Self::Values => "too many orders wait: the robot does not answer",
            Self::Requests => "the robot does not take programs now",
            Self::Uploads => "other uploads wait for the robot: try again",
            Self::Files => "other files are being read or changed: try again",
            Self::Worlds => "other worlds are being read: try again",
            Self::Configuration => "another configuration is tried: wait for it",
        }
    }
}

/// What is wrong. Shown, it is a sentence for the person.
#[derive(Debug)]
pub enum Error {
    /// Nobody can listen there.
    Address(SocketAddr, io::Error),
    /// There are no more threads.
    Thread(io::Error),
    /// The text is no path of a node.
    Path(String),
    /// The file of the tree says no.
    File(String, io::Error),
    /// The words are no order.
    Words(String),
    /// A request of so many bytes; at most so many are taken.
    Long(usize, usize),
    /// There is no world to be ordered: the robot is a real one.
    NoWorld,
    /// No recording is played.
    NoPlayback,
    /// The world or the player says no.
    World(Words),
    /// Somebody else is in control.
    Taken(String),
    /// This computer may look only.
    Unpaired,
    /// A pairing code was of no use.
    Pairing(NotPaired),
    /// The robot's control port cannot be reached.
    Robot(String),
    /// It is not done now.
    Busy(Busy),
    /// The name is none of a program.
    Name(String),
    /// No program can have this name, or be in this folder.
    NewName(String),
    /// Programs are on another machine.
    NoFolder,
    /// A diagram that cannot be drawn.
    Diagram(String),
    /// A block of a diagram does not take this value.
    Change(String),
    /// A file of so many bytes is no text for an editor; at most so many are shown.
    Large(String, u64, usize),
    /// The file is no text in UTF-8.
    Text(String),
    /// The configuration may not be replaced from here.
    Fixed,
    /// The filesystem refuses the configuration, and why.
    Configuration(String),
}

impl Error {
    /// A program cannot be drawn: the first of its mistakes.
    pub(crate) fn undrawn(name: &str, problems: &[Problem], locale: Locale) -> Self {
        let lines = problems.iter().take(MISTAKES_MAX);
        let lines: Vec<_> = lines.map(|problem| problem.in_locale(locale)).collect();
        Self::Diagram(format!("{name}: {}", lines.join("; ")))
    }

    /// The person or the part that can mend it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Address(..)
            | Self::Path(_)
            | Self::File(..)
            | Self::Words(_)
            | Self::Long(..)
            | Self::NoWorld
            | Self::NoPlayback
            | Self::World(_)
            | Self::Taken(_)
            | Self::Unpaired
            | Self::Pairing(NotPaired::Code)
            | Self::Name(_)
            | Self::NewName(_)
            | Self::NoFolder
            | Self::Diagram(_)
            | Self::Change(_)
            | Self::Large(..)
            | Self::Text(_)
            | Self::Fixed
            | Self::Configuration(_) => Blame::Caller,
            Self::Thread(_)
            | Self::Robot(_)
            | Self::Busy(_)
            | Self::Pairing(NotPaired::Robot(_)) => Blame::Machine,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Address(address, why) => write!(f, "the page at {address}: {why}"),
            Self::Thread(why) => write!(f, "a thread for the page: {why}"),
            Self::Path(path) => write!(f, "'{path}' is no actuator of this robot"),
            Self::File(path, why) => write!(f, "{path}: {}", plain(why)),
            Self::Words(words) => write!(f, "'{words}' is no order"),
            Self::Long(bytes, most) => {
                write!(f, "a request of {bytes} bytes: at most {most} are taken")
            }
            Self::NoWorld => f.write_str("a real robot has no world that takes orders"),
            Self::NoPlayback => f.write_str("no recording is played here"),
            Self::World(why) => f.write_str(&why.english),
            Self::Robot(why)
            | Self::Diagram(why)
            | Self::Change(why)
            | Self::Configuration(why) => f.write_str(why),
            Self::Busy(what) => f.write_str(what.sentence()),
            Self::Large(name, bytes, most) => {
                write!(f, "{name} has {bytes} bytes: at most {most} can be edited here")
            }
            Self::Text(name) => write!(f, "{name} is no text in UTF-8"),
            Self::Fixed => f.write_str(
                "the configuration cannot be replaced from this page; on a robot trikd --page-configures allows it",
            ),
            Self::Taken(who) => write!(f, "{who} is in control; take control first"),
            Self::Unpaired => f.write_str(
                "this computer may only look: press Enter on the robot within 30 s to pair it, and try again, or type its pairing code",
            ),
            Self::Pairing(NotPaired::Code) => f.write_str(
                "this is no pairing code of the robot, or no longer: get a new one there by `trikd pair --code`",
            ),
            Self::Pairing(NotPaired::Robot(why)) => {
                write!(f, "the code is right, but the robot cannot pair: {why}")
            }
            Self::Name(name) => write!(f, "there is no program '{name}'"),
            Self::NewName(name) => write!(
                f,
                "'{name}' is no name for a program: it is too long, it has a colon, a backslash or control characters, a part of it is empty or begins with a dot, or its folder is not there"
            ),
            Self::NoFolder => f.write_str("the programs of this robot are on another machine"),
        }
    }
}

/// What the system says, without the number.
pub(crate) fn plain(error: &io::Error) -> String {
    let text = error.to_string();
    text.split(" (os error")
        .next()
        .unwrap_or_default()
        .to_owned()
}

impl std::error::Error for Error {}
