//! What can be wrong with a library, with the sizes that it is asked for, with a file of vectors, and with a converter on
//! trial; and the person or the part that can mend it.
//!
//! Owns the errors of this crate and their words. What a converter itself says of a tuple is a [`Fault`]; who finds an
//! error knows nothing of its text.

use crate::Fault;
use crate::limits::{CONVERTERS_MAX, NAME_BYTES_MAX, TUPLE_BYTES_MAX, VECTORS_BYTES_MAX};
use std::fmt;

/// The person or the part that can mend it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blame {
    /// The author of the converter or its library.
    Author,
    /// The author of the configuration: sizes and parameters.
    Configuration,
    /// The author of the file of vectors.
    Vectors,
}

/// What is wrong. Shown, it is a text in lower case without a trailing stop, which does not name the library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// A library that is not what it says.
    Library(LibraryFault),
    /// A converter does not take tuples of this size.
    Size {
        /// Of the converter.
        converter: String,
        /// Which of the two tuples.
        side: Side,
        /// Bytes that it wants; none if it would take any within the limits.
        wanted: Option<u32>,
        /// Bytes that it would get.
        given: usize,
    },
    /// A line of a file of vectors; line 0 is the file.
    Vectors {
        /// Line of the file, from 1.
        line: usize,
        /// What is wrong with it.
        why: VectorsFault,
    },
    /// The converter refuses to open.
    Refused(Fault),
    /// A vector that is not met.
    Unmet {
        /// Line of the file, from 1.
        line: usize,
        /// The input in hexadecimal.
        input: String,
        /// What came instead.
        got: String,
        /// What the file says.
        expected: String,
    },
    /// A property that does not hold.
    Trial {
        /// Repeats it.
        seed: u32,
        /// What does not hold.
        why: TrialFault,
    },
}

/// Which tuple of a conversion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// What goes in.
    Input,
    /// What comes out.
    Output,
}

/// A struct of a library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Its table.
    Library,
    /// The converter at this index of it.
    Converter(usize),
}

/// What is wrong with a library.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LibraryFault {
    /// Its entry returned nothing.
    Nothing,
    /// A struct has another version of the ABI.
    Version {
        /// Which struct.
        part: Part,
        /// Its version.
        found: u32,
        /// The one that this crate reads.
        ours: u32,
    },
    /// A struct says that it has fewer bytes than one of this version.
    Short {
        /// Which struct.
        part: Part,
        /// Bytes that it says it has.
        bytes: u32,
        /// Bytes that it must have.
        least: usize,
        /// The version that demands it.
        version: u32,
    },
    /// So many converters.
    Count(u32),
    /// There is no array of converters.
    NoArray,
    /// Two converters have this name.
    Twice(String),
    /// The converter at this index is not there.
    Missing(usize),
    /// A converter has no name.
    Nameless(Part),
    /// A name is empty or too long.
    NameLength(Part),
    /// The byte at this place of a name is none that a name may have.
    NameByte(Part, usize),
    /// A converter wants tuples of so many bytes.
    TupleSize {
        /// Of the converter.
        converter: String,
        /// Which of the two tuples.
        side: Side,
        /// Bytes.
        bytes: u32,
    },
    /// The converter of this name has no convert function.
    NoConvert(String),
}

/// What is wrong with a line of a file of vectors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum VectorsFault {
    /// More bytes than a file may have.
    TooLong,
    /// The file has no vectors.
    None,
    /// A vector stands before the size.
    NoSize,
    /// A size stands after a vector.
    LateSize,
    /// A size is no number.
    NotASize,
    /// A size beyond the limits.
    SizeRange,
    /// This word is not `name=number`.
    NotAParam(String),
    /// This word is no number.
    NotANumber(String),
    /// This text is not so many bytes in hexadecimal.
    NotHex(String, usize),
    /// None of what a line can be.
    Unknown,
}

/// What does not hold of a converter on trial. Tuples are shown by their number from 1 and their bytes in hexadecimal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TrialFault {
    /// It wrote before or after its output.
    WroteOutside(usize, String),
    /// An output is not what it must be.
    BadOutput {
        /// Number of the tuple.
        tuple: usize,
        /// The tuple.
        input: String,
        /// What came of it.
        output: String,
        /// What is wrong with that.
        why: Fault,
    },
    /// Opened again it gives something else.
    NotRepeated {
        /// Number of the tuple.
        tuple: usize,
        /// The tuple.
        input: String,
        /// What came of it the second time.
        got: String,
    },
    /// All of so many tuples were refused, the first reason being this.
    NothingTried(usize, String),
}

