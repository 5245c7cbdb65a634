//! What the guardian has to know when the daemon is dead: a file in memory that both hold.
//!
//! The daemon writes, and may be killed in the middle; the guardian reads, and believes nothing that does not check.
//! Owns the layout, which never leaves the machine: four sections (configuration, rest, cached, copies), each with two
//! slots that are written in turn. A slot is a header and its payload; the valid slot with the later sequence
//! number counts. A write that is cut short leaves the other slot as it was.
//!
//! ```text
//! slot:    magic u32 | section u32 | sequence u32 | length u32 | checksum u128 | payload
//! rest:    { action }, see `actions`
//! cached:  { node id u64 }
//! copies:  which libraries are loaded, see `convert/shared/copies`
//! ```
//! All numbers are little endian. The checksum covers the payload and the three numbers before the length.

use super::actions::{self, RestAction};
use crate::hash::Hash;
use crate::limits;
use nix::sys::memfd::{MFdFlags, memfd_create};
use std::fs::{File, OpenOptions};
use std::io;
use std::os::fd::{AsRawFd, RawFd};
use std::os::unix::fs::FileExt;
use std::sync::{Arc, Mutex, PoisonError};

/// "trkL" in the order of the bytes.
const MAGIC: u32 = u32::from_le_bytes(*b"trkL");
/// Bytes before the payload of a slot.
const HEADER_BYTES: usize = 32;

/// The shared file. Clones write to the same one.
#[derive(Clone, Debug)]
pub struct Ledger {
    file: Arc<File>,
    /// Held while a slot is chosen and written.
    turn: Arc<Mutex<()>>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Section {
    Config,
    Rest,
    Cached,
    Copies,
}

impl Section {
    const ALL: [Self; 4] = [Self::Config, Self::Rest, Self::Cached, Self::Copies];

    /// Largest payload.
    fn capacity(self) -> usize {
        match self {
            Self::Config => config::limits::CONFIG_BYTES_MAX,
            Self::Rest => limits::REST_BYTES_MAX,
            Self::Cached => limits::CACHED_MAX * 8,
            Self::Copies => limits::COPIES_BYTES_MAX,
        }
    }

    /// Where one of its two slots begins. The file has holes, so room that is not used costs nothing.
    fn offset(self, slot: usize) -> u64 {
        let before: usize = Self::ALL
            .iter()
            .take_while(|section| **section != self)
            .map(|section| 2 * (HEADER_BYTES + section.capacity()))
            .sum();
        (before + slot * (HEADER_BYTES + self.capacity())) as u64
    }
}

impl Ledger {
    /// A new, empty ledger. Its descriptor is inherited by programs that are executed, on purpose.
    pub fn create() -> io::Result<Self> {
        let file = memfd_create(c"trikfs-ledger", MFdFlags::empty())?;
        Ok(Self::over(File::from(file)))
    }

    /// The ledger of a descriptor that this process inherited.
    pub fn inherited(number: RawFd) -> io::Result<Self> {
        // Opening it anew needs no unsafe claim to own the number.
        let file = OpenOptions::new()
            .read(true)
            .write(true)
            .open(format!("/proc/self/fd/{number}"))?;
        Ok(Self::over(file))
    }

    fn over(file: File) -> Self {
        Self {
            file: Arc::new(file),
            turn: Arc::default(),
        }
    }

    /// The number that [`Ledger::inherited`] takes.
    pub fn number(&self) -> RawFd {
        self.file.as_raw_fd()
    }

    /// Records the bytes of the configuration in force, at most 1 MiB.
    pub fn set_config(&self, bytes: &[u8]) -> io::Result<()> {
        self.write(Section::Config, bytes)
    }

