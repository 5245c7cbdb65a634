//! Zip as saves use it: entries that are stored or deflated, no encryption, no parts, no 64-bit extensions.
//!
//! Reads by the central directory, as every unpacker does. What is written is the same in each run: all times are the
//! beginning of the format's calendar.

use super::deflate::{self, Unpacker, checksum};
use super::{Pieces, in_file, number, words};
use crate::limits;
use crate::problem::Problem;

const LOCAL: u32 = 0x0403_4b50;
const CENTRAL: u32 = 0x0201_4b50;
const END: u32 = 0x0605_4b50;
/// Bytes of the end record, and of the longest remark after it.
const END_BYTES: usize = 22;
const REMARK_BYTES: usize = 0xffff;
const CENTRAL_BYTES: usize = 46;
const LOCAL_BYTES: usize = 30;
const STORED: u16 = 0;
const DEFLATED: u16 = 8;
const FLAG_ENCRYPTED: u16 = 1;
const FLAG_UTF8: u16 = 1 << 11;
/// 1 January 1980, the first day that the format can name.
const DATE: u16 = 0x21;
/// A plain file and a folder as Unix has them, with the bit of DOS for the folder.
const FILE_ATTRIBUTES: u32 = 0o100_644 << 16;
const FOLDER_ATTRIBUTES: u32 = (0o040_755 << 16) | 0x10;

fn word(bytes: &[u8], at: usize) -> Option<u16> {
    number(bytes, at).map(u16::from_le_bytes)
}

fn double(bytes: &[u8], at: usize) -> Option<u32> {
    number(bytes, at).map(u32::from_le_bytes)
}

/// What the central directory says of an entry.
struct Central {
    name: String,
    flags: u16,
    method: u16,
    checksum: u32,
    packed: usize,
    size: usize,
    local: usize,
    /// Where the next one begins.
    next: usize,
}

pub(super) fn unpack(bytes: &[u8], pieces: &mut Pieces<'_>) -> Result<(), Problem> {
    let end = find_end(bytes).ok_or_else(|| Problem::error(words::zip_cut()))?;
    let damaged = || Problem::error(words::directory_damaged());
    let count = word(bytes, end + 10).ok_or_else(damaged)?;
    let mut at = double(bytes, end + 16).ok_or_else(damaged)? as usize;
    // An honest zip holds each packed byte once; one that counts bytes twice wants to cost time.
    let mut budget = bytes.len();
    let mut unpacker = Unpacker::new(false);
    for _ in 0..count {
        pieces.count()?;
        let entry = central(bytes, at).ok_or_else(damaged)?;
        at = entry.next;
        budget = budget
            .checked_sub(entry.packed)
            .ok_or_else(|| in_file(&entry.name, words::overlaps()))?;
        let unpacked = take(bytes, &entry, pieces, &mut unpacker)?;
        pieces.add(&entry.name, unpacked);
    }
    Ok(())
}

/// Where the end record is: the last place that looks like one.
fn find_end(bytes: &[u8]) -> Option<usize> {
    let last = bytes.len().checked_sub(END_BYTES)?;
    let first = last.saturating_sub(REMARK_BYTES);
    (first..=last)
        .rev()
        .find(|&at| double(bytes, at) == Some(END))
}

fn central(bytes: &[u8], at: usize) -> Option<Central> {
    let record = bytes.get(at..)?;
    if double(record, 0)? != CENTRAL {
        return None;
    }
    let length = usize::from(word(record, 28)?);
    if length > limits::ENTRY_NAME_BYTES {
        return None;
    }
    let name = record.get(CENTRAL_BYTES..CENTRAL_BYTES + length)?;
    let behind = usize::from(word(record, 30)?) + usize::from(word(record, 32)?);
    Some(Central {
        name: String::from_utf8_lossy(name).into_owned(),
        flags: word(record, 8)?,
        method: word(record, 10)?,
        checksum: double(record, 16)?,
        packed: double(record, 20)? as usize,
        size: double(record, 24)? as usize,
        local: double(record, 42)? as usize,
        next: at + CENTRAL_BYTES + length + behind,
    })
}

