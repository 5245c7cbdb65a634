//! What one engine waits for: its bell, and streams of the tree.
//!
//! Owns the open streams and what has been read of them. The tree fills a queue for each, so nothing is missed between
//! two looks.

use super::shared::Slot;
use crate::brick::Brick;
use crate::limits;
use nix::poll::{PollFd, PollFlags, ppoll};
use nix::sys::time::TimeSpec;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, Read};
use std::os::fd::AsFd;
use std::time::{Duration, Instant};

/// One piece of a stream.
#[derive(Clone, Debug, PartialEq)]
pub enum Record {
    /// So many native integers.
    Numbers(Vec<i32>),
    /// A line without its end.
    Line(String),
}

struct Stream {
    path: String,
    /// Integers of one record; 0 for lines.
    numbers: usize,
    /// None when it has ended: it is opened again when somebody asks.
    file: Option<File>,
    partial: Vec<u8>,
}

/// The streams of one engine.
#[derive(Default)]
pub struct Streams {
    streams: RefCell<Vec<Stream>>,
    records: RefCell<VecDeque<(String, Record)>>,
}

impl Stream {
    /// Reads what is there. At the end of the stream it is closed.
    fn read(&mut self, records: &mut VecDeque<(String, Record)>) {
        let mut buffer = [0; limits::VALUE_BYTES];
        while let Some(file) = &mut self.file {
            match file.read(&mut buffer) {
                Ok(0) => self.file = None,
                Ok(size) => self.cut(&buffer[..size], records),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return,
                Err(_) => self.file = None,
            }
        }
    }

    fn cut(&mut self, bytes: &[u8], records: &mut VecDeque<(String, Record)>) {
        let mut push = |record| {
            if records.len() >= limits::JS_EVENTS {
                records.pop_front();
            }
            records.push_back((self.path.clone(), record));
        };
        if self.numbers > 0 {
            self.partial.extend_from_slice(bytes);
            let size = self.numbers * size_of::<i32>();
            let whole = self.partial.len() / size * size;
            for record in self.partial[..whole].chunks_exact(size) {
                let number = |bytes: &[u8]| bytes.try_into().map_or(0, i32::from_ne_bytes);
                push(Record::Numbers(
                    record.chunks_exact(4).map(number).collect(),
                ));
            }
            self.partial.drain(..whole);
            return;
        }
        for &byte in bytes {
            // Lines are filled up with zero bytes to the length of a record.
            if byte != b'\n' && byte != 0 {
                if self.partial.len() < limits::VALUE_BYTES {
                    self.partial.push(byte);
                }
            } else if !self.partial.is_empty() {
                push(Record::Line(
                    String::from_utf8_lossy(&self.partial).into_owned(),
                ));
                self.partial.clear();
            }
        }
    }
}

impl Streams {
    /// Opens a stream, if it is not open, for records of so many integers, or of one line with 0.
    ///
    /// # Errors
    /// Those of the tree.
    pub fn listen(&self, brick: &Brick, path: &str, numbers: usize) -> io::Result<()> {
        let mut streams = self.streams.borrow_mut();
        if let Some(known) = streams.iter_mut().find(|known| known.path == path) {
            if known.file.is_none() {
                known.partial.clear();
                known.file = Some(brick.stream(path)?);
            }
            return Ok(());
        }
        streams.push(Stream {
            path: path.to_owned(),
            numbers,
            file: Some(brick.stream(path)?),
            partial: Vec::new(),
        });
        Ok(())
    }

    /// Closes a stream; what has come is forgotten.
    pub fn forget(&self, path: &str) {
        self.streams
            .borrow_mut()
            .retain(|stream| stream.path != path);
        self.records.borrow_mut().retain(|(other, _)| other != path);
    }

    /// All that has come from one stream, without waiting.
    pub fn drain(&self, path: &str) -> Vec<Record> {
        let mut records = self.records.borrow_mut();
        if let Some(stream) = self
            .streams
            .borrow_mut()
            .iter_mut()
            .find(|stream| stream.path == path)
        {
            stream.read(&mut records);
        }
        let mut drained = Vec::new();
        records.retain(|(other, record)| {
            let other = other != path;
            if !other {
                drained.push(record.clone());
            }
            other
        });
        drained
    }

    /// The oldest record of any stream.
    pub fn next(&self) -> Option<(String, Record)> {
        self.records.borrow_mut().pop_front()
    }

    /// Waits until the bell rings or a stream has something, at most until then, or for ever. Returns whether there is
    /// a reason to look.
    ///
    /// # Errors
    /// Those of ppoll(2).
    pub fn wait(&self, slot: &Slot, until: Option<Instant>) -> io::Result<bool> {
        let mut streams = self.streams.borrow_mut();
        let mut open: Vec<_> = streams
            .iter_mut()
            .filter(|stream| stream.file.is_some())
            .collect();
        let left = until.map(|until| until.saturating_duration_since(Instant::now()));
        let ready: Vec<bool> = {
            let files = open.iter().filter_map(|stream| stream.file.as_ref());
            let mut awaited = vec![PollFd::new(slot.bell.fd(), PollFlags::POLLIN)];
            awaited.extend(files.map(|file| PollFd::new(file.as_fd(), PollFlags::POLLIN)));
            let left =
                left.map(|left| TimeSpec::from_duration(left.min(Duration::from_secs(1 << 20))));
            match ppoll(&mut awaited, left, None) {
                Ok(0) => return Ok(false),
                Ok(_) | Err(nix::errno::Errno::EINTR) => {}
                Err(error) => return Err(error.into()),
            }
            let is_ready = |fd: &PollFd<'_>| fd.any().unwrap_or(true);
            awaited.iter().map(is_ready).collect()
        };
        if ready[0] {
            slot.bell.hush();
        }
        let mut records = self.records.borrow_mut();
        for (stream, _) in open
            .iter_mut()
            .zip(&ready[1..])
            .filter(|(_, ready)| **ready)
        {
            stream.read(&mut records);
        }
        Ok(true)
    }
}
