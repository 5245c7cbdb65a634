//! FIFOs instead of character devices: one end that is written for readers, and one that takes lines.
//!
//! Nothing here waits: without a reader nothing is sent, and a full FIFO drops the whole piece.

use crate::limits::{FIFO_BYTES, MAX_LINE_BYTES, PHOTO_FIFO_BYTES};
use nix::errno::Errno;
use nix::fcntl::{FcntlArg, fcntl};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::stat::Mode;
use nix::unistd::mkfifo;
use std::fs::File;
use std::io::{self, Read, Write};
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

/// Makes a FIFO and the directories above it.
fn make(path: &Path) -> io::Result<()> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)?;
    }
    match mkfifo(path, Mode::from_bits_truncate(0o644)) {
        Ok(()) | Err(Errno::EEXIST) => Ok(()),
        Err(error) => Err(error.into()),
    }
}

/// Whether somebody reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reader {
    /// Nobody.
    None,
    /// Since this very call.
    New,
    /// As before.
    Same,
}

/// The end that is written.
pub struct Out {
    path: PathBuf,
    file: Option<File>,
    is_there: bool,
    has_reader_left: bool,
    /// What it holds, in bytes.
    size: i32,
    /// Of a large piece, what did not fit yet.
    rest: Vec<u8>,
}

impl Out {
    /// Makes the FIFO.
    pub fn make(path: PathBuf) -> io::Result<Self> {
        make(&path)?;
        Ok(Self {
            path,
            file: None,
            is_there: true,
            has_reader_left: false,
            size: FIFO_BYTES,
            rest: Vec::new(),
        })
    }

    /// One for pieces that are larger than a page.
    pub fn make_large(path: PathBuf) -> io::Result<Self> {
        let mut out = Self::make(path)?;
        out.size = PHOTO_FIFO_BYTES;
        Ok(out)
    }

    /// Makes the FIFO or takes it away, like a device that is plugged in or out.
    pub fn set_there(&mut self, is_there: bool) {
        if is_there && !self.is_there {
            self.is_there = make(&self.path).is_ok();
        } else if !is_there && self.is_there {
            self.file = None;
            let _ = std::fs::remove_file(&self.path);
            self.is_there = false;
        }
    }

    /// A reader has closed it, and another may have come before anybody looked.
    pub fn reader_left(&mut self) {
        self.has_reader_left = true;
    }

    /// Looks for a reader.
    pub fn reader(&mut self) -> Reader {
        let has_left = std::mem::take(&mut self.has_reader_left);
        if self.file.as_ref().is_some_and(|file| !has_lost(file)) {
            return if has_left { Reader::New } else { Reader::Same };
        }
        self.file = None;
        self.rest.clear();
        if !self.is_there {
            return Reader::None;
        }
        let opened = File::options()
            .write(true)
            .custom_flags(libc::O_NONBLOCK | libc::O_NOFOLLOW)
            .open(&self.path);
        let Ok(file) = opened else {
            return Reader::None;
        };
        // A small buffer: a late reader wants new samples, not a long tail of old ones.
        let _ = fcntl(&file, FcntlArg::F_SETPIPE_SZ(self.size));
        self.file = Some(file);
        Reader::New
    }

    /// Sends the piece whole or not at all. The kernel never splits up to 4096 bytes; what did not fit of a larger one
    /// goes before the next.
    pub fn send(&mut self, piece: &[u8]) {
        let rest = std::mem::take(&mut self.rest);
        let left = self.write(&rest);
        if left > 0 {
            self.rest = rest[rest.len() - left..].to_vec();
            return;
        }
        let left = self.write(piece);
        if left < piece.len() {
            self.rest = piece[piece.len() - left..].to_vec();
        }
    }

    /// Writes what fits; how many bytes are left.
    fn write(&mut self, bytes: &[u8]) -> usize {
        let Some(file) = &mut self.file else {
            return 0;
        };
        if bytes.is_empty() {
            return 0;
        }
        match file.write(bytes) {
            Ok(count) => bytes.len() - count,
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => bytes.len(),
            Err(_) => {
                self.file = None;
                0
            }
        }
    }
}

/// Whether the last reader has gone.
fn has_lost(file: &File) -> bool {
    let mut fds = [PollFd::new(file.as_fd(), PollFlags::empty())];
    let _ = poll(&mut fds, PollTimeout::ZERO);
    fds[0]
        .revents()
        .is_some_and(|seen| seen.contains(PollFlags::POLLERR))
}

/// The end that takes lines.
pub struct In {
    path: PathBuf,
    file: File,
    line: Vec<u8>,
    is_damaged: bool,
    left_out: u32,
}

