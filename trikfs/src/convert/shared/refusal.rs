//! What is wrong with a shared library, and with the directory that copies of libraries are in.
//!
//! Owns both errors and their words; code that finds one knows nothing of its text. What a converter of a library says is a
//! `converter::Fault`.

use crate::failure::Blame;
use crate::limits;
use converter::abi;
use converter::error::LibraryFault;
use std::fmt;
use std::path::{Path, PathBuf};

/// Why the directory for machine code cannot be used. The text names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CacheError {
    /// What the system says of it.
    System(PathBuf, String),
    /// It is not a directory.
    NotADirectory(PathBuf),
    /// It belongs to another user.
    Foreign {
        /// Where it is.
        dir: PathBuf,
        /// To whom it belongs.
        owner: u32,
        /// The user that this program runs as.
        user: u32,
    },
    /// Others can write to it, with this mode.
    Writable(PathBuf, u32),
    /// Neither the usual directory can be used nor the other one.
    Both(Box<[Self; 2]>),
}

impl CacheError {
    /// What the system says of a directory.
    pub(crate) fn system(dir: &Path, error: &std::io::Error) -> Self {
        Self::System(dir.to_owned(), error.to_string())
    }
}

impl fmt::Display for CacheError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::System(dir, error) => write!(f, "cache directory {}: {error}", dir.display()),
            Self::NotADirectory(dir) => {
                write!(f, "cache directory {}: not a directory", dir.display())
            }
            Self::Foreign { dir, owner, user } => write!(
                f,
                "cache directory {}: belongs to user {owner}, not to user {user}; choose another one with --cache",
                dir.display()
            ),
            Self::Writable(dir, mode) => write!(
                f,
                "cache directory {}: others can write to it (mode {mode:04o}); make it private with chmod go-w",
                dir.display()
            ),
            Self::Both(both) => write!(f, "{}; {}", both[0], both[1]),
        }
    }
}

impl std::error::Error for CacheError {}

/// Why a library cannot be loaded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LibraryError {
    /// It cannot be copied.
    Cache(CacheError),
    /// Something is wrong with it.
    Library {
        /// Its path, or `inline C`.
        shown: String,
        /// What is wrong.
        why: Wrong,
    },
}

/// What is wrong with a library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Wrong {
    /// There is none.
    Missing,
    /// What the system says of the file.
    Unreadable(String),
    /// It is not a regular file.
    NotAFile,
    /// It has more bytes than a library may have.
    TooLarge,
    /// It is not a shared library for this machine.
    Elf(NotLoadable),
    /// The dynamic linker refuses it, in its own words.
    Linker(String),
    /// The dynamic linker may not map files from where the copy is.
    NoExec(String),
    /// It exports none of the two symbols.
    NoSymbol,
    /// It is not what it says.
    Table(LibraryFault),
    /// It has several converters, with these names, and none was chosen.
    Several(Vec<String>),
    /// It has no converter.
    Empty,
    /// It has not the converter that was chosen.
    NoConverter {
        /// The name that was chosen.
        name: String,
        /// `, did you mean ...`, or nothing.
        hint: String,
        /// The names that there are.
        names: Vec<String>,
    },
    /// What the process that loads it instead of this one says, or what has become of that process, and by whose fault.
    Told(Blame, String),
}

/// Why bytes are not a shared library for this machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NotLoadable {
    /// Another kind of file.
    NotElf,
    /// Its end is missing.
    Cut,
    /// For another processor.
    OtherMachine,
    /// A program or a part of one.
    OtherKind,
}

impl LibraryError {
    /// The person or the part that can mend it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Cache(_) => Blame::Machine,
            Self::Library { why, .. } => match why {
                Wrong::Missing
                | Wrong::Unreadable(_)
                | Wrong::NotAFile
                | Wrong::Several(_)
                | Wrong::NoConverter { .. } => Blame::Configuration,
                Wrong::NoExec(_) => Blame::Machine,
                Wrong::TooLarge
                | Wrong::Elf(_)
                | Wrong::Linker(_)
                | Wrong::NoSymbol
                | Wrong::Table(_)
                | Wrong::Empty => Blame::Converter,
                Wrong::Told(blame, _) => *blame,
            },
        }
    }
}

impl fmt::Display for LibraryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Cache(error) => write!(f, "{error}"),
            Self::Library { shown, why } => write!(f, "{shown}: {why}"),
        }
    }
}

impl std::error::Error for LibraryError {}

impl From<CacheError> for LibraryError {
    fn from(error: CacheError) -> Self {
        Self::Cache(error)
    }
}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("no such library"),
            Self::Unreadable(error) => f.write_str(error),
            Self::NotAFile => f.write_str("not a regular file"),
            Self::TooLarge => write!(f, "larger than {} bytes", limits::LIBRARY_BYTES_MAX),
            Self::Elf(why) => write!(f, "{why}"),
            Self::Linker(text) | Self::Told(_, text) => f.write_str(text),
            Self::NoExec(text) => write!(
                f,
                "{text}; a file system mounted noexec cannot hold the cache, choose another place with --cache"
            ),
            Self::NoSymbol => write!(
                f,
                "exports neither {} nor {}",
                abi::ENTRY_SYMBOL,
                abi::PLAIN_SYMBOL
            ),
            Self::Table(fault) => write!(f, "{fault}"),
            Self::Several(names) => write!(
                f,
                "holds several converters, add #NAME: {}",
                names.join(", ")
            ),
            Self::Empty => f.write_str("holds no converter"),
            Self::NoConverter { name, hint, names } => write!(
                f,
                "has no converter '{name}'{hint}; it holds: {}",
                names.join(", ")
            ),
        }
    }
}

impl From<LibraryFault> for Wrong {
    fn from(fault: LibraryFault) -> Self {
        Self::Table(fault)
    }
}

impl fmt::Display for NotLoadable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotElf => "not a shared library",
            Self::Cut => "not a whole shared library: it was cut short",
            Self::OtherMachine => "a library for another machine",
            Self::OtherKind => {
                "not a shared library, but another kind of object file; build it with -shared"
            }
        })
    }
}
