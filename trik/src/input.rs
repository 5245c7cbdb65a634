//! Files that a person names, read whole and no further than they may be long.
//!
//! Owns what can keep a file from being read. What a person is told of it is said where the file is known.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

/// Why a file was not read.
#[derive(Debug)]
pub(crate) enum Unread {
    /// Nothing is there.
    Missing,
    /// A directory is there.
    Directory,
    /// It has more bytes than it may have.
    TooLong,
    /// What the system says.
    Failed(io::Error),
}

impl From<io::Error> for Unread {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::NotFound {
            Self::Missing
        } else if error.kind() == io::ErrorKind::IsADirectory {
            Self::Directory
        } else {
            Self::Failed(error)
        }
    }
}

/// The bytes of a file, at most so many.
///
/// # Errors
/// It cannot be read, or has more bytes.
pub(crate) fn read(path: &Path, most: u64) -> Result<Vec<u8>, Unread> {
    all_of(File::open(path)?, most)
}

/// The bytes of a stream, at most so many.
///
/// # Errors
/// It cannot be read, or has more bytes.
pub(crate) fn all_of(from: impl Read, most: u64) -> Result<Vec<u8>, Unread> {
    let mut bytes = Vec::new();
    // One more than may be, so that it can be seen.
    from.take(most + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most {
        return Err(Unread::TooLong);
    }
    Ok(bytes)
}