impl Error {
    /// The person or the part that can mend it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Library(_) | Self::Unmet { .. } | Self::Trial { .. } => Blame::Author,
            Self::Size { .. } | Self::Refused(_) => Blame::Configuration,
            Self::Vectors { .. } => Blame::Vectors,
        }
    }
}

impl From<LibraryFault> for Error {
    fn from(fault: LibraryFault) -> Self {
        Self::Library(fault)
    }
}

impl From<Fault> for Error {
    /// A converter that is opened says nothing else than why it refuses.
    fn from(fault: Fault) -> Self {
        Self::Refused(fault)
    }
}

impl From<Error> for Fault {
    fn from(error: Error) -> Self {
        Self::new(error.to_string())
    }
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Input => "input",
            Self::Output => "output",
        })
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Library => f.write_str("library"),
            Self::Converter(index) => write!(f, "converter {index} of the library"),
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Library(fault) => write!(f, "{fault}"),
            Self::Size {
                converter,
                side,
                wanted: None,
                given,
            } => write!(
                f,
                "converter '{converter}': {side} tuples of {given} bytes, the limit is 1 to {TUPLE_BYTES_MAX}"
            ),
            Self::Size {
                converter,
                side,
                wanted: Some(wanted),
                given,
            } => write!(
                f,
                "converter '{converter}': {side} tuples must have {wanted} bytes, not {given}"
            ),
            Self::Vectors { line, why } => write!(f, "line {line}: {why}"),
            Self::Refused(fault) => write!(f, "{fault}"),
            Self::Unmet {
                line,
                input,
                got,
                expected,
            } => write!(f, "line {line}: {input} gives {got}, not {expected}"),
            Self::Trial { seed, why } => write!(f, "seed {seed}{why}"),
        }
    }
}

impl fmt::Display for LibraryFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => f.write_str("the entry of the library returned no library"),
            Self::Version { part, found, ours } => write!(
                f,
                "{part} has abi version {found}, this trikfs reads version {ours}"
            ),
            Self::Short {
                part,
                bytes,
                least,
                version,
            } => write!(
                f,
                "{part} says that its descriptor has {bytes} bytes, version {version} has {least}"
            ),
            Self::Count(count) => write!(
                f,
                "library has {count} converters, the limit is 1 to {CONVERTERS_MAX}"
            ),
            Self::NoArray => f.write_str("library has no array of converters"),
            Self::Twice(name) => write!(f, "library has two converters named '{name}'"),
            Self::Missing(index) => write!(f, "{} is missing", Part::Converter(*index)),
            Self::Nameless(part) => write!(f, "{part} has no name"),
            Self::NameLength(part) => {
                write!(f, "{part}: its name must have 1 to {NAME_BYTES_MAX} bytes")
            }
            Self::NameByte(part, at) => {
                write!(f, "{part}: byte {at} of its name is not one of a-z 0-9 _")
            }
            Self::TupleSize {
                converter,
                side,
                bytes,
            } => write!(
                f,
                "converter '{converter}' wants {side} tuples of {bytes} bytes, the limit is {TUPLE_BYTES_MAX}"
            ),
            Self::NoConvert(name) => write!(f, "converter '{name}' has no convert function"),
        }
    }
}

impl fmt::Display for VectorsFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLong => write!(f, "more than {VECTORS_BYTES_MAX} bytes"),
            Self::None => f.write_str("no vectors"),
            Self::NoSize => f.write_str("the size must stand before the first vector"),
            Self::LateSize => f.write_str("the size stands before the first vector"),
            Self::NotASize => f.write_str("a size is a number of bytes"),
            Self::SizeRange => write!(f, "a tuple has 1 to {TUPLE_BYTES_MAX} bytes"),
            Self::NotAParam(word) => write!(f, "'{word}' is not name=number"),
            Self::NotANumber(word) => write!(f, "'{word}' is not a number"),
            Self::NotHex(text, size) => {
                write!(f, "'{text}' is not {size} bytes in hexadecimal")
            }
            Self::Unknown => f.write_str("neither params, size nor a vector"),
        }
    }
}

impl fmt::Display for TrialFault {
    /// Follows the seed.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WroteOutside(tuple, input) => {
                write!(f, ", tuple {tuple} ({input}): wrote outside its output")
            }
            Self::BadOutput {
                tuple,
                input,
                output,
                why,
            } => write!(f, ", tuple {tuple} ({input}) gives {output}: {why}"),
            Self::NotRepeated { tuple, input, got } => write!(
                f,
                ", tuple {tuple} ({input}): opened again it gives something else than the first time: {got}; \
                 is a state shared by all openings, or never set?"
            ),
            Self::NothingTried(tuples, reason) => write!(
                f,
                ": all {tuples} tuples were refused, so nothing was tried: {reason}"
            ),
        }
    }
}

impl std::error::Error for Error {}
