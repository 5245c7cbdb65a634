//! Character devices: anything that read(2) and write(2) move bytes through.
//!
//! Owns non-blocking reading and writing that waits for room, no longer than its limit. Terminals are set to
//! pass bytes unchanged (no echo, no line editing) when they are opened for reading, as a robot's sensors need.

use super::{Got, Sink, Stream, device_error, is_same_file};
use crate::errno::Error;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::termios;
use std::fs::{File, OpenOptions};
use std::io::{ErrorKind, Read, Write};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A character device open for reading.
pub struct CharDevice {
    file: File,
    path: PathBuf,
}

impl CharDevice {
    /// Opens for reading, without waiting and without making a terminal ours.
    pub fn open(path: &Path) -> Result<Self, Error> {
        let file = OpenOptions::new()
            .read(true)
            .custom_flags(libc::O_NONBLOCK | libc::O_NOCTTY)
            .open(path);
        let file = file.map_err(|error| device_error(path, &error))?;
        if let Ok(mut settings) = termios::tcgetattr(&file) {
            termios::cfmakeraw(&mut settings);
            // A terminal that refuses raw mode still delivers its bytes.
            let _ = termios::tcsetattr(&file, termios::SetArg::TCSANOW, &settings);
        }
        Ok(Self {
            file,
            path: path.to_owned(),
        })
    }
}

impl Stream for CharDevice {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        loop {
            match self.file.read(buf) {
                Ok(0) => return Ok(Got::End),
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

    fn is_still_there(&self) -> bool {
        is_same_file(&self.file, &self.path)
    }
}

/// A character device or FIFO open for writing.
pub struct CharSink {
    file: File,
    path: PathBuf,
    timeout: Duration,
}

impl CharSink {
    /// Opens for writing without waiting; a FIFO that nobody reads is ENODEV.
    pub fn open(path: &Path, timeout_ms: u32) -> Result<Self, Error> {
        let file = OpenOptions::new()
            .write(true)
            .custom_flags(libc::O_NONBLOCK | libc::O_NOCTTY)
            .open(path);
        let file = file.map_err(|error| device_error(path, &error))?;
        let timeout = Duration::from_millis(timeout_ms.into());
        Ok(Self {
            file,
            path: path.to_owned(),
            timeout,
        })
    }
}

impl Sink for CharSink {
    fn write(&mut self, tuple: &[u8], waits: bool) -> Result<(), Error> {
        let deadline = Instant::now() + self.timeout;
        let mut sent = 0;
        while sent < tuple.len() {
            match self.file.write(&tuple[sent..]) {
                Ok(n) => sent += n,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    if !waits && sent == 0 {
                        return Err(Error::WouldBlock);
                    }
                    let left = deadline.saturating_duration_since(Instant::now());
                    if left.is_zero() {
                        let what = format!(
                            "{}: took {sent} of {} bytes in {} ms",
                            self.path.display(),
                            tuple.len(),
                            self.timeout.as_millis()
                        );
                        return Err(Error::TimedOut(what));
                    }
                    let wait = PollTimeout::try_from(left + Duration::from_millis(1))
                        .unwrap_or(PollTimeout::MAX);
                    // Interrupted or not, the loop looks again.
                    let _ = poll(
                        &mut [PollFd::new(self.file.as_fd(), PollFlags::POLLOUT)],
                        wait,
                    );
                }
                Err(error) => return Err(device_error(&self.path, &error)),
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_endless_device_gives_what_is_asked_for() {
        let mut zero = CharDevice::open(Path::new("/dev/zero")).unwrap();
        let mut buf = [7; 5];
        assert_eq!(zero.read(&mut buf), Ok(Got::Bytes(5)));
        assert_eq!(buf, [0; 5]);
        assert!(
            CharSink::open(Path::new("/dev/null"), 10)
                .unwrap()
                .write(&buf, true)
                .is_ok()
        );
    }

    #[test]
    fn a_missing_device_is_named() {
        let Err(Error::NoDevice(text)) =
            CharDevice::open(Path::new("/dev/input/mouse0-is-not-here"))
        else {
            panic!("a missing device was opened");
        };
        assert!(
            text.starts_with("/dev/input/mouse0-is-not-here: "),
            "{text}"
        );
    }
}
