//! Tuples out of the bytes of a stream that has other units: lines, packets, samples.
//!
//! Owns the buffers between the two and the count of what was damaged. What a unit is, a [`Cut`] knows.
//! However the bytes come, memory is one buffer of bytes and one tuple, and one call looks at a limited number of bytes.

use super::{Got, Stream};
use crate::errno::Error;
use crate::limits;
use crate::stats::Counter;
use std::sync::Arc;
use std::time::Instant;

/// Finds units in bytes.
pub(super) trait Cut: Send {
    /// Takes bytes from the front of `input` until a unit is whole, and writes it into `tuple`. Says how many were
    /// taken, and whether there is a tuple. Without a tuple all bytes must have been taken.
    ///
    /// `is_end`: what is still incomplete stays so.
    fn cut(&mut self, input: &[u8], is_end: bool, tuple: &mut [u8]) -> (usize, bool);

    /// Whether what one read gave makes sense as a whole; otherwise all of it is damaged.
    fn accepts(&self, _read: &[u8]) -> bool {
        true
    }

    /// Damaged units since the last call.
    fn take_damaged(&mut self) -> u32;
}

/// The buffers around a [`Cut`].
pub(super) struct Cutter<C> {
    pub(super) cut: C,
    raw: Vec<u8>,
    raw_at: usize,
    raw_len: usize,
    tuple: Vec<u8>,
    /// Bytes of the tuple that have been handed out; all of them if there is none.
    given: usize,
    /// The source has more, but others have to get their turn.
    is_behind: bool,
    damaged: Arc<Counter>,
}

impl<C: Cut> Cutter<C> {
    /// `raw_size`: bytes that are read at once.
    pub(super) fn new(cut: C, tuple_size: usize, raw_size: usize, damaged: Arc<Counter>) -> Self {
        Self {
            cut,
            raw: vec![0; raw_size],
            raw_at: 0,
            raw_len: 0,
            tuple: vec![0; tuple_size],
            given: tuple_size,
            is_behind: false,
            damaged,
        }
    }

    /// Tuples from `source`, as [`Stream::read`].
    pub(super) fn read(&mut self, source: &mut dyn Stream, buf: &mut [u8]) -> Result<Got, Error> {
        self.is_behind = false;
        let mut filled = self.hand_out(buf);
        let mut looked_at = 0;
        while filled < buf.len() {
            if self.next(false) {
                filled += self.hand_out(&mut buf[filled..]);
                continue;
            }
            if looked_at >= limits::CUT_BYTES_MAX {
                self.is_behind = true;
                break;
            }
            match source.read(&mut self.raw) {
                Ok(Got::Bytes(n)) => {
                    looked_at += n;
                    if self.cut.accepts(&self.raw[..n]) {
                        (self.raw_at, self.raw_len) = (0, n);
                    } else {
                        self.damaged.add(1);
                    }
                }
                Ok(Got::Nothing) => break,
                // The same comes again when what is there has been handed out.
                Ok(Got::End) if self.next(true) => filled += self.hand_out(&mut buf[filled..]),
                Ok(Got::End) if filled == 0 => return Ok(Got::End),
                Err(error) if filled == 0 => return Err(error),
                Ok(Got::End) | Err(_) => break,
            }
        }
        Ok(if filled > 0 {
            Got::Bytes(filled)
        } else {
            Got::Nothing
        })
    }

    /// When to read again although the source is silent: at once if a call ended before the bytes did.
    pub(super) fn wake_at(&self) -> Option<Instant> {
        self.is_behind.then(Instant::now)
    }

    /// Makes the next tuple from the bytes that are there.
    fn next(&mut self, is_end: bool) -> bool {
        let input = &self.raw[self.raw_at..self.raw_len];
        let (taken, is_made) = self.cut.cut(input, is_end, &mut self.tuple);
        self.raw_at += taken;
        let damaged = self.cut.take_damaged();
        if damaged > 0 {
            self.damaged.add(damaged);
        }
        if is_made {
            self.given = 0;
        }
        is_made
    }

    fn hand_out(&mut self, buf: &mut [u8]) -> usize {
        let rest = &self.tuple[self.given..];
        let n = rest.len().min(buf.len());
        buf[..n].copy_from_slice(&rest[..n]);
        self.given += n;
        n
    }
}

/// Writes a unit into a tuple and fills the rest with zero bytes. The unit must fit.
pub(super) fn fill(tuple: &mut [u8], unit: &[u8]) {
    let (head, tail) = tuple.split_at_mut(unit.len());
    head.copy_from_slice(unit);
    tail.fill(0);
}

/// A stream of given pieces, for tests of what cuts.
#[cfg(test)]
pub(super) struct Pieces(pub(super) std::collections::VecDeque<Vec<u8>>);

#[cfg(test)]
impl Pieces {
    /// The bytes cut into pieces of this size.
    pub(super) fn of(bytes: &[u8], size: usize) -> Self {
        Self(bytes.chunks(size).map(<[u8]>::to_vec).collect())
    }

    /// Everything that a cutter makes of it, with the buffer of a slow reader.
    pub(super) fn drain<C: Cut>(mut self, cutter: &mut Cutter<C>, buf_size: usize) -> Vec<u8> {
        let mut all = Vec::new();
        let mut buf = vec![0; buf_size];
        loop {
            match cutter
                .read(&mut self, &mut buf)
                .expect("pieces do not fail")
            {
                Got::Bytes(n) => all.extend_from_slice(&buf[..n]),
                Got::Nothing => assert!(cutter.wake_at().is_some(), "silent with bytes left"),
                Got::End => return all,
            }
        }
    }
}

#[cfg(test)]
impl Stream for Pieces {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        let Some(mut piece) = self.0.pop_front() else {
            return Ok(Got::End);
        };
        let n = piece.len().min(buf.len());
        buf[..n].copy_from_slice(&piece[..n]);
        if n < piece.len() {
            self.0.push_front(piece.split_off(n));
        }
        Ok(Got::Bytes(n))
    }

    fn fd(&self) -> Option<std::os::fd::BorrowedFd<'_>> {
        None
    }
}
