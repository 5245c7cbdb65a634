//! A subscriber's end of a ring.
//!
//! Owns one mapping that cannot be written. A reader that is too slow loses events and is told how many; the publisher
//! never hears of it. What the file says is checked before it is believed, and every event after it was copied.

use crate::layout::{self, HEADER_BYTES, Layout};
use crate::limits;
use crate::map::Map;
use crate::place;
pub use crate::ring::Event;
use crate::ring::{self, Memory as _};
use nix::time::{ClockId, clock_gettime};
use std::fs::File;
use std::io;
use std::os::unix::fs::{FileExt, MetadataExt};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// What comes next for a reader that wants all events.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// The next event; its bytes have been copied.
    Event(Event),
    /// Nothing yet.
    Nothing,
    /// So many events were overwritten before they were read; the next call goes on with the oldest that is left.
    Missed(u32),
}

/// One node's events.
#[derive(Debug)]
pub struct Reader {
    path: PathBuf,
    /// Device and number of the file.
    file: (u64, u64),
    map: Map,
    layout: Layout,
    /// The last event that [`Reader::next_event`] gave.
    last: u32,
    /// The node's `value`, open so that the node is sampled; it is never read.
    _value: Option<File>,
}

/// Opens the file of a node that says that its samples are needed. A tree that does not answer samples nothing.
fn value_of(mountpoint: &Path, node: &str) -> Option<File> {
    let node = mountpoint.join(node);
    // An attribute is a file itself.
    let files = [node.join("value"), node];
    files.iter().find_map(|file| File::open(file).ok())
}

/// The folder of a tree's rings, if it belongs to the owner of the tree.
fn directory_of(mountpoint: &Path) -> io::Result<PathBuf> {
    let directory = place::directory(Path::new(place::SHARED_MEMORY), mountpoint)?;
    let owner = std::fs::symlink_metadata(&directory)?.uid();
    if owner == std::fs::metadata(mountpoint)?.uid() {
        return Ok(directory);
    }
    Err(io::Error::new(
        io::ErrorKind::PermissionDenied,
        format!(
            "{} is not of the owner of {}",
            directory.display(),
            mountpoint.display()
        ),
    ))
}

impl Reader {
    /// Opens the ring of a node of a mounted tree, both by their paths.
    ///
    /// # Errors
    /// `NotFound`: the node is not sampled in the background, or the tree is without a sample bus. `PermissionDenied`:
    /// the tree is another user's and not open to others, or the ring is not of the tree's owner.
    pub fn open(mountpoint: &Path, node: &str) -> io::Result<Self> {
        let mountpoint = mountpoint.canonicalize()?;
        let file = directory_of(&mountpoint)?.join(place::file_name(node)?);
        // First, so that what the ring has is new.
        let value = value_of(&mountpoint, node);
        Ok(Self {
            _value: value,
            ..Self::open_file(&file)?
        })
    }

    /// As [`Reader::open`] without a need for samples: there are those that others need.
    ///
    /// # Errors
    /// As of [`Reader::open`].
    pub fn open_beside(mountpoint: &Path, node: &str) -> io::Result<Self> {
        let mountpoint = mountpoint.canonicalize()?;
        let file = directory_of(&mountpoint)?.join(place::file_name(node)?);
        Self::open_file(&file)
    }

    /// Opens the ring of what is written to an actuator: each tuple that has gone to its device, those that bring it to rest
    /// too, as a program writes it.
    ///
    /// # Errors
    /// As of [`Reader::open`]; `NotFound` for a node without `rest`.
    pub fn open_written(mountpoint: &Path, node: &str) -> io::Result<Self> {
        let mountpoint = mountpoint.canonicalize()?;
        let file = directory_of(&mountpoint)?.join(place::written_file_name(node)?);
        Self::open_file(&file)
    }

    /// Opens the ring of what the source of a node gave, before it was converted, with the failures of the source. It says
    /// nothing of a need for samples: open the node's own ring too.
    ///
    /// # Errors
    /// As of [`Reader::open`]; `NotFound` for a node that does not publish it.
    pub fn open_raw(mountpoint: &Path, node: &str) -> io::Result<Self> {
        let mountpoint = mountpoint.canonicalize()?;
        let file = directory_of(&mountpoint)?.join(place::raw_file_name(node)?);
        Self::open_file(&file)
    }

