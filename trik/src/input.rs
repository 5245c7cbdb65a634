//! Files that a person names, read whole and no further than they may be long.
//!
//! Owns what can keep a file from being read. What a person is told of it is said where the file is known.

pub(crate) mod secret;
pub(crate) mod words;

use crate::limits;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::fs::File;
use std::io::{self, Read};
use std::os::fd::AsFd;
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::Path;
use std::time::{Duration, Instant};

/// Why a file was not read.
#[derive(Debug)]
pub(crate) enum Unread {
    /// Nothing is there.
    Missing,
    /// A directory is there.
    Directory,
    /// It has more bytes than it may have.
    TooLong,
    /// It is a FIFO or a device that gives nothing.
    Silent,
    /// What the system says.
    Failed(io::Error),
}

impl From<io::Error> for Unread {
    fn from(error: io::Error) -> Self {
        if error.kind() == io::ErrorKind::NotFound {
            Self::Missing
        } else if error.kind() == io::ErrorKind::IsADirectory {
            Self::Directory
        } else if error.kind() == io::ErrorKind::TimedOut {
            Self::Silent
        } else {
            Self::Failed(error)
        }
    }
}

/// The bytes of a file, at most so many. A FIFO or a device that says nothing for a while is given up.
///
/// # Errors
/// It cannot be read, or has more bytes.
pub(crate) fn read(path: &Path, most: u64) -> Result<Vec<u8>, Unread> {
    // An open of a FIFO would wait for somebody who writes into it, perhaps for ever.
    let mut options = File::options();
    let file = options
        .read(true)
        .custom_flags(libc::O_NONBLOCK | libc::O_CLOEXEC)
        .open(path)?;
    let kind = file.metadata()?.file_type();
    match kind.is_fifo() || kind.is_char_device() {
        true => {
            let until = Instant::now() + Duration::from_millis(limits::INPUT_MS.into());
            all_of(Patient { file, until }, most)
        }
        false => all_of(file, most),
    }
}

/// What waits for a file that may have nothing yet, but not for ever.
struct Patient {
    file: File,
    /// When even one that says a little now and then is given up.
    until: Instant,
}

impl Read for Patient {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let mut ready = [PollFd::new(self.file.as_fd(), PollFlags::POLLIN)];
        let wait = PollTimeout::from(limits::INPUT_SILENCE_MS);
        match poll(&mut ready, wait)? {
            0 => Err(io::ErrorKind::TimedOut.into()),
            _ if Instant::now() > self.until => Err(io::ErrorKind::TimedOut.into()),
            _ => self.file.read(into),
        }
    }
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