    /// Records what has to be written when the daemon is gone, in this order; replaces what was there.
    /// At most 4096 actions and 4 MiB.
    pub fn set_rest(&self, actions: &[RestAction]) -> io::Result<()> {
        if actions.len() > limits::REST_ACTIONS_MAX {
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        let bytes = actions::encode(actions).ok_or(io::ErrorKind::InvalidInput)?;
        self.write(Section::Rest, &bytes)
    }

    /// Records the node ids whose values may be in the page cache; replaces what was there. At most 4096.
    pub fn set_cached(&self, inos: &[u64]) -> io::Result<()> {
        let bytes: Vec<u8> = inos.iter().flat_map(|ino| ino.to_le_bytes()).collect();
        self.write(Section::Cached, &bytes)
    }

    /// Records which copies of libraries are loaded, in bytes that this file does not read; at most 1 MiB.
    pub fn set_copies(&self, bytes: &[u8]) -> io::Result<()> {
        self.write(Section::Copies, bytes)
    }

    /// What [`set_copies`](Self::set_copies) recorded last; nothing if that was nothing readable.
    pub fn copies(&self) -> Vec<u8> {
        self.read(Section::Copies).unwrap_or_default()
    }

    /// The configuration in force, if one was recorded.
    pub fn config(&self) -> Option<Vec<u8>> {
        self.read(Section::Config)
    }

    /// The rest actions; none if nothing readable was recorded.
    pub fn rest(&self) -> Vec<RestAction> {
        self.read(Section::Rest)
            .and_then(|bytes| actions::decode(&bytes))
            .unwrap_or_default()
    }

    /// The node ids with cached values; none if nothing readable was recorded.
    pub fn cached(&self) -> Vec<u64> {
        let bytes = self.read(Section::Cached).unwrap_or_default();
        let (inos, _) = bytes.as_chunks();
        inos.iter().map(|ino| u64::from_le_bytes(*ino)).collect()
    }

    fn write(&self, section: Section, payload: &[u8]) -> io::Result<()> {
        if payload.len() > section.capacity() {
            return Err(io::ErrorKind::FileTooLarge.into());
        }
        let _turn = self.turn.lock().unwrap_or_else(PoisonError::into_inner);
        let (slot, sequence) = match self.newest(section) {
            Some((slot, sequence, _)) => (1 - slot, sequence.wrapping_add(1)),
            None => (0, 0),
        };
        let offset = section.offset(slot);
        // The old header must not vouch for the new payload.
        self.file.write_all_at(&[0; HEADER_BYTES], offset)?;
        self.file
            .write_all_at(payload, offset + HEADER_BYTES as u64)?;
        self.file
            .write_all_at(&header(section, sequence, payload), offset)
    }

    fn read(&self, section: Section) -> Option<Vec<u8>> {
        self.newest(section).map(|(_, _, payload)| payload)
    }

    /// Slot, sequence number and payload of the last complete write.
    fn newest(&self, section: Section) -> Option<(usize, u32, Vec<u8>)> {
        let valid = |slot| {
            self.slot(section, slot)
                .map(|(sequence, payload)| (slot, sequence, payload))
        };
        match (valid(0), valid(1)) {
            (Some(first), Some(second)) => {
                let second_is_later = second.1.wrapping_sub(first.1) < 1 << 31;
                Some(if second_is_later { second } else { first })
            }
            (first, second) => first.or(second),
        }
    }

    fn slot(&self, section: Section, slot: usize) -> Option<(u32, Vec<u8>)> {
        let offset = section.offset(slot);
        let mut found = [0; HEADER_BYTES];
        self.file.read_exact_at(&mut found, offset).ok()?;
        let number = |at: usize| Some(u32::from_le_bytes(*found.get(at..)?.first_chunk()?));
        let (sequence, length) = (number(8)?, number(12)? as usize);
        if length > section.capacity() {
            return None;
        }
        let mut payload = vec![0; length];
        self.file
            .read_exact_at(&mut payload, offset + HEADER_BYTES as u64)
            .ok()?;
        (found == header(section, sequence, &payload)).then_some((sequence, payload))
    }
}

fn header(section: Section, sequence: u32, payload: &[u8]) -> [u8; HEADER_BYTES] {
    let mut bytes = [0; HEADER_BYTES];
    bytes[..4].copy_from_slice(&MAGIC.to_le_bytes());
    bytes[4..8].copy_from_slice(&(section as u32).to_le_bytes());
    bytes[8..12].copy_from_slice(&sequence.to_le_bytes());
    let checksum = Hash::of(&bytes[..12]).part(payload).value();
    // `write` lets no payload through whose length does not fit.
    bytes[12..16].copy_from_slice(
        &u32::try_from(payload.len())
            .unwrap_or(u32::MAX)
            .to_le_bytes(),
    );
    bytes[16..].copy_from_slice(&checksum.to_le_bytes());
    bytes
}

#[cfg(test)]
mod tests;