    /// Opens a ring by the path of its file. The file's owner must be trusted not to shorten it. Nothing tells the daemon that
    /// somebody needs the samples.
    ///
    /// # Errors
    /// The file cannot be opened, or is no ring.
    pub fn open_file(path: &Path) -> io::Result<Self> {
        let file = File::open(path)?;
        let meta = file.metadata()?;
        let mut header = [0; HEADER_BYTES];
        file.read_exact_at(&mut header, 0)?;
        let layout = Layout::check(&header, meta.len())?;
        Ok(Self {
            path: path.to_owned(),
            file: (meta.dev(), meta.ino()),
            map: Map::new(&file, layout.bytes(), false)?,
            layout,
            last: 0,
            _value: None,
        })
    }

    /// Largest tuple, in bytes.
    pub fn tuple_bytes(&self) -> usize {
        self.layout.tuple_bytes
    }

    /// Events that are kept, the one that is being written included.
    pub fn history(&self) -> usize {
        self.layout.slots
    }

    /// The newest value, as a read of the node's `bin_data` would give it: never one that is too old.
    ///
    /// # Errors
    /// `EAGAIN`: there is none yet. `ETIMEDOUT`: it is too old. `ESTALE`: the node is gone; open again.
    /// Any other: the sample could not be taken.
    pub fn newest(&self, tuple: &mut Vec<u8>) -> io::Result<Event> {
        let error = |errno| Err(io::Error::from_raw_os_error(errno));
        if self.map.get(layout::AT_STATE) != layout::LIVE {
            return error(libc::ESTALE);
        }
        let Some(event) = self.newest_event(tuple) else {
            return error(libc::EAGAIN);
        };
        if event.errno != 0 {
            return error(event.errno);
        }
        let stale_ms = self.map.get(layout::AT_STALE_MS);
        if stale_ms != 0 && event.age_ns() > u64::from(stale_ms) * 1_000_000 {
            return error(libc::ETIMEDOUT);
        }
        Ok(event)
    }

    /// The newest event, however old. None: there is none yet.
    pub fn newest_event(&self, tuple: &mut Vec<u8>) -> Option<Event> {
        for _ in 0..limits::ATTEMPTS {
            let sequence = self.newest_sequence();
            if sequence == 0 {
                return None;
            }
            if let Some(event) = self.event(sequence, tuple) {
                return Some(event);
            }
        }
        // So slow a reader has seen nothing whole.
        None
    }

    /// The number of the newest event; 0 before the first.
    pub fn newest_sequence(&self) -> u32 {
        ring::newest(&self.map)
    }

    /// The event with a number, with its bytes. None: it is not there yet, or no longer.
    pub fn event(&self, sequence: u32, tuple: &mut Vec<u8>) -> Option<Event> {
        ring::read(&self.map, &self.layout, sequence, tuple)
    }

    /// The event after the last one that this gave: at first the oldest that is kept.
    pub fn next_event(&mut self, tuple: &mut Vec<u8>) -> Step {
        let newest = self.newest_sequence();
        if newest == self.last || newest == 0 {
            return Step::Nothing;
        }
        let is_first = self.last == 0;
        let next = layout::next_event(self.last);
        // The slot after the newest may be in use already.
        let kept = u32::try_from(self.layout.slots - 1).unwrap_or(1).max(1);
        if newest.wrapping_sub(next) >= kept {
            let oldest = newest.wrapping_sub(kept - 1).max(1);
            self.last = oldest - 1;
            if !is_first {
                return Step::Missed(oldest.wrapping_sub(next));
            }
        }
        let next = layout::next_event(self.last);
        match self.event(next, tuple) {
            Some(event) => {
                self.last = next;
                Step::Event(event)
            }
            // It is being overwritten: the next call knows how many are lost.
            None => Step::Nothing,
        }
    }

    /// Whether this is still the node's ring. It makes a system call: ask when nothing has come for a while.
    pub fn is_current(&self) -> bool {
        let found = std::fs::metadata(&self.path);
        self.map.get(layout::AT_STATE) == layout::LIVE
            && found.is_ok_and(|meta| (meta.dev(), meta.ino()) == self.file)
    }
}

impl Event {
    /// How long ago it was, in ns.
    pub fn age_ns(&self) -> u64 {
        let now = clock_gettime(ClockId::CLOCK_MONOTONIC).map_or(u64::MAX, |time| {
            u64::try_from(Duration::from(time).as_nanos()).unwrap_or(u64::MAX)
        });
        now.saturating_sub(self.time_ns)
    }
}