impl In {
    /// Makes the FIFO and opens it so that writers never wait for us and we never see their end.
    pub fn make(path: PathBuf) -> io::Result<Self> {
        make(&path)?;
        let file = File::options()
            .read(true)
            .write(true)
            .custom_flags(libc::O_NONBLOCK | libc::O_NOFOLLOW)
            .open(&path)?;
        Ok(Self {
            path,
            file,
            line: Vec::new(),
            is_damaged: false,
            left_out: 0,
        })
    }

    /// To wait for.
    pub fn fd(&self) -> BorrowedFd<'_> {
        self.file.as_fd()
    }

    /// The lines that have come; those that are too long or not printable are left out.
    pub fn lines(&mut self) -> Vec<String> {
        let mut bytes = [0; 4096];
        let count = self.file.read(&mut bytes).unwrap_or(0);
        let mut lines = Vec::new();
        for &byte in &bytes[..count] {
            match byte {
                b'\n' => {
                    let line = std::mem::take(&mut self.line);
                    let is_fine = !std::mem::take(&mut self.is_damaged);
                    match String::from_utf8(line).ok().filter(|_| is_fine) {
                        Some(line) => lines.push(line),
                        None => self.left_out += 1,
                    }
                }
                b'\r' => {}
                _ if self.line.len() >= MAX_LINE_BYTES || byte < b' ' => self.is_damaged = true,
                _ => self.line.push(byte),
            }
        }
        lines
    }

    /// How many lines were left out since the last call.
    pub fn take_left_out(&mut self) -> u32 {
        std::mem::take(&mut self.left_out)
    }
}

impl Drop for In {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::tempdir;

    #[test]
    fn a_reader_is_noticed_when_it_comes_and_when_it_goes() {
        let scratch = tempdir().unwrap();
        let path = scratch.path().join("device");
        let mut out = Out::make(path.clone()).unwrap();
        assert_eq!(out.reader(), Reader::None);
        let open = || {
            File::options()
                .read(true)
                .custom_flags(libc::O_NONBLOCK)
                .open(&path)
                .unwrap()
        };
        let mut reader = open();
        assert_eq!(out.reader(), Reader::New);
        assert_eq!(out.reader(), Reader::Same);
        out.send(b"sample");
        let mut bytes = [0; 16];
        assert_eq!(reader.read(&mut bytes).unwrap(), 6);
        drop(reader);
        assert_eq!(out.reader(), Reader::None);
        let _again = open();
        assert_eq!(out.reader(), Reader::New);
    }

    #[test]
    fn a_full_fifo_drops_whole_pieces() {
        let scratch = tempdir().unwrap();
        let mut out = Out::make(scratch.path().join("device")).unwrap();
        let mut reader = File::options()
            .read(true)
            .custom_flags(libc::O_NONBLOCK)
            .open(scratch.path().join("device"))
            .unwrap();
        out.reader();
        for number in 0..1000u32 {
            out.send(&[number.to_le_bytes(); 4].concat());
        }
        let mut bytes = Vec::new();
        let _ = reader.read_to_end(&mut bytes);
        assert_eq!(bytes.len(), 4096);
        assert!(bytes.chunks(16).all(|piece| piece[..4] == piece[12..]));
    }

    #[test]
    fn a_large_piece_comes_whole_and_another_does_not_come_between() {
        let scratch = tempdir().unwrap();
        let mut out = Out::make_large(scratch.path().join("device")).unwrap();
        let mut reader = File::options()
            .read(true)
            .custom_flags(libc::O_NONBLOCK)
            .open(scratch.path().join("device"))
            .unwrap();
        out.reader();
        let piece = |number: u8| vec![number; 40_000];
        // 64 KiB take one and a part of the second; the third is dropped.
        for number in 1..=3 {
            out.send(&piece(number));
        }
        let mut bytes = Vec::new();
        let _ = reader.read_to_end(&mut bytes);
        out.send(&piece(4));
        let _ = reader.read_to_end(&mut bytes);
        assert_eq!(bytes, [piece(1), piece(2), piece(4)].concat());
    }

    #[test]
    fn lines_that_cannot_be_are_left_out() {
        let scratch = tempdir().unwrap();
        let mut lines = In::make(scratch.path().join("in")).unwrap();
        let mut writer = File::options()
            .write(true)
            .open(scratch.path().join("in"))
            .unwrap();
        let long = "x".repeat(300);
        write!(writer, "one\r\n{long}\nbad\x07\ntwo\nhal").unwrap();
        assert_eq!(lines.lines(), ["one", "two"]);
        writeln!(writer, "f").unwrap();
        assert_eq!(lines.lines(), ["half"]);
        assert!(lines.lines().is_empty());
    }
}
