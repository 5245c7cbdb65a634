//! Named pipes, whose writers come and go.
//!
//! Owns the rule for their ends: readers see one end of file when the last writer has left, and what the next
//! writer sends after that. Opening does not wait for a writer, and no writer yet is not an end.

use super::chardev::CharSink;
use super::{Device, Got, Kind, Patience, Sink, Stream, Surroundings, device_error, is_same_file};
use crate::errno::Error;
use config::description::FifoDescription;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::fs::{FileTypeExt, OpenOptionsExt};
use std::path::{Path, PathBuf};
use std::time::Duration;

impl Kind for FifoDescription {
    fn open(&self, _tuple_size: usize, _around: &Surroundings) -> Result<Device, Error> {
        Ok(Device::Stream(Box::new(Fifo::open(&self.path)?)))
    }

    fn open_sink(&self, around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        Ok(Box::new(CharSink::open(&self.path, around.timeout_ms)?))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(true)
    }
}

/// A FIFO open for reading.
pub struct Fifo {
    file: File,
    path: PathBuf,
    /// The last read found that somebody has it open for writing.
    has_writer: bool,
    /// A read of this opening has found that: the kernel tells of no hang-up of a writer that was there before the opening.
    has_had_writer: bool,
}

impl Fifo {
    /// Opens for reading without waiting for a writer.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let file = OpenOptions::new()
            .read(true)
            .custom_flags(libc::O_NONBLOCK)
            .open(path);
        let file = file.map_err(|error| device_error(path, &error))?;
        let kind = file
            .metadata()
            .map_err(|error| device_error(path, &error))?
            .file_type();
        if !kind.is_fifo() {
            return Err(Error::NoDevice(format!(
                "{} is not a named pipe",
                path.display()
            )));
        }
        Ok(Self {
            file,
            path: path.to_owned(),
            has_writer: false,
            has_had_writer: false,
        })
    }

    /// The kernel reports a hang-up only for a writer that came and left since this opening.
    fn had_a_writer(&self) -> bool {
        if self.has_had_writer {
            return true;
        }
        let mut fds = [PollFd::new(self.file.as_fd(), PollFlags::POLLIN)];
        let asked = poll(&mut fds, PollTimeout::ZERO);
        asked.is_ok()
            && fds[0]
                .revents()
                .is_some_and(|events| events.contains(PollFlags::POLLHUP))
    }
}

impl Stream for Fifo {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        loop {
            let got = self.file.read(buf);
            self.has_writer = !matches!(got, Ok(0));
            self.has_had_writer |= self.has_writer;
            match got {
                Ok(0) if self.had_a_writer() => return Ok(Got::End),
                Ok(0) => return Ok(Got::Nothing),
                Ok(n) => return Ok(Got::Bytes(n)),
                Err(error) if error.kind() == ErrorKind::WouldBlock => return Ok(Got::Nothing),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(device_error(&self.path, &error)),
            }
        }
    }

    fn fd(&self) -> Option<BorrowedFd<'_>> {
        Some(self.file.as_fd())
    }

    fn is_silent(&self, open: Duration, patience: Patience) -> bool {
        let most = if self.has_writer {
            patience.by_somebody
        } else {
            Patience::WITH_NOBODY
        };
        open >= most
    }

    fn is_still_there(&self) -> bool {
        is_same_file(&self.file, &self.path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn the_end_comes_once_a_writer_has_left_and_not_before_one_came() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("in");
        nix::unistd::mkfifo(&path, nix::sys::stat::Mode::S_IRWXU).unwrap();
        let mut fifo = Fifo::open(&path).unwrap();
        let mut buf = [0; 8];
        assert_eq!(fifo.read(&mut buf), Ok(Got::Nothing));
        let mut writer = OpenOptions::new().write(true).open(&path).unwrap();
        assert_eq!(fifo.read(&mut buf), Ok(Got::Nothing));
        writer.write_all(b"ab").unwrap();
        drop(writer);
        assert_eq!(fifo.read(&mut buf), Ok(Got::Bytes(2)));
        assert_eq!(fifo.read(&mut buf), Ok(Got::End));
        assert!(Fifo::open(Path::new("/dev/null")).is_err());
    }

    #[test]
    fn a_writer_that_was_there_before_the_opening_ends_the_file_too() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("in");
        nix::unistd::mkfifo(&path, nix::sys::stat::Mode::S_IRWXU).unwrap();
        let _before = Fifo::open(&path).unwrap();
        let mut writer = OpenOptions::new().write(true).open(&path).unwrap();
        let mut fifo = Fifo::open(&path).unwrap();
        writer.write_all(b"ab").unwrap();
        drop(writer);
        let mut buf = [0; 8];
        assert_eq!(fifo.read(&mut buf), Ok(Got::Bytes(2)));
        assert_eq!(fifo.read(&mut buf), Ok(Got::End));
    }
}