/// The bytes of an entry, unpacked and compared with their checksum.
fn take(
    bytes: &[u8],
    entry: &Central,
    pieces: &Pieces<'_>,
    unpacker: &mut Unpacker,
) -> Result<Vec<u8>, Problem> {
    let refuse = |words| in_file(&entry.name, words);
    if entry.flags & FLAG_ENCRYPTED != 0 {
        return Err(refuse(words::encrypted()));
    }
    let packed = data(bytes, entry).ok_or_else(|| refuse(words::damaged()))?;
    let allowed = pieces.allowance(&entry.name, entry.size)?;
    let unpacked = match entry.method {
        STORED => Some(packed.to_vec()),
        DEFLATED => unpacker.unpack(packed, allowed),
        other => return Err(refuse(words::method(other))),
    };
    let is_whole = |piece: &Vec<u8>| piece.len() == allowed && checksum(piece) == entry.checksum;
    unpacked
        .filter(is_whole)
        .ok_or_else(|| refuse(words::damaged()))
}

fn data<'a>(bytes: &'a [u8], entry: &Central) -> Option<&'a [u8]> {
    let local = bytes.get(entry.local..)?;
    if double(local, 0)? != LOCAL {
        return None;
    }
    let begin = LOCAL_BYTES + usize::from(word(local, 26)?) + usize::from(word(local, 28)?);
    local.get(begin..begin.checked_add(entry.packed)?)
}

/// A zip that grows.
#[derive(Default)]
pub(super) struct Packer {
    bytes: Vec<u8>,
    directory: Vec<u8>,
    count: u16,
}

impl Packer {
    /// Adds a file, or a folder if the name ends with `/`.
    pub(super) fn add(&mut self, name: &str, bytes: &[u8]) -> Result<(), Problem> {
        let too_many = || in_file(name, words::too_many());
        let too_long = || in_file(name, words::too_large(bytes.len()));
        let local = u32::try_from(self.bytes.len()).map_err(|_| too_long())?;
        let size = u32::try_from(bytes.len()).map_err(|_| too_long())?;
        let length = u16::try_from(name.len()).map_err(|_| too_long())?;
        self.count = self.count.checked_add(1).ok_or_else(too_many)?;
        let deflated = deflate::pack(bytes);
        let (method, packed) = match &deflated {
            Some(packed) => (DEFLATED, packed.as_slice()),
            None => (STORED, bytes),
        };
        let flags = if name.is_ascii() { 0 } else { FLAG_UTF8 };
        let attributes = if name.ends_with('/') {
            FOLDER_ATTRIBUTES
        } else {
            FILE_ATTRIBUTES
        };
        let packed_size = u32::try_from(packed.len()).map_err(|_| too_long())?;
        // From the version that is needed to the lengths of name and extra field, the same in both headers.
        let mut shared = Vec::with_capacity(LOCAL_BYTES);
        for value in [20, flags, method, 0, DATE] {
            shared.extend(value.to_le_bytes());
        }
        for value in [checksum(bytes), packed_size, size] {
            shared.extend(value.to_le_bytes());
        }
        for value in [length, 0] {
            shared.extend(value.to_le_bytes());
        }
        self.bytes.extend(LOCAL.to_le_bytes());
        self.bytes.extend(&shared);
        self.bytes.extend(name.as_bytes());
        self.bytes.extend(packed);
        self.directory.extend(CENTRAL.to_le_bytes());
        // Made on Unix by version 2.0 of the format.
        self.directory.extend([20, 3]);
        self.directory.extend(&shared);
        // No remark, the first disk, no internal attributes.
        self.directory.extend([0; 6]);
        self.directory.extend(attributes.to_le_bytes());
        self.directory.extend(local.to_le_bytes());
        self.directory.extend(name.as_bytes());
        Ok(())
    }

    /// The whole zip.
    pub(super) fn finish(self) -> Result<Vec<u8>, Problem> {
        let too_large = |_| Problem::error(words::too_large(self.bytes.len()));
        let begin = u32::try_from(self.bytes.len()).map_err(too_large)?;
        let length = u32::try_from(self.directory.len()).map_err(too_large)?;
        let mut bytes = self.bytes;
        bytes.extend(&self.directory);
        bytes.extend(END.to_le_bytes());
        for value in [0, 0, self.count, self.count] {
            bytes.extend(value.to_le_bytes());
        }
        bytes.extend(length.to_le_bytes());
        bytes.extend(begin.to_le_bytes());
        bytes.extend([0; 2]);
        Ok(bytes)
    }
}
