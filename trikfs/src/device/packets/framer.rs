//! Where packets begin and end in a stream of bytes, and which of them are good.
//!
//! Owns the search: at each byte from the left, either a good packet stands there, which is given and skipped as a
//! whole, or it does not, and the search goes on one byte later. So what is given does not depend on how the bytes
//! come, and every good packet is given that no other good packet (a false one, by chance) covers in part. A start
//! with a false length holds back what follows it for at most the bytes of one tuple.
//!
//! Each byte costs the same, however often a false start makes it be looked at again: sums are differences of sums
//! from the beginning. Pure; reads nothing.

// A checksum that is forgotten must not be another one in silence.
#![deny(clippy::wildcard_enum_match_arm)]

use super::super::cutter::{Cut, fill};
use config::description::{ByteOrder, Checksum, PacketsDescription};

/// The search and what it has not decided on yet, at most one tuple.
pub(super) struct Framer {
    description: PacketsDescription,
    tuple_size: usize,
    /// Bytes from the first undecided one on, after `at` bytes that are done with.
    bytes: Vec<u8>,
    /// For each byte the sum (or exclusive-or) of all before it in `bytes`, and one more at the end.
    sums: Vec<u16>,
    at: usize,
    damaged: u32,
}

/// What stands at one place.
enum Found {
    Good(usize),
    /// It cannot be told yet.
    Undecided,
    /// Other bytes than a start.
    Other,
    /// A start, but no packet.
    Damaged,
}

impl Framer {
    /// Nothing seen yet.
    pub(super) fn new(description: &PacketsDescription, tuple_size: usize) -> Self {
        Self {
            description: description.clone(),
            tuple_size,
            bytes: Vec::with_capacity(2 * tuple_size),
            sums: vec![0],
            at: 0,
            damaged: 0,
        }
    }

    fn push(&mut self, byte: u8) {
        if self.at >= self.tuple_size {
            self.bytes.drain(..self.at);
            self.sums.drain(..self.at);
            self.at = 0;
        }
        let before = self.sums.last().copied().unwrap_or(0);
        self.bytes.push(byte);
        self.sums.push(match self.description.checksum {
            Checksum::Xor8 => before ^ u16::from(byte),
            // Without a checksum the sums are kept and not asked for.
            Checksum::None | Checksum::Sum8 | Checksum::Sum16 => {
                before.wrapping_add(u16::from(byte))
            }
        });
    }

    fn examine(&self) -> Found {
        let here = self.bytes.get(self.at..).unwrap_or_default();
        let start = &self.description.start;
        let common = start.len().min(here.len());
        if here[..common] != start[..common] {
            return Found::Other;
        }
        if here.len() < self.description.head_size() {
            return Found::Undecided;
        }
        let field = &self.description.length;
        let value = self.number(&here[field.at..field.at + field.bytes]);
        let size = i64::from(value) + i64::from(field.add);
        let Some(size) = usize::try_from(size)
            .ok()
            .filter(|size| (self.description.size_min()..=self.tuple_size).contains(size))
        else {
            return Found::Damaged;
        };
        if here.len() < size {
            return Found::Undecided;
        }
        let content = size - self.description.checksum.size();
        if self.is_sum_right(content, &here[content..size]) {
            Found::Good(size)
        } else {
            Found::Damaged
        }
    }

    fn is_sum_right(&self, content: usize, given: &[u8]) -> bool {
        let (from, to) = (self.sums[self.at], self.sums[self.at + content]);
        let given = self.number(given);
        match self.description.checksum {
            Checksum::None => true,
            Checksum::Sum8 => given == (to.wrapping_sub(from)) & 0xff,
            Checksum::Sum16 => given == to.wrapping_sub(from),
            Checksum::Xor8 => given == to ^ from,
        }
    }

    fn number(&self, bytes: &[u8]) -> u16 {
        let append = |number: u16, byte: &u8| number << 8 | u16::from(*byte);
        match self.description.order {
            ByteOrder::Big => bytes.iter().fold(0, append),
            ByteOrder::Little => bytes.iter().rev().fold(0, append),
        }
    }

    /// Goes on until a packet is found or more bytes are needed.
    fn search(&mut self, is_end: bool, tuple: &mut [u8]) -> bool {
        while self.at < self.bytes.len() {
            match self.examine() {
                Found::Good(size) => {
                    fill(tuple, &self.bytes[self.at..self.at + size]);
                    self.at += size;
                    return true;
                }
                Found::Undecided if !is_end => return false,
                Found::Other => self.at += 1,
                Found::Damaged | Found::Undecided => {
                    self.at += 1;
                    self.damaged = self.damaged.saturating_add(1);
                }
            }
        }
        false
    }
}

impl Cut for Framer {
    fn cut(&mut self, input: &[u8], is_end: bool, tuple: &mut [u8]) -> (usize, bool) {
        // What a packet leaves behind may hold the next one.
        if self.search(false, tuple) {
            return (0, true);
        }
        for (index, byte) in input.iter().enumerate() {
            self.push(*byte);
            if self.search(false, tuple) {
                return (index + 1, true);
            }
        }
        (input.len(), is_end && self.search(true, tuple))
    }

    fn take_damaged(&mut self) -> u32 {
        std::mem::take(&mut self.damaged)
    }
}

#[cfg(test)]
mod tests;
