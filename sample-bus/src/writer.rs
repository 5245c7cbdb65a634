//! The publisher's end of a ring.
//!
//! Owns one file and its mapping. Publishing is a few stores into memory that is there already: it never waits,
//! allocates nothing and makes no system call.

use crate::layout::{self, Layout};
use crate::map::Map;
use crate::reader::Event;
use crate::ring::{self, Memory as _};
use nix::fcntl::posix_fallocate;
use std::fs::{File, Permissions};
use std::io;
use std::os::unix::fs::{OpenOptionsExt, PermissionsExt, fchown};
use std::path::{Path, PathBuf};
use std::sync::atomic::{Ordering, fence};

/// Who may open a ring. Its owner is always the publisher: an owner could shorten the file under it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rights {
    /// Permission bits.
    pub mode: u32,
    /// Group of the file, if not the publisher's.
    pub group: Option<u32>,
}

/// One published node. Dropping it tells the readers and removes the file.
#[derive(Debug)]
pub struct Writer {
    path: PathBuf,
    map: Map,
    layout: Layout,
    newest: u32,
}

impl Writer {
    /// Makes a ring at a path where nothing is, for a file with these rights.
    ///
    /// All of its memory is taken now, so that publishing cannot fail later.
    ///
    /// # Errors
    /// There is something, no memory is left, or the tuples are too large.
    pub fn create(path: &Path, tuple_bytes: usize, rights: Rights) -> io::Result<Self> {
        let layout = Layout::new(tuple_bytes)?;
        let file = File::options()
            .read(true)
            .write(true)
            .create_new(true)
            .mode(0o600)
            .open(path)?;
        let made = Self::fill(&file, layout, rights);
        let map = made.inspect_err(|_| {
            let _ = std::fs::remove_file(path);
        })?;
        Ok(Self {
            path: path.to_owned(),
            map,
            layout,
            newest: 0,
        })
    }

    fn fill(file: &File, layout: Layout, rights: Rights) -> io::Result<Map> {
        let bytes = layout.bytes();
        let length = libc::off_t::try_from(bytes).map_err(io::Error::other)?;
        posix_fallocate(file, 0, length)?;
        let map = Map::new(file, bytes, true)?;
        let set = |at, number: usize| {
            map.set(at, u32::try_from(number).unwrap_or(u32::MAX));
        };
        set(layout::AT_HEADER_BYTES, layout::HEADER_BYTES);
        set(layout::AT_SLOT_BYTES, layout.slot_bytes);
        set(layout::AT_SLOTS, layout.slots);
        set(layout::AT_TUPLE_BYTES, layout.tuple_bytes);
        // A reader that comes before this finds no ring.
        fence(Ordering::Release);
        map.copy_in(0, &layout::MAGIC);
        if rights.group.is_some() {
            fchown(file, None, rights.group)?;
        }
        file.set_permissions(Permissions::from_mode(rights.mode))?;
        Ok(map)
    }

    /// Bytes of memory that a ring for such tuples takes.
    ///
    /// # Errors
    /// The tuples are too large.
    pub fn bytes_for(tuple_bytes: usize) -> io::Result<usize> {
        Layout::new(tuple_bytes).map(|layout| layout.bytes())
    }

    /// A new sample, taken at `time_ns` of CLOCK_MONOTONIC. More bytes than the ring has room for are left out.
    pub fn publish(&mut self, time_ns: u64, tuple: &[u8]) {
        self.write(time_ns, 0, tuple);
    }

    /// No sample could be taken; `errno` says why.
    pub fn fail(&mut self, time_ns: u64, errno: i32) {
        self.write(time_ns, errno, &[]);
    }

    fn write(&mut self, time_ns: u64, errno: i32, tuple: &[u8]) {
        let tuple = tuple.get(..self.layout.tuple_bytes).unwrap_or(tuple);
        let event = Event {
            sequence: layout::next_event(self.newest),
            time_ns,
            errno,
        };
        ring::write(&self.map, &self.layout, event, tuple);
        self.newest = event.sequence;
    }

    /// The age in ms from which a sample is no longer shown as the newest value; 0: none is too old.
    pub fn set_stale_ms(&mut self, stale_ms: u32) {
        self.map.set(layout::AT_STALE_MS, stale_ms);
    }

    #[cfg(test)]
    pub(crate) fn start_from(&mut self, event: u32) {
        self.newest = event;
    }
}

impl Drop for Writer {
    fn drop(&mut self) {
        self.map.set(layout::AT_STATE, layout::ENDED);
        // Gone with its directory already, at the end of the mount.
        let _ = std::fs::remove_file(&self.path);
    }
}
