//! The container of old saves: names in UTF-16 and pieces in zlib, one after another.
//!
//! A record is the length of the name in bytes, the name in UTF-16BE, the length of the piece, the piece. A piece is how
//! long it is unpacked and then a stream of zlib. All lengths have 32 bits, the highest byte first.

use super::deflate::Unpacker;
use super::{Pieces, in_file, number, words};
use crate::limits;
use lang_text::problem::Problem;

/// Whether the bytes can begin with a name.
pub(super) fn is_likely(bytes: &[u8]) -> bool {
    let length = number(bytes, 0).map(u32::from_be_bytes).unwrap_or_default();
    length > 0 && length.is_multiple_of(2) && length as usize <= limits::ENTRY_NAME_BYTES * 2
}

pub(super) fn unpack(bytes: &[u8], pieces: &mut Pieces<'_>) -> Result<(), Problem> {
    let mut list = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        pieces.count()?;
        let cut = || Problem::error(words::cut_at(at, bytes.len()));
        let length = number(bytes, at).map(u32::from_be_bytes).ok_or_else(cut)? as usize;
        if length > limits::ENTRY_NAME_BYTES * 2 || !length.is_multiple_of(2) {
            return Err(Problem::error(words::damaged_at(at)));
        }
        let begin = at + 4;
        let name = bytes.get(begin..begin + length).ok_or_else(cut)?;
        let units: Vec<u16> = name
            .chunks_exact(2)
            .map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
            .collect();
        let name = String::from_utf16_lossy(&units);
        let begin = begin + length;
        let length = number(bytes, begin)
            .map(u32::from_be_bytes)
            .ok_or_else(cut)? as usize;
        let begin = begin + 4;
        let end = begin.checked_add(length).filter(|&end| end <= bytes.len());
        let end = end.ok_or_else(|| in_file(&name, words::cut_at(at, bytes.len())))?;
        let piece = &bytes[begin..end];
        let damaged = || in_file(&name, words::damaged());
        let claimed = number(piece, 0).map(u32::from_be_bytes);
        let claimed = claimed.filter(|&claimed| claimed > 0).ok_or_else(damaged)?;
        let claimed = claimed as usize;
        let packed = &piece[4..];
        pieces.admit(&name, packed.len(), claimed)?;
        list.push((name, packed, claimed));
        at = end;
    }
    let mut unpacker = Unpacker::new();
    for (name, packed, claimed) in list {
        let unpacked = unpacker.unpack(packed, claimed);
        let unpacked = unpacked.ok_or_else(|| in_file(&name, words::damaged()))?;
        pieces.add(&name, unpacked);
    }
    Ok(())
}
